//! Small vibration about a steady state: mass, gyroscopic, damping and stiffness matrices and the rows that results are
//! read from (theory 04 §3).

mod coordinates;
mod damping;
mod outputs;
mod span_matrices;

pub use coordinates::{Coordinate, Coordinates};
pub use outputs::{Motion, SpanMotion};
pub use span_matrices::SpanMatrices;

use crate::drive::{BeltModel, Coupling, Drive};
use crate::steady::SteadyState;
use slackside_linalg::Matrix;

/// The linear model `M q̈ + (C + G) q̇ + (K + K_c) q = f` with every coordinate, the driver's rotation among them.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearModel {
    /// The coordinates.
    pub coordinates: Coordinates,
    /// Index of the driver's coordinate.
    pub driver: usize,
    /// Mass matrix `M`, symmetric.
    pub mass: Matrix,
    /// Gyroscopic matrix `G`, skew.
    pub gyroscopic: Matrix,
    /// Damping matrix `C` without what [`crate::drive::BeltDamping::modal`] adds to the free coordinates.
    pub damping: Matrix,
    /// Stiffness matrix `K`, symmetric.
    pub stiffness: Matrix,
    /// Circulatory part `K_c` of damping that acts on the material velocity (theory 04 (3.14), (3.15)).
    pub circulatory: Matrix,
    /// Rows `D_i`: elongation of every span, spans by coordinates (theory 04 (3.2)).
    pub stretch: Matrix,
    /// Stiffness `k_i` of every span in the model, N/m; with the static correction of theory 04 (3.11) if asked for.
    pub span_stiffness: Vec<f64>,
    /// Dashpot `c_i` of every span, N·s/m.
    pub span_dashpots: Vec<f64>,
    /// Inertia of pulleys, accessories and arms on their coordinates, without belt; zero for sines.
    pub lumped_inertia: Vec<f64>,
    /// Matrices of every span.
    pub spans: Vec<SpanMatrices>,
    /// For every span, how its local coordinates `[b⁰, b^L, a_1 …]` follow from the global ones.
    pub(crate) local: Vec<LocalMap>,
}

/// Rows of `R_i` as lists of coordinate and factor.
pub(crate) type LocalMap = Vec<Vec<(usize, f64)>>;

impl LinearModel {
    /// The model with every one-way coupling locked.
    pub fn new(drive: &Drive, steady: &SteadyState) -> Self {
        Self::with_disengaged(drive, steady, &[])
    }

    /// The model with the one-way couplings of some pulleys open: their accessories turn freely (theory 04 §3.4).
    pub fn with_disengaged(drive: &Drive, steady: &SteadyState, disengaged: &[usize]) -> Self {
        let coordinates = Coordinates::new(drive, disengaged);
        let size = coordinates.len();
        let zeros = || Matrix::zeros(size, size);
        let spans: Vec<SpanMatrices> = (0..drive.pulleys.len())
            .map(|i| span_matrices(drive, steady, i, coordinates.sines(i).len()))
            .collect();
        let local = (0..drive.pulleys.len())
            .map(|i| local_map(drive, steady, &coordinates, i))
            .collect();
        let stretch = stretch_rows(drive, steady, &coordinates);
        let span_stiffness = (0..drive.pulleys.len())
            .map(|i| span_stiffness(drive, steady, i, coordinates.sines(i).len()))
            .collect();
        let mut model = Self {
            driver: coordinates.pulley(drive.driver),
            lumped_inertia: lumped_inertia(drive, steady, &coordinates, disengaged),
            coordinates,
            mass: zeros(),
            gyroscopic: zeros(),
            damping: zeros(),
            stiffness: zeros(),
            circulatory: zeros(),
            stretch,
            span_stiffness,
            span_dashpots: Vec::new(),
            spans,
            local,
        };
        model.assemble(drive, steady, disengaged);
        damping::add(&mut model, drive, steady, disengaged);
        model
    }

