//! Whether the periodic response is certainly unique (theory 05 §2.1).

use super::linear_system::nonlinear_elements;
use super::{LinearSystem, Mobility, ReceptanceError};
use slackside_linalg::{Matrix, is_positive_definite, symmetric_eigenvalues};
use slackside_mechanics::OperatingPoint;

/// What is known of the uniqueness of the periodic response to the load.
#[derive(Debug, Clone, PartialEq)]
pub enum Uniqueness {
    /// No element is nonlinear and the system is asymptotically stable.
    Linear,
    /// The energy of the difference of two motions falls: `M`, `K` (without cyclic coordinates) and the symmetric part of `C`
    /// are positive definite, `K` is symmetric, and all laws are monotone. The velocity response is unique and attracts all
    /// motions.
    Energy,
    /// The linear system is asymptotically stable, the real part of the mobility of the ports is positive definite at all
    /// frequencies, and all laws are monotone. The velocity response is unique and attracts all motions.
    PositiveReal,
    /// As [`Uniqueness::Energy`], but the damping is only positive semi-definite: the energy of the difference of two motions
    /// never grows, so that sweeps up and down see no jumps; that all motions tend to one response is not proved.
    EnergyWithoutFullDamping,
    /// Uniqueness is not known; several starts and both sweep directions are needed.
    NotGuaranteed(
        /// The conditions that fail.
        Vec<Doubt>,
    ),
}

/// A condition of the certificate that does not hold.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt {
    /// A law is no monotone graph of the velocity.
    Law {
        /// The element.
        element: String,
        /// The kind of its law.
        kind: &'static str,
    },
    /// The stiffness is not symmetric or not positive definite.
    Stiffness,
    /// The symmetric part of the damping has a negative eigenvalue.
    Damping {
        /// That eigenvalue.
        eigenvalue: f64,
    },
    /// The system without the elements is not asymptotically stable.
    Unstable {
        /// Largest real part of its poles.
        growth: f64,
    },
    /// The real part of the mobility is negative somewhere.
    Mobility {
        /// Circular frequency at which it is.
        omega: f64,
    },
    /// The sign of the mobility's real part could not be decided.
    MobilityUndecided,
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Law { element, kind } => {
                write!(
                    f,
                    "the law of \"{element}\" ({kind}) is not monotone in the velocity"
                )
            }
            Self::Stiffness => f.write_str("the stiffness matrix is not symmetric positive definite"),
            Self::Damping { eigenvalue } => {
                write!(
                    f,
                    "the damping matrix has the negative eigenvalue {eigenvalue:.3e}"
                )
            }
            Self::Unstable { growth } => {
                write!(
                    f,
                    "the system without its elements has a pole with real part {growth:.3e}"
                )
            }
            Self::Mobility { omega } => {
                write!(
                    f,
                    "the real part of the port mobility is negative at {omega:.6} rad/s"
                )
            }
            Self::MobilityUndecided => {
                f.write_str("the sign of the real part of the port mobility could not be decided")
            }
        }
    }
}

impl std::fmt::Display for Uniqueness {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Linear => f.write_str("unique: the system is linear and stable"),
            Self::Energy => f.write_str("unique: the energy of the difference of two motions falls"),
            Self::PositiveReal => f.write_str("unique: the port mobility is positive real"),
            Self::EnergyWithoutFullDamping => f.write_str(
                "no jumps: the energy of the difference of two motions never grows (damping does not reach every coordinate, so that attraction to one response is not proved)",
            ),
            Self::NotGuaranteed(doubts) => {
                f.write_str("uniqueness not guaranteed")?;
                for (i, doubt) in doubts.iter().enumerate() {
                    write!(f, "{}{doubt}", if i == 0 { ": " } else { "; " })?;
                }
                Ok(())
            }
        }
    }
}

impl Uniqueness {
    /// Whether the response is certainly unique.
    pub fn is_unique(&self) -> bool {
        matches!(self, Self::Linear | Self::Energy | Self::PositiveReal)
    }

    /// Whether jumps, hysteresis and subharmonic responses are certainly absent.
    pub fn excludes_jumps(&self) -> bool {
        !matches!(self, Self::NotGuaranteed(_))
    }
}

