//! Text with sub- and superscripts, measured with the bundled font.
//!
//! The font is Liberation Sans, whose glyph widths equal those of Arial and Helvetica: an SVG shown with one
//! of those keeps its layout. Text may contain `_{…}` and `^{…}`; everything else is literal.

use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// Liberation Sans Regular 2.1.5; its licence (SIL OFL 1.1) lies beside the file.
pub(super) const FONT: &[u8] = include_bytes!("../../assets/liberation-sans/LiberationSans-Regular.ttf");

/// Families by preference; all but the last have the metrics of the bundled font.
pub(super) const FAMILIES: &str = "Liberation Sans, Arial, Helvetica, sans-serif";

/// Size of a script relative to the type it belongs to.
pub(super) const SCRIPT_SIZE: f64 = 0.72;
/// Height above the base line that capitals and digits reach, relative to the type size.
pub(super) const CAP_HEIGHT: f64 = 0.73;
/// Depth of descenders below the base line, relative to the type size.
pub(super) const DESCENT: f64 = 0.22;

/// Position of a run relative to the base line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Script {
    Normal,
    Lowered,
    Raised,
}

impl Script {
    /// Downward shift relative to the type size.
    pub fn shift(self) -> f64 {
        match self {
            Script::Normal => 0.0,
            Script::Lowered => 0.2,
            Script::Raised => -0.36,
        }
    }
}

/// A stretch of text of one size and position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Run {
    pub text: String,
    pub script: Script,
}

/// Splits a text into runs. A brace that is never closed is literal.
pub(super) fn runs(text: &str) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut plain = String::new();
    let mut rest = text;
    while !rest.is_empty() {
        let script = match rest.get(..2) {
            Some("_{") => Some(Script::Lowered),
            Some("^{") => Some(Script::Raised),
            _ => None,
        };
        if let (Some(script), Some(end)) = (script, rest.find('}')) {
            if !plain.is_empty() {
                runs.push(Run {
                    text: std::mem::take(&mut plain),
                    script: Script::Normal,
                });
            }
            runs.push(Run {
                text: rest[2..end].to_string(),
                script,
            });
            rest = &rest[end + 1..];
        } else if let Some(first) = rest.chars().next() {
            plain.push(first);
            rest = &rest[first.len_utf8()..];
        }
    }
    if !plain.is_empty() {
        runs.push(Run {
            text: plain,
            script: Script::Normal,
        });
    }
    runs
}

/// Width of a text at a type size, points.
pub(super) fn width(text: &str, size: f64) -> f64 {
    runs(text)
        .iter()
        .map(|run| {
            let scale = if run.script == Script::Normal {
                size
            } else {
                size * SCRIPT_SIZE
            };
            scale * run.text.chars().map(advance).sum::<f64>()
        })
        .sum()
}

/// Breaks a text at spaces into lines of at most `limit` points; a single longer word stays whole.
pub(super) fn lines(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), size) <= limit => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

/// The text, cut behind a character and closed with an ellipsis where it is wider than `limit` points.
pub(super) fn shortened(text: &str, size: f64, limit: f64) -> String {
    if width(text, size) <= limit {
        return text.to_string();
    }
    let mut kept = text.to_string();
    while kept.pop().is_some() && width(&format!("{kept}…"), size) > limit {}
    format!("{}…", kept.trim_end())
}

/// The type size, at most `size`, at which all texts are at most `limit` points wide.
pub(super) fn fitting_size<'a>(texts: impl Iterator<Item = &'a str>, size: f64, limit: f64) -> f64 {
    let widest = texts.map(|text| width(text, size)).fold(0.0, f64::max);
    if widest > limit {
        size * (limit / widest).max(0.1)
    } else {
        size
    }
}

/// Advance of a character relative to the type size; a usual width for one the font lacks.
fn advance(character: char) -> f64 {
    const USUAL: f64 = 0.6;
    let Ok(font) = FontRef::new(FONT) else {
        return USUAL;
    };
    let metrics = font.glyph_metrics(Size::unscaled(), LocationRef::default());
    let units_per_em = font
        .metrics(Size::unscaled(), LocationRef::default())
        .units_per_em;
    font.charmap()
        .map(character)
        .and_then(|glyph| metrics.advance_width(glyph))
        .map_or(USUAL, |units| f64::from(units) / f64::from(units_per_em.max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_are_split_off() {
        let normal = |text: &str| Run {
            text: text.into(),
            script: Script::Normal,
        };
        let lowered = |text: &str| Run {
            text: text.into(),
            script: Script::Lowered,
        };
        assert_eq!(runs("K_{d} = 5"), [normal("K"), lowered("d"), normal(" = 5")]);
        assert_eq!(runs("clutch_torque"), [normal("clutch_torque")]);
        assert_eq!(runs("a_{b"), [normal("a_{b")]);
        assert!(runs("").is_empty());
    }

    #[test]
    fn the_font_has_what_labels_need() {
        let font = FontRef::new(FONT).unwrap();
        let charmap = font.charmap();
        for character in "azAZ09ΩωδζθαβΣμπ·−–°²×±≤≥éü√∞…′".chars() {
            assert!(charmap.map(character).is_some(), "{character}");
        }
    }

    #[test]
    fn long_labels_are_broken_at_spaces() {
        let text = "Clutch torque (N m)";
        assert_eq!(lines(text, 8.0, 1000.0), [text]);
        assert_eq!(lines(text, 8.0, 55.0), ["Clutch torque", "(N m)"]);
        assert_eq!(lines("word", 8.0, 1.0), ["word"]);
        let size = fitting_size([text].into_iter(), 8.0, 30.0);
        assert!((width(text, size) - 30.0).abs() < 1e-9);
    }

    #[test]
    fn a_long_name_is_cut_to_its_room() {
        assert_eq!(shortened("alternator", 7.0, 100.0), "alternator");
        let cut = shortened("alternator clutch", 7.0, 40.0);
        assert!(
            cut.starts_with("altern") && cut.ends_with('…') && width(&cut, 7.0) <= 40.0,
            "{cut}"
        );
        assert_eq!(shortened("alternator", 7.0, 1.0), "…");
    }

    #[test]
    fn widths_are_those_of_the_font() {
        // 1139 of 2048 units for a digit of this family.
        assert!((width("00", 10.0) - 2.0 * 10.0 * 1139.0 / 2048.0).abs() < 1e-9);
        assert!(width("x_{d}", 10.0) < width("xd", 10.0));
    }
}