    /// Mass, gyroscopic and stiffness matrices (theory 04 (3.9)).
    fn assemble(&mut self, drive: &Drive, steady: &SteadyState, disengaged: &[usize]) {
        for (index, inertia) in self.lumped_inertia.iter().enumerate() {
            self.mass[(index, index)] = *inertia;
        }
        for (arm, tensioner) in drive.tensioners.iter().enumerate() {
            let at = self.coordinates.arm(arm);
            let geometric: f64 = drive
                .carried_by(arm)
                .map(|j| steady.belt_forces[j].dot(steady.kinematics.centre_curvatures[j][arm]))
                .sum();
            self.stiffness[(at, at)] = tensioner.spring_rate - geometric;
        }
        for (span, map) in self.spans.iter().zip(&self.local) {
            add_local(&mut self.stiffness, &span.stiffness, map, 1.0);
            add_local(&mut self.mass, &span.mass, map, 1.0);
            add_local(&mut self.gyroscopic, &span.gyroscopic, map, 1.0);
        }
        for (i, stiffness) in self.span_stiffness.iter().enumerate() {
            add_outer(&mut self.stiffness, self.stretch.row(i), *stiffness);
        }
        for (j, pulley) in drive.pulleys.iter().enumerate() {
            if let (Some(part), Some(accessory), false) = (
                pulley.coupling.flexible(),
                self.coordinates.accessory(j),
                disengaged.contains(&j),
            ) {
                add_between(&mut self.stiffness, j, accessory, part.stiffness, 1.0);
            }
        }
    }

    /// Coordinates that move freely: all without the driver if its motion is prescribed, and without locked arms.
    pub fn free_coordinates(&self, drive: &Drive, driver_is_free: bool) -> Vec<usize> {
        self.coordinates
            .iter()
            .enumerate()
            .filter(|(index, coordinate)| match coordinate {
                Coordinate::Arm(arm) => !drive.tensioners[*arm].locked,
                _ => driver_is_free || *index != self.driver,
            })
            .map(|(index, _)| index)
            .collect()
    }
}

/// The matrices of a span. One without transverse motion of its own has stiffness but no mass (theory 04 §3.4).
fn span_matrices(drive: &Drive, steady: &SteadyState, i: usize, terms: usize) -> SpanMatrices {
    let mass_per_length = match drive.belt.model {
        BeltModel::Spring => 0.0,
        BeltModel::String | BeltModel::Beam => drive.belt.mass_per_length,
    };
    SpanMatrices::new(
        &steady.spans[i],
        steady.layout.spans[i].length,
        steady.effective_tensions[i],
        mass_per_length,
        steady.belt_speed,
        terms,
    )
}

fn local_map(drive: &Drive, steady: &SteadyState, coordinates: &Coordinates, i: usize) -> LocalMap {
    let rates = &steady.kinematics.spans[i];
    let end = |value: &dyn Fn(usize) -> f64| -> Vec<(usize, f64)> {
        (0..drive.tensioners.len())
            .map(|arm| (coordinates.arm(arm), value(arm)))
            .filter(|(_, factor)| *factor != 0.0)
            .collect()
    };
    let mut map = vec![
        end(&|arm| rates[arm].across_start),
        end(&|arm| rates[arm].across_end),
    ];
    map.extend(coordinates.sines(i).map(|index| vec![(index, 1.0)]));
    map
}

fn stretch_rows(drive: &Drive, steady: &SteadyState, coordinates: &Coordinates) -> Matrix {
    let mut rows = Matrix::zeros(drive.pulleys.len(), coordinates.len());
    for i in 0..drive.pulleys.len() {
        let next = drive.next(i);
        rows[(i, coordinates.pulley(next))] += drive.pulleys[next].radius;
        rows[(i, coordinates.pulley(i))] -= drive.pulleys[i].radius;
        for (arm, rates) in steady.kinematics.spans[i].iter().enumerate() {
            rows[(i, coordinates.arm(arm))] = rates.along();
        }
        for (n, index) in coordinates.sines(i).enumerate() {
            rows[(i, index)] = steady.spans[i].coupling(n + 1);
        }
    }
    rows
}

