//! Tables on the terminal.

use comfy_table::{CellAlignment, ContentArrangement, Table, TableComponent, presets};

/// A table of texts; the first column is aligned left, the others right.
pub fn table(head: &[&str], rows: Vec<Vec<String>>) -> String {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .remove_style(TableComponent::HorizontalLines)
        .remove_style(TableComponent::MiddleIntersections)
        .remove_style(TableComponent::LeftBorderIntersections)
        .remove_style(TableComponent::RightBorderIntersections)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(head.to_vec());
    for row in rows {
        table.add_row(row);
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        if index > 0 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.to_string()
}

/// A number with as many digits as people read.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let size = value.abs();
    if !value.is_finite() {
        "–".to_owned()
    } else if !(1e-4..1e6).contains(&size) {
        format!("{value:.5e}")
    } else {
        let digits = (6 - size.log10().floor() as i32 - 1).clamp(0, 10);
        format!("{value:.*}", usize::try_from(digits).unwrap_or(0))
    }
}

/// `frequency (Hz)`, or the bare name where there is no unit.
pub fn with_unit(name: &str, unit: &str) -> String {
    match unit {
        "" | "–" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}
