//! JSON Schema of model files, so that editors complete and check them.

use std::borrow::Cow;
use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings, json_schema};

use crate::model::Model;

/// Schema of a quantity: a number in SI, or a text with a unit.
pub(crate) struct QuantitySchema;

/// Schema of a table from names to quantities.
pub(crate) type QuantityMapSchema = BTreeMap<String, QuantitySchema>;

/// Schema of a table from names to plain numbers.
pub(crate) type RatioMapSchema = BTreeMap<String, RatioSchema>;

impl JsonSchema for QuantitySchema {
    fn schema_name() -> Cow<'static, str> {
        "Quantity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number in SI units, or a number and a unit in quotes, such as \"88.9 mm\" or \"1500 rpm\".",
            "anyOf": [{ "type": "number" }, { "type": "string" }]
        })
    }
}

/// Schema of a plain number, which may also be a percentage.
pub(crate) struct RatioSchema;

impl JsonSchema for RatioSchema {
    fn schema_name() -> Cow<'static, str> {
        "Ratio".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A plain number, or a percentage in quotes, such as \"3 %\".",
            "anyOf": [{ "type": "number" }, { "type": "string" }]
        })
    }
}

/// JSON Schema (draft 2020-12) of all kinds of model file.
///
/// ```
/// let schema = slackside_model_file::schema();
/// assert_eq!(schema["title"], "Slackside model file");
/// ```
pub fn schema() -> serde_json::Value {
    let settings = SchemaSettings::draft2020_12().for_deserialize();
    let mut schema = settings.into_generator().into_root_schema_for::<Model>();
    schema.insert("title".to_owned(), "Slackside model file".into());
    schema.insert(
        "description".to_owned(),
        "A model for Slackside; `kind` says what the file describes.".into(),
    );
    schema.into()
}
