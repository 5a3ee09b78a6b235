//! The text of a model file and the overrides applied to it: where values come from.

use std::ops::Range;
use std::sync::Arc;

use crate::error::Place;

/// Where a value or key was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// Bytes of the file's text.
    Text(Range<usize>),
    /// The override of this index.
    Setting(usize),
}

/// Name and text of a model file, and the overrides in the order in which they were given.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    name: String,
    text: Arc<str>,
    settings: Vec<String>,
}

impl Source {
    pub fn new(name: &str, text: &str) -> Self {
        Self {
            name: name.to_owned(),
            text: text.into(),
            settings: Vec::new(),
        }
    }

    /// The source of a model that comes from no file.
    pub fn none() -> Self {
        Self::new("", "")
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn text_arc(&self) -> Arc<str> {
        Arc::clone(&self.text)
    }

    pub fn settings(&self) -> &[String] {
        &self.settings
    }

    pub fn setting(&self, index: usize) -> Option<&str> {
        self.settings.get(index).map(String::as_str)
    }

    /// Records an override and returns the origin of its values.
    pub fn add_setting(&mut self, setting: String) -> Origin {
        self.settings.push(setting);
        Origin::Setting(self.settings.len() - 1)
    }

    /// Line and column of a span. Spans outside the text are moved to its end.
    pub fn place(&self, span: &Range<usize>) -> Place {
        let mut start = span.start.min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let before = &self.text[..start];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        Place {
            span: start..span.end.clamp(start, self.text.len()),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_lines_and_characters_from_one() {
        let source = Source::new("a.toml", "µ = 1\nabc = 2\n");
        let place = source.place(&(11..12));
        assert_eq!((place.line, place.column), (2, 5));
        let end = source.place(&(500..600));
        assert_eq!((end.line, end.column, end.span), (3, 1, 15..15));
        // The second byte of µ is not the start of a character.
        assert_eq!(source.place(&(1..2)).span.start, 0);
    }
}
