//! The response of a drive as users read it.

use crate::Header;
use crate::drive::steady::VariedRow;
use serde::Serialize;
use serde::ser::SerializeMap;

/// The answer; numbers in SI units, speeds in rpm.
#[derive(Debug, Clone, Serialize)]
pub struct DriveResponseDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// What varies.
    pub parameter: VariedRow,
    /// Orders of the excitation.
    pub orders: Vec<f64>,
    /// The response at every value that has one.
    pub points: Vec<ResponseRow>,
}

/// The response at one value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResponseRow {
    /// The value.
    pub value: f64,
    /// Speed of the driver, rpm.
    pub speed: f64,
    /// The measures by name.
    #[serde(serialize_with = "by_name")]
    pub measures: Vec<OrderMeasureRow>,
}

/// One measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OrderMeasureRow {
    /// Its name.
    #[serde(skip)]
    pub name: String,
    /// Unit.
    #[serde(skip)]
    pub unit: &'static str,
    /// Mean: the steady value.
    pub mean: f64,
    /// Root mean square about the mean.
    pub rms: f64,
    /// Largest value.
    pub max: f64,
    /// Smallest value.
    pub min: f64,
    /// Complex amplitudes in the order of the document's `orders`; none for what is not linear in the motion.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub orders: Vec<[f64; 2]>,
}

fn by_name<S: serde::Serializer>(measures: &[OrderMeasureRow], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(measures.len()))?;
    for measure in measures {
        map.serialize_entry(&measure.name, measure)?;
    }
    map.end()
}
