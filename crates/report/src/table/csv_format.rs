//! CSV by RFC 4180.

use std::io::Write;

use super::{Column, Table, Values};
use crate::ReportError;

/// Writes a table that has passed its checks.
pub(super) fn write(table: &Table, out: impl Write) -> Result<(), ReportError> {
    let failed = |source| ReportError::Csv {
        table: table.name.clone(),
        source,
    };
    let mut writer = csv::WriterBuilder::new()
        .terminator(csv::Terminator::CRLF)
        .from_writer(out);
    writer
        .write_record(table.columns.iter().map(header))
        .map_err(failed)?;
    for row in 0..table.rows() {
        writer
            .write_record(table.columns.iter().map(|column| cell(&column.values, row)))
            .map_err(failed)?;
    }
    writer.flush().map_err(|error| failed(error.into()))
}

fn header(column: &Column) -> String {
    if column.unit.is_empty() {
        column.name.clone()
    } else {
        format!("{} [{}]", column.name, column.unit)
    }
}

fn cell(values: &Values, row: usize) -> String {
    match values {
        Values::Number(values) => number(values[row]),
        Values::Text(values) => values[row].clone(),
        Values::Integer(values) => values[row].to_string(),
        Values::Boolean(values) => values[row].to_string(),
    }
}

/// The shortest decimal that reads back to the same bits; empty for NaN, `inf` and `-inf` for the infinities.
fn number(value: f64) -> String {
    if value.is_nan() {
        return String::new();
    }
    // The debug form turns to exponents for very large and very small numbers; the display form writes
    // hundreds of zeros there.
    let text = format!("{value:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_string(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn header_quotes_and_missing_values() {
        let table = Table {
            name: "t".into(),
            columns: vec![
                Column::number("x", "rad/s", vec![0.1, f64::NAN, 1e300, -0.0]),
                Column::text(
                    "a \"quoted\", name",
                    vec!["p,q".into(), String::new(), "r\ns".into(), "é".into()],
                ),
                Column::integer("n", vec![1, -2, i64::MAX, 0]),
                Column::boolean("stable", vec![true, false, true, true]),
            ],
        };
        assert_eq!(
            String::from_utf8(table.csv().unwrap()).unwrap(),
            "x [rad/s],\"a \"\"quoted\"\", name\",n,stable\r\n\
             0.1,\"p,q\",1,true\r\n,,-2,false\r\n1e300,\"r\ns\",9223372036854775807,true\r\n-0,é,0,true\r\n"
        );
    }

    proptest! {
        #[test]
        fn numbers_read_back_bit_for_bit(values in proptest::collection::vec(any::<f64>(), 1..40)) {
            let table = Table { name: "t".into(), columns: vec![Column::number("x", "", values.clone())] };
            let bytes = table.csv().unwrap();
            let mut reader = csv::Reader::from_reader(bytes.as_slice());
            let read: Vec<f64> = reader
                .records()
                .map(|record| {
                    let record = record.unwrap();
                    if record[0].is_empty() { f64::NAN } else { record[0].parse().unwrap() }
                })
                .collect();
            prop_assert_eq!(read.len(), values.len());
            for (a, b) in read.iter().zip(&values) {
                prop_assert!(a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()));
            }
        }
    }
}
