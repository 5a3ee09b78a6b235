//! Writing SVG: elements, numbers with two decimals, text that remembers where it stands.
//!
//! The drawing uses no identifiers (clipping by nested `svg` elements), so that several figures can stand in
//! one HTML page.

use std::fmt::Write;

use base64::Engine;

use super::color::Color;
use super::style::Stroke;
use super::text::{self, CAP_HEIGHT, DESCENT, FAMILIES, SCRIPT_SIZE, Script};

/// A rectangle in points, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

impl Rect {
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }

    /// The rectangle grown by `by` on all sides.
    pub fn grown(&self, by: f64) -> Rect {
        Rect {
            x: self.x - by,
            y: self.y - by,
            width: self.width + 2.0 * by,
            height: self.height + 2.0 * by,
        }
    }

    pub fn intersects(&self, other: &Rect) -> bool {
        self.x < other.right() && other.x < self.right() && self.y < other.bottom() && other.y < self.bottom()
    }
}

/// A piece of text and the box it occupies, points from the upper left corner of the figure, y downwards.
#[derive(Debug, Clone, PartialEq)]
pub struct TextBox {
    /// The text, with its `_{…}` and `^{…}`.
    pub text: String,
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl TextBox {
    /// Whether two pieces of text overlap.
    pub fn overlaps(&self, other: &TextBox) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }
}

/// Which point of a text its coordinates name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn name(self) -> &'static str {
        match self {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        }
    }

    fn offset(self, width: f64) -> f64 {
        match self {
            Anchor::Start => 0.0,
            Anchor::Middle => -width / 2.0,
            Anchor::End => -width,
        }
    }
}

/// An SVG document under construction.
pub(super) struct Svg {
    width: f64,
    height: f64,
    body: String,
    texts: Vec<TextBox>,
}

impl Svg {
    /// An empty white page, sizes in points.
    pub fn new(width: f64, height: f64) -> Self {
        let mut svg = Svg {
            width,
            height,
            body: String::new(),
            texts: Vec::new(),
        };
        svg.fill_rect(
            Rect {
                x: 0.0,
                y: 0.0,
                width,
                height,
            },
            Color::WHITE,
        );
        svg
    }

