//! The system: matrices, load, elements and measures.

use crate::{Element, Forcing, Output};
use slackside_linalg::{Complex, ComplexMatrix, Matrix, is_positive_definite};

/// A mechanical system with local nonlinear elements (theory 05 (1.1)):
///
/// `M q'' + (C + Ω C₁) q' + (K + Ω² K₂) q + Σ_j b_j f_j = F₀ + Σ_k (Fc_k cos kΩt + Fs_k sin kΩt)`,
///
/// where `Ω` is the fundamental frequency of the load, given separately since it is what studies vary most.
/// Units are whatever consistent set the model uses (SI, or dimensionless).
#[derive(Debug, Clone)]
pub struct System {
    /// Coordinate names; their number `n` is the order of all matrices.
    pub coordinates: Vec<String>,
    /// Mass matrix `M`, symmetric positive definite.
    pub mass: Matrix,
    /// Velocity matrix: damping plus gyroscopic part, `C + G`.
    pub damping: Matrix,
    /// Stiffness matrix `K`; may be singular (a free accessory).
    pub stiffness: Matrix,
    /// Velocity matrix per unit of `Ω`, when belt speed follows the engine speed.
    pub damping_linear_in_frequency: Option<Matrix>,
    /// Stiffness matrix per unit of `Ω²`.
    pub stiffness_quadratic_in_frequency: Option<Matrix>,
    /// The load.
    pub forcing: Forcing,
    /// The nonlinear elements.
    pub elements: Vec<Element>,
    /// The measures that results report.
    pub outputs: Vec<Output>,
}

/// Why a system is not sound.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SystemError {
    /// A matrix or vector has the wrong size.
    #[error("{what} must have {expected} rows and columns to match the coordinates, but has {found}")]
    Size {
        /// What has the wrong size.
        what: String,
        /// Number of coordinates.
        expected: usize,
        /// Size found.
        found: usize,
    },
    /// An entry is NaN or infinite.
    #[error("{what} has an entry that is not a finite number")]
    NotFinite {
        /// What has the entry.
        what: String,
    },
    /// The mass matrix does not define a kinetic energy.
    #[error("the mass matrix must be symmetric and positive definite")]
    Mass,
    /// A port or measure names a coordinate or an element that does not exist.
    #[error("{what} refers to index {index}, but there are only {count}")]
    Index {
        /// Who refers.
        what: String,
        /// Index used.
        index: usize,
        /// Number that exist.
        count: usize,
    },
    /// An element acts nowhere.
    #[error("element \"{element}\" has an empty port: it acts on no coordinate")]
    EmptyPort {
        /// Its name.
        element: String,
    },
}

impl System {
    /// Number of coordinates `n`.
    pub fn order(&self) -> usize {
        self.coordinates.len()
    }

    /// The velocity matrix `C + Ω C₁` at frequency `Ω`.
    pub fn damping_at(&self, frequency: f64) -> Matrix {
        let mut result = self.damping.clone();
        if let Some(linear) = &self.damping_linear_in_frequency {
            result.add_scaled(frequency, linear);
        }
        result
    }

    /// The stiffness matrix `K + Ω² K₂` at frequency `Ω`.
    pub fn stiffness_at(&self, frequency: f64) -> Matrix {
        let mut result = self.stiffness.clone();
        if let Some(quadratic) = &self.stiffness_quadratic_in_frequency {
            result.add_scaled(frequency * frequency, quadratic);
        }
        result
    }

    /// Whether the matrices themselves depend on the frequency of the load.
    pub fn is_frequency_dependent(&self) -> bool {
        self.damping_linear_in_frequency.is_some() || self.stiffness_quadratic_in_frequency.is_some()
    }

    /// The dynamic stiffness `D(ω) = −ω² M + iω (C + Ω C₁) + K + Ω² K₂` of the linear part at circular frequency `ω`, while
    /// the load has frequency `Ω`.
    pub fn dynamic_stiffness(&self, omega: f64, frequency: f64) -> ComplexMatrix {
        ComplexMatrix::combination(&[
            (Complex::new(-omega * omega, 0.0), &self.mass),
            (Complex::new(0.0, omega), &self.damping_at(frequency)),
            (Complex::new(1.0, 0.0), &self.stiffness_at(frequency)),
        ])
    }

