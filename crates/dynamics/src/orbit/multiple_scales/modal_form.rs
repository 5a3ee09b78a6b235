//! The engaged modal form of a system with one two-piece spring (theory 02 §1.6, (C13)).

use super::MultipleScalesError;
use slackside_linalg::{Complex, Lu, Matrix, dot};
use slackside_mechanics::{Element, Piece, System, modes};

/// One mode of the engaged system.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalMode {
    /// Natural frequency `ω_j`.
    pub frequency: f64,
    /// Damping ratio `ζ_j`.
    pub damping_ratio: f64,
    /// Shape of modal mass one, with the sign that makes the deflection positive.
    pub shape: Vec<f64>,
    /// Modal deflection `d_j ≥ 0` of the switching element.
    pub deflection: f64,
    /// Modal load `F_j`.
    pub load: f64,
}

/// The engaged modes of a system, its switching element and its load:
///
/// `z_j'' + 2ζ_jω_j z_j' + ω_j² z_j = F_j cos(Ωt − χ) + d_j N(d)`, with `d = Σ d_j z_j` the deflection about rest and
/// `N(d) = κ (δ_s + d)` where `δ_s + d < 0`, zero elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalForm {
    /// The modes, ascending in frequency.
    pub modes: Vec<ModalMode>,
    /// Index of the switching element.
    pub element: usize,
    /// Stiffness `κ` lost when the element leaves its linear piece: the clutch's `K_d`. Negative for a stop.
    pub lost_stiffness: f64,
    /// Distance `δ_s` of the state of rest from the switching point: `M/K_d` for the clutch. Positive.
    pub static_deflection: f64,
    /// The coordinates at rest.
    pub rest: Vec<f64>,
    /// Phase `χ` of the load.
    pub load_phase: f64,
}

/// Coupling of modes by the damping matrix, relative to the largest modal damping, that is taken for rounding.
const COUPLING: f64 = 1e-9;

/// The two pieces of a law: where they meet, the stiffness of the linear one and of the other, and whether the linear one
/// lies above (`1`) or below (`−1`).
struct TwoPieces {
    switching: f64,
    linear: f64,
    other: f64,
    side: f64,
}

impl ModalForm {
    /// The modal form of a system.
    ///
    /// # Errors
    /// [`MultipleScalesError`], naming what keeps the system from being of the form.
    pub fn new(system: &System) -> Result<Self, MultipleScalesError> {
        if system.is_frequency_dependent() {
            return Err(MultipleScalesError::FrequencyDependent);
        }
        let (index, element) = switching_element(system)?;
        let pieces = two_pieces(element).ok_or_else(|| MultipleScalesError::Law {
            element: element.name.clone(),
            kind: element.law.kind(),
        })?;
        let rest = rest(system)?;
        let static_deflection = pieces.side * (element.port.project(&rest) - pieces.switching);
        if static_deflection <= 0.0 || !static_deflection.is_finite() {
            return Err(MultipleScalesError::NoPreload {
                element: element.name.clone(),
                deflection: static_deflection,
            });
        }
        let (load, load_phase) = load(system)?;
        let found = modes(system, 1.0, true)?;
        if found.iter().any(|mode| mode.frequency <= 0.0) {
            return Err(MultipleScalesError::FreeMode);
        }
        check_damping(system, &found.iter().map(|mode| &mode.shape).collect::<Vec<_>>())?;
        let modes = found
            .into_iter()
            .map(|mode| {
                let mut shape = mode.shape;
                let mut deflection = pieces.side * element.port.project(&shape);
                if deflection < 0.0 {
                    shape.iter_mut().for_each(|value| *value = -*value);
                    deflection = -deflection;
                }
                ModalMode {
                    frequency: mode.frequency,
                    damping_ratio: mode.damping_ratio,
                    load: dot(&shape, &load),
                    deflection,
                    shape,
                }
            })
            .collect();
        Ok(Self {
            modes,
            element: index,
            lost_stiffness: pieces.linear - pieces.other,
            static_deflection,
            rest,
            load_phase,
        })
    }

    /// Complex amplitudes of the modal coordinates of the linear response, `z = Re Z e^{i(Ωt − χ)}`.
    pub fn linear_response(&self, frequency: f64) -> Vec<Complex> {
        let amplitude = |mode: &ModalMode| {
            let w = mode.frequency;
            let stiffness = Complex::new(
                w * w - frequency * frequency,
                2.0 * mode.damping_ratio * w * frequency,
            );
            mode.load / stiffness
        };
        self.modes.iter().map(amplitude).collect()
    }

    /// Amplitude `|D|` of the element's deflection in the linear response (C7). Where it does not exceed `δ_s` the element
    /// never switches and the linear response is exact.
    pub fn linear_deflection(&self, frequency: f64) -> f64 {
        let amplitudes = self.linear_response(frequency);
        let parts = amplitudes.iter().zip(&self.modes);
        parts.map(|(z, mode)| z * mode.deflection).sum::<Complex>().norm()
    }

