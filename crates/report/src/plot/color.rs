//! Colours that people with and without colour vision, and a grey printer, can tell apart.
//!
//! Qualitative colours are those of Okabe and Ito (2008). The sequential map follows viridis, whose luminance
//! rises steadily, so that it stays ordered in grey.

/// A colour, red, green and blue from 0 to 255.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Color(pub u8, pub u8, pub u8);

impl Color {
    /// Black.
    pub const BLACK: Color = Color(0, 0, 0);
    /// White.
    pub const WHITE: Color = Color(255, 255, 255);
    /// Okabe–Ito orange.
    pub const ORANGE: Color = Color(230, 159, 0);
    /// Okabe–Ito sky blue.
    pub const SKY_BLUE: Color = Color(86, 180, 233);
    /// Okabe–Ito bluish green.
    pub const GREEN: Color = Color(0, 158, 115);
    /// Okabe–Ito yellow.
    pub const YELLOW: Color = Color(240, 228, 66);
    /// Okabe–Ito blue.
    pub const BLUE: Color = Color(0, 114, 178);
    /// Okabe–Ito vermillion.
    pub const VERMILLION: Color = Color(213, 94, 0);
    /// Okabe–Ito reddish purple.
    pub const PURPLE: Color = Color(204, 121, 167);
    /// Mid grey, for what stays in the background.
    pub const GREY: Color = Color(120, 120, 120);
    /// Light grey, for shading.
    pub const LIGHT_GREY: Color = Color(222, 222, 222);

    /// The colour as `#rrggbb`.
    pub fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }

    /// Luma by ITU-R BT.601, 0 (black) to 1 (white): how light the colour is on a grey printer.
    pub fn luma(self) -> f64 {
        (0.299 * f64::from(self.0) + 0.587 * f64::from(self.1) + 0.114 * f64::from(self.2)) / 255.0
    }
}

/// Colours of curves of one panel, in order; neighbours differ in hue and in luminance.
const CURVES: [Color; 7] = [
    Color::BLACK,
    Color::BLUE,
    Color::ORANGE,
    Color::VERMILLION,
    Color::SKY_BLUE,
    Color::GREEN,
    Color::PURPLE,
];

/// Colours of areas of one map, in order; the first four differ strongly in luminance.
const CATEGORIES: [Color; 8] = [
    Color::BLUE,
    Color::YELLOW,
    Color::SKY_BLUE,
    Color::BLACK,
    Color::VERMILLION,
    Color::GREEN,
    Color::PURPLE,
    Color::ORANGE,
];

/// The colour of curve number `index`; repeats after seven.
pub fn curve_color(index: usize) -> Color {
    CURVES[index % CURVES.len()]
}

/// The colour of category number `index`; repeats after eight.
pub fn category_color(index: usize) -> Color {
    CATEGORIES[index % CATEGORIES.len()]
}

/// Samples of viridis at equal distances.
const SEQUENTIAL: [Color; 10] = [
    Color(0x44, 0x01, 0x54),
    Color(0x48, 0x28, 0x78),
    Color(0x3e, 0x49, 0x89),
    Color(0x31, 0x68, 0x8e),
    Color(0x26, 0x82, 0x8e),
    Color(0x1f, 0x9e, 0x89),
    Color(0x35, 0xb7, 0x79),
    Color(0x6e, 0xce, 0x58),
    Color(0xb5, 0xde, 0x2b),
    Color(0xfd, 0xe7, 0x25),
];

/// The colour of the sequential map at `fraction`, 0 (dark) to 1 (light); values outside are clamped.
pub fn sequential_color(fraction: f64) -> Color {
    let position = fraction.clamp(0.0, 1.0) * (SEQUENTIAL.len() - 1) as f64;
    let index = (position as usize).min(SEQUENTIAL.len() - 2);
    let weight = position - index as f64;
    let (low, high) = (SEQUENTIAL[index], SEQUENTIAL[index + 1]);
    let mix = |a: u8, b: u8| (f64::from(a) + weight * (f64::from(b) - f64::from(a))).round() as u8;
    Color(mix(low.0, high.0), mix(low.1, high.1), mix(low.2, high.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sequential_map_grows_lighter_throughout() {
        let luma: Vec<f64> = (0..=100)
            .map(|i| sequential_color(f64::from(i) / 100.0).luma())
            .collect();
        assert!(luma.windows(2).all(|pair| pair[1] > pair[0] - 0.004));
        assert!(luma[100] - luma[0] > 0.7);
    }

    #[test]
    fn the_first_colours_differ_in_grey() {
        for count in [3, 4] {
            for i in 0..count {
                for j in 0..i {
                    let curves = (curve_color(i).luma() - curve_color(j).luma()).abs();
                    let areas = (category_color(i).luma() - category_color(j).luma()).abs();
                    assert!(curves > 0.09 && areas > 0.2, "{i} {j}: {curves} {areas}");
                }
            }
        }
    }
}