    /// Whether every element's law has regimes, so that the motion is linear between events and the exact flow applies.
    pub fn is_piecewise_linear(&self) -> bool {
        self.elements
            .iter()
            .all(|element| element.law.regimes().is_some())
    }

    /// Number of the elements' internal states.
    pub fn internal_states(&self) -> usize {
        let elements = self.elements.iter();
        elements
            .filter(|element| element.law.has_internal_state())
            .count()
    }

    /// Coordinates on which no force depends, at any frequency: turning such a coordinate (the accessory behind a one-way
    /// clutch) by a constant angle changes nothing, and a motion that repeats may leave it turned (theory 05 §3.1).
    pub fn cyclic_coordinates(&self) -> Vec<usize> {
        let quadratic = self.stiffness_quadratic_in_frequency.as_ref();
        let free = |i: usize| {
            let in_column = |matrix: &Matrix| matrix.column(i).iter().any(|value| *value != 0.0);
            !in_column(&self.stiffness) && !quadratic.is_some_and(in_column)
        };
        let held = |i: usize| {
            self.elements.iter().any(|element| {
                element.port.terms().iter().any(|&(at, _)| at == i) && element.law.depends_on_displacement()
            })
        };
        (0..self.order()).filter(|&i| free(i) && !held(i)).collect()
    }

    /// Index of the measure with this name.
    pub fn output_index(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|output| output.name == name)
    }

    /// Checks sizes, finiteness, the mass matrix and all references.
    ///
    /// # Errors
    /// The first fault found, as a [`SystemError`].
    pub fn check(&self) -> Result<(), SystemError> {
        let n = self.order();
        let matrices = [
            ("the mass matrix", Some(&self.mass)),
            ("the damping matrix", Some(&self.damping)),
            ("the stiffness matrix", Some(&self.stiffness)),
            (
                "the damping matrix linear in frequency",
                self.damping_linear_in_frequency.as_ref(),
            ),
            (
                "the stiffness matrix quadratic in frequency",
                self.stiffness_quadratic_in_frequency.as_ref(),
            ),
        ];
        for (what, matrix) in matrices {
            let Some(matrix) = matrix else { continue };
            for found in [matrix.rows(), matrix.columns()] {
                if found != n {
                    return Err(SystemError::Size {
                        what: what.into(),
                        expected: n,
                        found,
                    });
                }
            }
            if !matrix.is_finite() {
                return Err(SystemError::NotFinite { what: what.into() });
            }
        }
        if !is_positive_definite(&self.mass) {
            return Err(SystemError::Mass);
        }
        let mut loads = vec![("the constant load".to_string(), &self.forcing.constant)];
        for harmonic in &self.forcing.harmonics {
            loads.push((
                format!("the cosine load of order {}", harmonic.order),
                &harmonic.cosine,
            ));
            loads.push((
                format!("the sine load of order {}", harmonic.order),
                &harmonic.sine,
            ));
        }
        for (what, load) in loads {
            if load.len() != n {
                return Err(SystemError::Size {
                    what,
                    expected: n,
                    found: load.len(),
                });
            }
            if load.iter().any(|value| !value.is_finite()) {
                return Err(SystemError::NotFinite { what });
            }
        }
        let index = |what: String, indices: &[(usize, f64)], count: usize| match indices
            .iter()
            .find(|&&(i, _)| i >= count)
        {
            Some(&(index, _)) => Err(SystemError::Index { what, index, count }),
            None => Ok(()),
        };
        for element in &self.elements {
            if element.port.terms().is_empty() {
                return Err(SystemError::EmptyPort {
                    element: element.name.clone(),
                });
            }
            index(
                format!("the port of \"{}\"", element.name),
                element.port.terms(),
                n,
            )?;
        }
        for output in &self.outputs {
            let what = format!("output \"{}\"", output.name);
            index(what.clone(), &output.displacement, n)?;
            index(what.clone(), &output.velocity, n)?;
            index(what, &output.force, self.elements.len())?;
        }
        Ok(())
    }
}