    /// Multipliers of the linear response over the period `2π/Ω`.
    pub fn linear_multipliers(&self, frequency: f64) -> Vec<Complex> {
        let period = std::f64::consts::TAU / frequency;
        let mut multipliers: Vec<Complex> = Vec::new();
        for mode in &self.modes {
            let (w, z) = (mode.frequency, mode.damping_ratio);
            let root = Complex::new(z * z - 1.0, 0.0).sqrt() * w;
            for sign in [1.0, -1.0] {
                multipliers.push(((root * sign - z * w) * period).exp());
            }
        }
        crate::orbit::floquet::sort(&mut multipliers);
        multipliers
    }
}

/// The only element that is not linear.
fn switching_element(system: &System) -> Result<(usize, &Element), MultipleScalesError> {
    let nonlinear: Vec<(usize, &Element)> = system
        .elements
        .iter()
        .enumerate()
        .filter(|(_, element)| element.law.regimes().is_none_or(|table| table.regimes.len() > 1))
        .collect();
    match nonlinear[..] {
        [found] => Ok(found),
        _ => Err(MultipleScalesError::Elements {
            elements: nonlinear
                .iter()
                .map(|(_, element)| element.name.clone())
                .collect(),
        }),
    }
}

/// The law as two pieces; `None` if it is something else.
fn two_pieces(element: &Element) -> Option<TwoPieces> {
    let table = element.law.regimes()?;
    let [first, second] = table.regimes.as_slice() else {
        return None;
    };
    let stiffness = |piece: &Piece| match *piece {
        Piece::Affine {
            displacement,
            velocity: 0.0,
            ..
        } => Some(displacement),
        _ => None,
    };
    let slopes = [stiffness(&first.piece)?, stiffness(&second.piece)?];
    let [guard] = first.guards.as_slice() else {
        return None;
    };
    if guard.velocity != 0.0 || guard.displacement == 0.0 {
        return None;
    }
    let (linear, damper) = element.law.linearized();
    if damper != 0.0 {
        return None;
    }
    let rests_in_first = slopes[0] == linear;
    let other = if rests_in_first { slopes[1] } else { slopes[0] };
    if !rests_in_first && slopes[1] != linear {
        return None;
    }
    // Inside the first regime its guard is positive: it lies above if the factor of the displacement is.
    let first_side = guard.displacement.signum();
    Some(TwoPieces {
        switching: -guard.constant / guard.displacement,
        linear,
        other,
        side: if rests_in_first { first_side } else { -first_side },
    })
}

/// The coordinates at rest with every element on its linear piece, whose force is zero at the origin.
fn rest(system: &System) -> Result<Vec<f64>, MultipleScalesError> {
    let mut stiffness = system.stiffness.clone();
    for element in &system.elements {
        let (spring, _) = element.law.linearized();
        for &(i, a) in element.port.terms() {
            for &(j, b) in element.port.terms() {
                stiffness[(i, j)] += a * b * spring;
            }
        }
    }
    let lu = Lu::new(&stiffness).map_err(|_| MultipleScalesError::FreeMode)?;
    Ok(lu.solve(&system.forcing.constant))
}

/// Amplitudes and common phase of the load `F cos(Ωt − χ)`.
fn load(system: &System) -> Result<(Vec<f64>, f64), MultipleScalesError> {
    let [harmonic] = system.forcing.harmonics.as_slice() else {
        return Err(MultipleScalesError::Load);
    };
    if harmonic.order != 1 {
        return Err(MultipleScalesError::Load);
    }
    let parts: Vec<Complex> = harmonic
        .cosine
        .iter()
        .zip(&harmonic.sine)
        .map(|(cosine, sine)| Complex::new(*cosine, *sine))
        .collect();
    let largest = parts.iter().copied().fold(
        Complex::new(0.0, 0.0),
        |a, b| if b.norm() > a.norm() { b } else { a },
    );
    // A load without a sine part keeps its signs: χ = 0.
    let phase = if largest.im == 0.0 { 0.0 } else { largest.arg() };
    let turned: Vec<Complex> = parts
        .iter()
        .map(|part| part * Complex::from_polar(1.0, -phase))
        .collect();
    if turned.iter().any(|part| part.im.abs() > 1e-12 * largest.norm()) {
        return Err(MultipleScalesError::Load);
    }
    Ok((turned.iter().map(|part| part.re).collect(), phase))
}

/// Whether damping is modal: `Φᵀ C Φ` diagonal.
fn check_damping(system: &System, shapes: &[&Vec<f64>]) -> Result<(), MultipleScalesError> {
    let mut damping: Matrix = system.damping.clone();
    for element in &system.elements {
        let (_, damper) = element.law.linearized();
        for &(i, a) in element.port.terms() {
            for &(j, b) in element.port.terms() {
                damping[(i, j)] += a * b * damper;
            }
        }
    }
    let (mut largest, mut coupling) = (0.0_f64, 0.0_f64);
    for (i, shape) in shapes.iter().enumerate() {
        let image = damping.times(shape);
        for (j, other) in shapes.iter().enumerate() {
            let value = dot(other, &image).abs();
            if i == j {
                largest = largest.max(value);
            } else {
                coupling = coupling.max(value);
            }
        }
    }
    if coupling > COUPLING * largest {
        return Err(MultipleScalesError::CoupledDamping {
            share: if largest > 0.0 {
                coupling / largest
            } else {
                f64::INFINITY
            },
        });
    }
    Ok(())
}
