//! Pixels: PNG of a whole figure, and the images that heat maps embed.

use std::sync::{Arc, LazyLock};

use resvg::{tiny_skia, usvg};

use super::color::Color;
use super::text::FONT;
use crate::ReportError;

/// Largest side of a PNG, pixels.
const LIMIT: u32 = 16_384;

/// The bundled font, and nothing of the machine, so that pixels are the same everywhere.
static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("Liberation Sans");
    Arc::new(fonts)
});

/// Draws an SVG of this crate; see [`super::Figure::png`].
pub(super) fn svg_to_png(svg: &str, scale: f64) -> Result<Vec<u8>, ReportError> {
    let options = usvg::Options {
        font_family: "Liberation Sans".to_string(),
        fontdb: FONTS.clone(),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| ReportError::Raster {
        reason: error.to_string(),
    })?;
    let size = tree.size();
    let width = (f64::from(size.width()) * scale).ceil();
    let height = (f64::from(size.height()) * scale).ceil();
    let permitted = 1.0..=f64::from(LIMIT);
    if !permitted.contains(&width) || !permitted.contains(&height) {
        return Err(ReportError::RasterSize {
            scale,
            width,
            height,
            limit: LIMIT,
        });
    }
    let mut pixels =
        tiny_skia::Pixmap::new(width as u32, height as u32).ok_or_else(|| ReportError::Raster {
            reason: "no memory for the pixels".to_string(),
        })?;
    pixels.fill(tiny_skia::Color::WHITE);
    let transform = tiny_skia::Transform::from_scale(scale as f32, scale as f32);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| ReportError::Raster {
        reason: error.to_string(),
    })
}

/// PNG of cells, one pixel each, rows from the bottom; `None` for no cells, more than the format holds, or a
/// number of cells that is no multiple of `columns`.
pub(super) fn cells_to_png(columns: usize, cells: &[Color]) -> Option<Vec<u8>> {
    if columns == 0 || cells.is_empty() || !cells.len().is_multiple_of(columns) {
        return None;
    }
    let rows = cells.len() / columns;
    let mut pixels = tiny_skia::Pixmap::new(u32::try_from(columns).ok()?, u32::try_from(rows).ok()?)?;
    // The image starts at the top.
    for (target, row) in pixels
        .pixels_mut()
        .chunks_mut(columns)
        .zip(cells.chunks(columns).rev())
    {
        for (pixel, color) in target.iter_mut().zip(row) {
            *pixel = tiny_skia::PremultipliedColorU8::from_rgba(color.0, color.1, color.2, 255)?;
        }
    }
    pixels.encode_png().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_become_pixels_with_the_first_row_at_the_bottom() {
        let cells = [Color::BLACK, Color::WHITE, Color::BLUE, Color::ORANGE];
        let image = tiny_skia::Pixmap::decode_png(&cells_to_png(2, &cells).unwrap()).unwrap();
        let color = |x, y| {
            let pixel = image.pixel(x, y).unwrap();
            Color(pixel.red(), pixel.green(), pixel.blue())
        };
        assert_eq!([color(0, 1), color(1, 1), color(0, 0), color(1, 0)], cells);
        assert!(cells_to_png(0, &cells).is_none() && cells_to_png(3, &cells).is_none());
    }

    #[test]
    fn senseless_scales_are_refused() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"85mm\" height=\"60mm\"/>";
        for scale in [0.0, -1.0, f64::NAN, 1e9] {
            assert!(matches!(
                svg_to_png(svg, scale),
                Err(ReportError::RasterSize { .. })
            ));
        }
        assert!(svg_to_png("<svg", 1.0).is_err());
    }
}