/// The certificate of uniqueness of the response at an operating point. Nothing is claimed that the matrices and laws do not
/// prove (to rounding).
///
/// # Errors
/// [`ReceptanceError::Linalg`] if an eigenvalue iteration fails.
pub fn uniqueness(point: &OperatingPoint) -> Result<Uniqueness, ReceptanceError> {
    let (system, frequency) = (&point.system, point.frequency);
    let nonlinear = nonlinear_elements(system);
    let linear = LinearSystem::new(system, &nonlinear)?;
    if nonlinear.is_empty() {
        let growth = growth(&linear, frequency)?;
        return Ok(if growth < 0.0 {
            Uniqueness::Linear
        } else {
            Uniqueness::NotGuaranteed(vec![Doubt::Unstable { growth }])
        });
    }
    let laws = nonlinear.iter().map(|&e| &system.elements[e]);
    let mut doubts: Vec<Doubt> = laws
        .filter(|element| !element.law.is_monotone())
        .map(|element| Doubt::Law {
            element: element.name.clone(),
            kind: element.law.kind(),
        })
        .collect();
    if !doubts.is_empty() {
        return Ok(Uniqueness::NotGuaranteed(doubts));
    }
    let held = linear.held_coordinates(frequency);
    let stiffness = linear.stiffness_at(frequency).selected(&held);
    let stiff = is_symmetric(&stiffness) && is_positive_definite(&stiffness);
    let damping = symmetric_part(&linear.damping_at(frequency));
    let scale = damping.max_abs();
    let smallest = symmetric_eigenvalues(&damping)?.first().copied().unwrap_or(0.0);
    if stiff && smallest > 1e-14 * scale {
        return Ok(Uniqueness::Energy);
    }
    if stiff && smallest >= -1e-13 * scale {
        return Ok(match positive_real(&linear, frequency)? {
            None => Uniqueness::PositiveReal,
            Some(_) => Uniqueness::EnergyWithoutFullDamping,
        });
    }
    if !stiff {
        doubts.push(Doubt::Stiffness);
    }
    if smallest < -1e-13 * scale {
        doubts.push(Doubt::Damping { eigenvalue: smallest });
    }
    Ok(match positive_real(&linear, frequency)? {
        None => Uniqueness::PositiveReal,
        Some(doubt) => {
            doubts.push(doubt);
            Uniqueness::NotGuaranteed(doubts)
        }
    })
}

/// What stands against the certificate by mobility, if anything.
fn positive_real(linear: &LinearSystem, frequency: f64) -> Result<Option<Doubt>, ReceptanceError> {
    let growth = growth(linear, frequency)?;
    if growth >= 0.0 {
        return Ok(Some(Doubt::Unstable { growth }));
    }
    let mobility = match Mobility::new(linear, frequency) {
        Ok(mobility) => mobility,
        Err(ReceptanceError::Defective { .. }) => return Ok(Some(Doubt::MobilityUndecided)),
        Err(error) => return Err(error),
    };
    Ok(match mobility.is_positive_real()? {
        (Some(true), _) => None,
        (Some(false), omega) => Some(Doubt::Mobility { omega }),
        (None, _) => Some(Doubt::MobilityUndecided),
    })
}

/// Largest real part of the poles; values within rounding of zero count as zero.
fn growth(linear: &LinearSystem, frequency: f64) -> Result<f64, ReceptanceError> {
    let poles = linear.poles(frequency)?;
    let size = poles.iter().fold(0.0_f64, |a, p| a.max(p.norm()));
    let largest = poles.iter().fold(f64::NEG_INFINITY, |a, p| a.max(p.re));
    Ok(if largest.abs() < 1e-12 * size {
        0.0
    } else {
        largest
    })
}

fn symmetric_part(matrix: &Matrix) -> Matrix {
    let mut result = matrix.scaled(0.5);
    result.add_scaled(0.5, &matrix.transpose());
    result
}

/// Symmetric to rounding.
fn is_symmetric(matrix: &Matrix) -> bool {
    let tolerance = 1e-13 * matrix.max_abs();
    let n = matrix.rows();
    (0..n).all(|i| (0..i).all(|j| (matrix[(i, j)] - matrix[(j, i)]).abs() <= tolerance))
}
