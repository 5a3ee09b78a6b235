//! Parquet through the column writer, without Arrow.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use super::{Column, Table, Values};
use crate::ReportError;

/// Writes a table that has passed its checks.
pub(super) fn write(table: &Table, out: impl Write + Send) -> Result<(), ReportError> {
    try_write(table, out).map_err(|source| ReportError::Parquet {
        table: table.name.clone(),
        source,
    })
}

fn try_write(table: &Table, out: impl Write + Send) -> Result<(), ParquetError> {
    let fields = table.columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Arc::new(Type::group_type_builder("table").with_fields(fields).build()?);
    let properties = WriterProperties::builder()
        // The library's own default names its version; a fixed name keeps files equal across updates.
        .set_created_by("slackside".to_string())
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(metadata(table)))
        .build();
    let mut file = SerializedFileWriter::new(out, schema, Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for column in &table.columns {
        if let Some(mut writer) = group.next_column()? {
            write_values(&mut writer, &column.values)?;
            writer.close()?;
        }
    }
    group.close()?;
    file.close()?;
    Ok(())
}

fn metadata(table: &Table) -> Vec<KeyValue> {
    let mut entries = vec![KeyValue::new("table".to_string(), table.name.clone())];
    for column in table.columns.iter().filter(|column| !column.unit.is_empty()) {
        entries.push(KeyValue::new(
            format!("unit.{}", column.name),
            column.unit.clone(),
        ));
    }
    entries
}

fn field(column: &Column) -> Result<Arc<Type>, ParquetError> {
    let (physical, repetition, logical) = match column.values {
        Values::Number(_) => (PhysicalType::DOUBLE, Repetition::OPTIONAL, None),
        Values::Text(_) => (
            PhysicalType::BYTE_ARRAY,
            Repetition::OPTIONAL,
            Some(LogicalType::String),
        ),
        Values::Integer(_) => (PhysicalType::INT64, Repetition::REQUIRED, None),
        Values::Boolean(_) => (PhysicalType::BOOLEAN, Repetition::REQUIRED, None),
    };
    let field = Type::primitive_type_builder(&column.name, physical)
        .with_repetition(repetition)
        .with_logical_type(logical)
        .build()?;
    Ok(Arc::new(field))
}

/// Values that are present go to the page, and one definition level (1 present, 0 missing) for every row.
fn write_values(writer: &mut SerializedColumnWriter<'_>, values: &Values) -> Result<(), ParquetError> {
    match values {
        Values::Number(values) => {
            let levels: Vec<i16> = values.iter().map(|value| i16::from(!value.is_nan())).collect();
            let present: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
            writer
                .typed::<DoubleType>()
                .write_batch(&present, Some(&levels), None)?;
        }
        Values::Text(values) => {
            let levels: Vec<i16> = values.iter().map(|value| i16::from(!value.is_empty())).collect();
            let present: Vec<ByteArray> = values
                .iter()
                .filter(|value| !value.is_empty())
                .map(|value| ByteArray::from(value.as_str()))
                .collect();
            writer
                .typed::<ByteArrayType>()
                .write_batch(&present, Some(&levels), None)?;
        }
        Values::Integer(values) => {
            writer.typed::<Int64Type>().write_batch(values, None, None)?;
        }
        Values::Boolean(values) => {
            writer.typed::<BoolType>().write_batch(values, None, None)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    use super::*;

    fn reader(table: &Table) -> SerializedFileReader<std::fs::File> {
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&table.parquet().unwrap()).unwrap();
        SerializedFileReader::new(file).unwrap()
    }

    fn rows(table: &Table) -> Vec<Vec<Field>> {
        let rows = reader(table).into_iter();
        rows.map(|row| {
            row.unwrap()
                .into_columns()
                .into_iter()
                .map(|(_, field)| field)
                .collect()
        })
        .collect()
    }

    fn example() -> Table {
        Table {
            name: "response".into(),
            columns: vec![
                Column::number("frequency", "Hz", vec![0.1, f64::NAN, f64::INFINITY]),
                Column::text("kind", vec!["fold".into(), String::new(), "Ω".into()]),
                Column::integer("period", vec![1, 2, -3]),
                Column::boolean("stable", vec![true, false, true]),
            ],
        }
    }

    #[test]
    fn values_nulls_and_units_read_back() {
        let table = example();
        let reader = reader(&table);
        let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap();
        let metadata = |key: &str| metadata.iter().find(|entry| entry.key == key)?.value.clone();
        assert_eq!(
            rows(&table),
            vec![
                vec![
                    Field::Double(0.1),
                    Field::Str("fold".into()),
                    Field::Long(1),
                    Field::Bool(true)
                ],
                vec![Field::Null, Field::Null, Field::Long(2), Field::Bool(false)],
                vec![
                    Field::Double(f64::INFINITY),
                    Field::Str("Ω".into()),
                    Field::Long(-3),
                    Field::Bool(true)
                ],
            ]
        );
        assert_eq!(metadata("unit.frequency").as_deref(), Some("Hz"));
        assert_eq!(metadata("unit.kind"), None);
        assert_eq!(metadata("table").as_deref(), Some("response"));
    }

    #[test]
    fn equal_tables_give_equal_bytes() {
        assert_eq!(example().parquet().unwrap(), example().parquet().unwrap());
    }

    #[test]
    fn a_table_without_rows_reads_back_empty() {
        let table = Table {
            name: "empty".into(),
            columns: vec![Column::number("x", "m", vec![])],
        };
        assert!(rows(&table).is_empty());
    }

    #[test]
    fn unequal_columns_and_repeated_names_are_refused() {
        let mut table = example();
        table.columns[1].values = Values::Text(vec!["fold".into()]);
        assert!(matches!(
            table.parquet(),
            Err(ReportError::ColumnLength {
                length: 1,
                expected: 3,
                ..
            })
        ));
        let mut table = example();
        table.columns[2].name = "frequency".into();
        assert!(matches!(table.csv(), Err(ReportError::DuplicateColumn { .. })));
        assert!(matches!(
            Table::new("none").csv(),
            Err(ReportError::NoColumns { .. })
        ));
    }
}
