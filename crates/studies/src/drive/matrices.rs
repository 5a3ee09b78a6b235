//! The linear model of a drive as numbers, for those who go on with it elsewhere (theory 04 §3).

use serde::Serialize;
use slackside_belt_drive::dimensionless::Dimensionless;
use slackside_belt_drive::drive::Drive;
use slackside_belt_drive::model::LinearModel;
use slackside_belt_drive::steady::SteadyState;
use slackside_linalg::Matrix;

/// Matrices of `M q̈ + (C + G) q̇ + (K + K_c) q = f` by rows, in SI units, with the driver's coordinate. Damping by modes is
/// not part of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Matrices {
    /// Names of the coordinates.
    pub coordinates: Vec<String>,
    /// `M`.
    pub mass: Vec<Vec<f64>>,
    /// `G`.
    pub gyroscopic: Vec<Vec<f64>>,
    /// `C`.
    pub damping: Vec<Vec<f64>>,
    /// `K`.
    pub stiffness: Vec<Vec<f64>>,
    /// `K_c`.
    pub circulatory: Vec<Vec<f64>>,
    /// Elongations of the spans, spans by coordinates.
    pub stretch: Vec<Vec<f64>>,
    /// Stiffness of each span, N/m: dynamic tensions are these times the elongations, plus the dashpots times their rates.
    pub span_stiffness: Vec<f64>,
    /// Dashpot of each span, N·s/m.
    pub span_dashpots: Vec<f64>,
    /// Scales and dimensionless groups.
    pub dimensionless: Groups,
}

/// The dimensionless form with the longest span and the mean tension as references (theory 04 §3.9).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Groups {
    /// Reference length, m.
    pub length: f64,
    /// Reference force, N.
    pub force: f64,
    /// Reference time, s.
    pub time: f64,
    /// Belt speed `s`.
    pub speed: f64,
    /// Bending `ε`.
    pub bending: f64,
    /// Axial stiffness `γ`.
    pub stretch: f64,
    /// Inertia of each pulley.
    pub pulley_inertia: Vec<f64>,
    /// Inertia of each tensioner.
    pub arm_inertia: Vec<f64>,
    /// Spring rate of each tensioner.
    pub arm_spring: Vec<f64>,
    /// Load of each pulley.
    pub load: Vec<f64>,
}

impl Matrices {
    /// The numbers of a model.
    pub fn new(drive: &Drive, steady: &SteadyState, model: &LinearModel) -> Self {
        let names = (0..model.coordinates.len()).map(|index| model.coordinates.name(drive, index));
        let longest = (0..steady.spans.len())
            .max_by(|a, b| {
                let length = |span: usize| steady.layout.spans[span].length;
                length(*a).total_cmp(&length(*b))
            })
            .unwrap_or(0);
        let mean = steady.tensions.iter().sum::<f64>() / steady.tensions.len() as f64;
        let form = Dimensionless::new(drive, steady, model, longest, mean);
        Self {
            coordinates: names.collect(),
            mass: rows(&model.mass),
            gyroscopic: rows(&model.gyroscopic),
            damping: rows(&model.damping),
            stiffness: rows(&model.stiffness),
            circulatory: rows(&model.circulatory),
            stretch: rows(&model.stretch),
            span_stiffness: model.span_stiffness.clone(),
            span_dashpots: model.span_dashpots.clone(),
            dimensionless: Groups {
                length: form.length,
                force: form.force,
                time: form.time,
                speed: form.speed,
                bending: form.bending,
                stretch: form.stretch,
                pulley_inertia: form.pulley_inertia,
                arm_inertia: form.arm_inertia,
                arm_spring: form.arm_spring,
                load: form.load,
            },
        }
    }
}

fn rows(matrix: &Matrix) -> Vec<Vec<f64>> {
    (0..matrix.rows()).map(|i| matrix.row(i).to_vec()).collect()
}
