//! Warnings at the foot of a page, below all panels.

use super::color::Color;
use super::margins::EDGE;
use super::style::SMALL_TYPE;
use super::svg::{Anchor, Svg, number};
use super::text;

/// Distance of base lines, points.
const LINE: f64 = 8.8;
/// Distance of the warnings from the panels.
const GAP: f64 = 3.0;
/// Room for the sign before a warning.
const SIGN: f64 = 9.0;
/// More warnings are counted instead of written.
const MOST: usize = 8;

/// The lines of the warnings and the height at which they start.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct WarningLayout {
    warnings: Vec<Vec<String>>,
    size: f64,
    top: f64,
}

impl WarningLayout {
    /// What the warnings add to the height of the page; 0 without any.
    pub fn height(&self) -> f64 {
        let lines: usize = self.warnings.iter().map(Vec::len).sum();
        if lines == 0 {
            0.0
        } else {
            GAP + LINE * lines as f64
        }
    }

    /// The same warnings below a page of a height.
    pub fn moved(self, top: f64) -> Self {
        WarningLayout { top, ..self }
    }
}

/// The different warnings, broken into lines for a page of a width.
pub(super) fn layout<'a>(all: impl Iterator<Item = &'a String>, width: f64) -> WarningLayout {
    let mut different: Vec<&str> = Vec::new();
    for warning in all {
        if !warning.trim().is_empty() && !different.contains(&warning.as_str()) {
            different.push(warning);
        }
    }
    let room = width - 2.0 * EDGE - SIGN;
    let mut warnings: Vec<Vec<String>> = different
        .iter()
        .take(MOST)
        .map(|warning| text::lines(warning, SMALL_TYPE, room))
        .collect();
    if different.len() > MOST {
        warnings.push(vec![format!("{} more warnings", different.len() - MOST)]);
    }
    let size = text::fitting_size(warnings.iter().flatten().map(String::as_str), SMALL_TYPE, room);
    WarningLayout {
        warnings,
        size,
        top: 0.0,
    }
}

/// Writes the warnings, each behind a sign.
pub(super) fn draw(svg: &mut Svg, layout: &WarningLayout) {
    let mut base = layout.top - EDGE + GAP + 0.8 * LINE;
    for lines in &layout.warnings {
        let data = format!("M{} {}l3 -5.6l3 5.6Z", number(EDGE), number(base));
        svg.path(&data, None, Some(Color::VERMILLION));
        for line in lines {
            svg.text(EDGE + SIGN, base, layout.size, Anchor::Start, line);
            base += LINE;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_is_written_once_and_broken_to_the_page() {
        let warnings: Vec<String> = ["span 2 is slack at 2100 rpm", "", "span 2 is slack at 2100 rpm"]
            .map(String::from)
            .to_vec();
        let wide = layout(warnings.iter(), 400.0);
        assert_eq!(wide.warnings, [["span 2 is slack at 2100 rpm"]]);
        assert!((wide.height() - GAP - LINE).abs() < 1e-12);
        assert!(layout(warnings.iter(), 70.0).warnings[0].len() > 1);
        assert_eq!(layout([].iter(), 400.0).height(), 0.0);
    }

    #[test]
    fn many_warnings_are_counted() {
        let warnings: Vec<String> = (0..20).map(|i| format!("warning {i}")).collect();
        let layout = layout(warnings.iter(), 400.0);
        assert_eq!(layout.warnings.len(), MOST + 1);
        assert_eq!(layout.warnings[MOST], ["12 more warnings"]);
    }
}
