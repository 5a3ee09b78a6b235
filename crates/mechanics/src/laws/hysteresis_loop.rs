//! A measured torque–angle loop of a tensioner (theory 05 §6.1).

use super::piecewise_linear::PiecewiseLinearError;
use crate::law::{Guard, Law, Piece, Regime, RegimeTable, Response, Rest, Transition};

/// A loop measured over the full stroke: the force while the displacement rises (`loading`, the upper curve) and while it
/// falls (`unloading`, the lower curve), at the same displacements. Between the points both are linear, beyond them constant.
/// At rest the force is anything between the two, which is dry friction whose limits depend on the displacement.
#[derive(Debug, Clone, PartialEq)]
pub struct HysteresisLoop {
    displacements: Vec<f64>,
    loading: Vec<f64>,
    unloading: Vec<f64>,
}

/// Why a measured loop is not sound.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HysteresisLoopError {
    /// The lists do not fit.
    #[error(
        "displacements, loading and unloading need the same number of points, at least two, but have {0:?}"
    )]
    Count([usize; 3]),
    /// A displacement does not rise, or a value is not finite.
    #[error(transparent)]
    Order(#[from] PiecewiseLinearError),
    /// The curves cross.
    #[error(
        "at displacement {displacement} the loading force {loading} is below the unloading force {unloading}"
    )]
    Crossed {
        /// Where.
        displacement: f64,
        /// Force of the upper curve.
        loading: f64,
        /// Force of the lower curve.
        unloading: f64,
    },
}

impl HysteresisLoop {
    /// A loop from its points.
    ///
    /// # Errors
    /// [`HysteresisLoopError`] if the points describe no loop.
    pub fn new(
        displacements: Vec<f64>,
        loading: Vec<f64>,
        unloading: Vec<f64>,
    ) -> Result<Self, HysteresisLoopError> {
        let counts = [displacements.len(), loading.len(), unloading.len()];
        if counts[0] < 2 || counts.iter().any(|&count| count != counts[0]) {
            return Err(HysteresisLoopError::Count(counts));
        }
        let all = displacements.iter().chain(&loading).chain(&unloading);
        if let Some(bad) = all.into_iter().find(|value| !value.is_finite()) {
            return Err(PiecewiseLinearError::Order(*bad).into());
        }
        if let Some(pair) = displacements.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(PiecewiseLinearError::Order(pair[1]).into());
        }
        if let Some(i) = (0..counts[0]).find(|&i| loading[i] < unloading[i]) {
            return Err(HysteresisLoopError::Crossed {
                displacement: displacements[i],
                loading: loading[i],
                unloading: unloading[i],
            });
        }
        Ok(Self {
            displacements,
            loading,
            unloading,
        })
    }

    /// Number of straight segments, the two constant ones beyond the ends included.
    fn segments(&self) -> usize {
        self.displacements.len() + 1
    }

    /// Constant and slope of a curve on a segment.
    fn line(&self, curve: &[f64], segment: usize) -> (f64, f64) {
        let last = self.displacements.len() - 1;
        if segment == 0 {
            return (curve[0], 0.0);
        }
        if segment > last {
            return (curve[last], 0.0);
        }
        let (a, b) = (self.displacements[segment - 1], self.displacements[segment]);
        let slope = (curve[segment] - curve[segment - 1]) / (b - a);
        (curve[segment - 1] - slope * a, slope)
    }

    fn segment_of(&self, displacement: f64) -> usize {
        self.displacements.iter().filter(|&&x| displacement > x).count()
    }
}

/// Index of a regime: three per segment.
fn index(segment: usize, kind: usize) -> usize {
    3 * segment + kind
}

impl Law for HysteresisLoop {
    fn kind(&self) -> &'static str {
        "hysteresis-loop"
    }

    fn response(&self, displacement: f64, velocity: f64) -> Response {
        let segment = self.segment_of(displacement);
        let (upper, lower) = (
            self.line(&self.loading, segment),
            self.line(&self.unloading, segment),
        );
        let weight = if velocity == 0.0 {
            0.5
        } else if velocity > 0.0 {
            1.0
        } else {
            0.0
        };
        let mix = |a: f64, b: f64| weight * a + (1.0 - weight) * b;
        let slope = mix(upper.1, lower.1);
        Response {
            force: mix(upper.0, lower.0) + slope * displacement,
            by_displacement: slope,
            by_velocity: 0.0,
        }
    }

    fn regimes(&self) -> Option<RegimeTable> {
        let count = self.segments();
        let mut table = RegimeTable::default();
        for segment in 0..count {
            let rest = Transition::Rest(segment);
            let sliding = |kind: usize, curve: &[f64]| {
                let (constant, displacement) = self.line(curve, segment);
                let sign = if kind == 2 { 1.0 } else { -1.0 };
                let mut guards = vec![Guard::on_velocity(sign, 0.0, rest)];
                if kind == 2 && segment + 1 < count {
                    let to = Transition::To(index(segment + 1, kind));
                    guards.push(Guard::on_displacement(-1.0, self.displacements[segment], to));
                }
                if kind == 0 && segment > 0 {
                    let to = Transition::To(index(segment - 1, kind));
                    guards.push(Guard::on_displacement(1.0, -self.displacements[segment - 1], to));
                }
                let piece = Piece::Affine {
                    constant,
                    displacement,
                    velocity: 0.0,
                    internal: 0.0,
                };
                let name = if kind == 2 { "slip+" } else { "slip-" };
                Regime::new(name, false, piece, guards)
            };
            let (low, high) = (
                self.line(&self.unloading, segment),
                self.line(&self.loading, segment),
            );
            // The displacement does not move while the port sticks: its limits are constants then.
            let stick = Regime::new(
                "stick",
                true,
                Piece::Stick { position: None },
                vec![
                    Guard {
                        displacement: -low.1,
                        ..Guard::on_force(1.0, -low.0, rest)
                    },
                    Guard {
                        displacement: high.1,
                        ..Guard::on_force(-1.0, high.0, rest)
                    },
                ],
            );
            table.regimes.push(sliding(0, &self.unloading));
            table.regimes.push(stick);
            table.regimes.push(sliding(2, &self.loading));
            table.rests.push(Rest {
                backward: Some(index(segment, 0)),
                stick: Some(index(segment, 1)),
                forward: Some(index(segment, 2)),
            });
        }
        Some(table)
    }

    fn is_monotone(&self) -> bool {
        false
    }

    fn linearized(&self) -> (f64, f64) {
        let segment = self.segment_of(0.0);
        let (upper, lower) = (
            self.line(&self.loading, segment),
            self.line(&self.unloading, segment),
        );
        (0.5 * (upper.1 + lower.1), 0.0)
    }
}