/// `k_i`, with the sine terms that are left out acting quasi-statically if asked for (theory 04 (3.11)).
fn span_stiffness(drive: &Drive, steady: &SteadyState, i: usize, terms: usize) -> f64 {
    let spring = belt_spring(drive, steady, i);
    if !drive.belt.static_correction {
        return spring;
    }
    let span = &steady.spans[i];
    let present: f64 = (1..=terms)
        .map(|n| span.coupling(n).powi(2) / span.term_stiffness(n))
        .sum();
    1.0 / (1.0 / spring + span.sag_compliance() - present)
}

/// Stiffness of the belt alone between the ends of a span, `EA/[L_i + ½β(r_iφ_i + r_{i+1}φ_{i+1})]`.
fn belt_spring(drive: &Drive, steady: &SteadyState, i: usize) -> f64 {
    let arc = |j: usize| drive.pulleys[j].radius * steady.layout.wraps[j];
    let arcs = 0.5 * drive.belt.arc_participation * (arc(i) + arc(drive.next(i)));
    drive.belt.axial_stiffness / (steady.layout.spans[i].length + arcs)
}

fn lumped_inertia(
    drive: &Drive,
    steady: &SteadyState,
    coordinates: &Coordinates,
    disengaged: &[usize],
) -> Vec<f64> {
    let arc_mass = |j: usize| {
        if drive.belt.wrapped_inertia {
            drive.belt.mass_per_length * drive.pulleys[j].radius * steady.layout.wraps[j]
        } else {
            0.0
        }
    };
    let inertia = |coordinate: Coordinate| match coordinate {
        Coordinate::Pulley(j) => {
            let pulley = &drive.pulleys[j];
            let behind = match pulley.coupling {
                _ if coordinates.accessory(j).is_some() || disengaged.contains(&j) => 0.0,
                Coupling::Rigid { accessory_inertia } | Coupling::OneWay { accessory_inertia } => {
                    accessory_inertia
                }
                Coupling::Isolator(_) | Coupling::WrapSpring(_) | Coupling::Decoupler { .. } => 0.0,
            };
            pulley.inertia + behind + arc_mass(j) * pulley.radius.powi(2)
        }
        Coordinate::Accessory(j) => drive.pulleys[j].coupling.accessory_inertia(),
        Coordinate::Arm(arm) => {
            let carried: f64 = drive
                .carried_by(arm)
                .map(|j| {
                    (drive.pulleys[j].mass + arc_mass(j))
                        * steady.kinematics.centre_rates[j][arm].length_squared()
                })
                .sum();
            drive.tensioners[arm].inertia + carried
        }
        Coordinate::Sine { .. } => 0.0,
    };
    coordinates.iter().map(inertia).collect()
}

/// Adds `factor · Rᵀ A R` of a span.
pub(super) fn add_local(target: &mut Matrix, local: &Matrix, map: &LocalMap, factor: f64) {
    for (a, rows) in map.iter().enumerate() {
        for (b, columns) in map.iter().enumerate() {
            let value = factor * local[(a, b)];
            if value == 0.0 {
                continue;
            }
            for (row, left) in rows {
                for (column, right) in columns {
                    target[(*row, *column)] += left * value * right;
                }
            }
        }
    }
}

/// Adds `factor · v vᵀ`.
pub(super) fn add_outer(target: &mut Matrix, vector: &[f64], factor: f64) {
    let entries: Vec<(usize, f64)> = vector
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, value)| *value != 0.0)
        .collect();
    for (row, left) in &entries {
        for (column, right) in &entries {
            target[(*row, *column)] += factor * left * right;
        }
    }
}

/// Adds `factor · [[1, −s], [−s, 1]]` on two coordinates, for `½ factor (x − s y)²` with `s = ±1`.
pub(super) fn add_between(target: &mut Matrix, x: usize, y: usize, factor: f64, sign: f64) {
    target[(x, x)] += factor;
    target[(y, y)] += factor;
    target[(x, y)] -= sign * factor;
    target[(y, x)] -= sign * factor;
}