    /// The document.
    pub fn finish(self) -> String {
        const POINTS_PER_MILLIMETRE: f64 = 72.0 / 25.4;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" \
             font-family=\"{FAMILIES}\" fill=\"none\" stroke-linejoin=\"round\">\n{}</svg>\n",
            number(self.width / POINTS_PER_MILLIMETRE),
            number(self.height / POINTS_PER_MILLIMETRE),
            number(self.width),
            number(self.height),
            self.body
        )
    }

    /// The text that was written.
    pub fn into_texts(self) -> Vec<TextBox> {
        self.texts
    }

    /// Adds one element or tag.
    fn element(&mut self, element: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.body.write_fmt(element);
        self.body.push('\n');
    }

    /// Restricts what follows, up to [`Svg::end_clip`], to a rectangle; coordinates stay those of the page.
    pub fn begin_clip(&mut self, rect: Rect) {
        let (x, y, w, h) = (
            number(rect.x),
            number(rect.y),
            number(rect.width),
            number(rect.height),
        );
        self.element(format_args!(
            "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\" overflow=\"hidden\">"
        ));
    }

    /// Ends the restriction of [`Svg::begin_clip`].
    pub fn end_clip(&mut self) {
        self.element(format_args!("</svg>"));
    }

    /// A filled rectangle.
    pub fn fill_rect(&mut self, rect: Rect, color: Color) {
        self.element(format_args!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>",
            number(rect.x),
            number(rect.y),
            number(rect.width),
            number(rect.height),
            color.hex()
        ));
    }

    /// An outlined rectangle.
    pub fn stroke_rect(&mut self, rect: Rect, stroke: Stroke) {
        self.element(format_args!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>",
            number(rect.x),
            number(rect.y),
            number(rect.width),
            number(rect.height),
            stroke_attributes(stroke)
        ));
    }

    /// A path with a stroke, a fill or both; nothing for an empty path.
    pub fn path(&mut self, data: &str, stroke: Option<Stroke>, fill: Option<Color>) {
        if data.is_empty() {
            return;
        }
        let stroke = stroke.map(stroke_attributes).unwrap_or_default();
        let fill = fill
            .map(|color| format!(" fill=\"{}\"", color.hex()))
            .unwrap_or_default();
        self.element(format_args!("<path d=\"{data}\"{stroke}{fill}/>"));
    }

    /// An image stretched over a rectangle, its cells with hard edges.
    pub fn image(&mut self, rect: Rect, png: &[u8]) {
        self.element(format_args!(
            "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
             image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" \
             href=\"data:image/png;base64,{}\"/>",
            number(rect.x),
            number(rect.y),
            number(rect.width),
            number(rect.height),
            base64::engine::general_purpose::STANDARD.encode(png)
        ));
    }

    /// Black text on the base line `y`.
    pub fn text(&mut self, x: f64, y: f64, size: f64, anchor: Anchor, content: &str) {
        if content.is_empty() {
            return;
        }
        let width = text::width(content, size);
        let left = x + anchor.offset(width);
        self.texts.push(TextBox {
            text: content.to_string(),
            left,
            top: y - CAP_HEIGHT * size,
            right: left + width,
            bottom: y + DESCENT * size,
        });
        let position = format!("x=\"{}\" y=\"{}\"", number(x), number(y));
        self.write_text(&position, size, anchor, content);
    }

    /// Black text that reads upwards, centred on `y`, its base line at `x`.
    pub fn upward_text(&mut self, x: f64, y: f64, size: f64, content: &str) {
        if content.is_empty() {
            return;
        }
        let half = text::width(content, size) / 2.0;
        self.texts.push(TextBox {
            text: content.to_string(),
            left: x - CAP_HEIGHT * size,
            top: y - half,
            right: x + DESCENT * size,
            bottom: y + half,
        });
        let position = format!("transform=\"translate({} {}) rotate(-90)\"", number(x), number(y));
        self.write_text(&position, size, Anchor::Middle, content);
    }

    fn write_text(&mut self, position: &str, size: f64, anchor: Anchor, content: &str) {
        let mut spans = String::new();
        let mut depth = 0.0;
        for run in text::runs(content) {
            let shift = run.script.shift() * size - depth;
            depth += shift;
            let content = escape(&run.text);
            if run.script == Script::Normal && shift == 0.0 {
                spans.push_str(&content);
            } else {
                let scale = if run.script == Script::Normal {
                    1.0
                } else {
                    SCRIPT_SIZE
                };
                let _ = write!(
                    spans,
                    "<tspan dy=\"{}\" font-size=\"{}\">{content}</tspan>",
                    number(shift),
                    number(scale * size)
                );
            }
        }
        self.element(format_args!(
            "<text {position} font-size=\"{}\" text-anchor=\"{}\" fill=\"#000000\" xml:space=\"preserve\">{spans}</text>",
            number(size),
            anchor.name()
        ));
    }
}

fn stroke_attributes(stroke: Stroke) -> String {
    let mut attributes = format!(
        " stroke=\"{}\" stroke-width=\"{}\"",
        stroke.color.hex(),
        number(stroke.width)
    );
    let pattern = stroke.dash.pattern();
    if !pattern.is_empty() {
        let lengths: Vec<String> = pattern.iter().map(|length| number(*length)).collect();
        let _ = write!(attributes, " stroke-dasharray=\"{}\"", lengths.join(" "));
    }
    attributes
}

/// A coordinate with at most two decimals (0.01 point is 3.5 µm), no negative zero, always finite.
pub(super) fn number(value: f64) -> String {
    let value = if value.is_finite() {
        value.clamp(-1e6, 1e6)
    } else {
        0.0
    };
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_string()
    } else {
        text.to_string()
    }
}

/// Text for element content. Characters that XML does not allow are left out.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_finite() {
        assert_eq!(number(1.0), "1");
        assert_eq!(number(-0.001), "0");
        assert_eq!(number(12.345), "12.35");
        assert_eq!(number(f64::NAN), "0");
        assert_eq!(number(1e30), "1000000");
    }

    #[test]
    fn text_is_escaped_and_scripts_return_to_the_base_line() {
        let mut svg = Svg::new(100.0, 50.0);
        svg.text(10.0, 20.0, 10.0, Anchor::Start, "a < b & K_{d} \u{1} c");
        let document = svg.finish();
        let parsed = roxmltree::Document::parse(&document).unwrap();
        let text = parsed
            .descendants()
            .find(|node| node.has_tag_name("text"))
            .unwrap();
        let content: String = text
            .descendants()
            .filter(|n| n.is_text())
            .filter_map(|n| n.text())
            .collect();
        assert_eq!(content, "a < b & Kd   c");
        let shifts: f64 = text
            .descendants()
            .filter_map(|n| n.attribute("dy")?.parse::<f64>().ok())
            .sum();
        assert!(shifts.abs() < 0.02);
    }
}
