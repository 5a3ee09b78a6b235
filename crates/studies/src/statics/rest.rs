//! Rest under the constant load.

use crate::StudyError;
use slackside_linalg::{Lu, Matrix};
use slackside_mechanics::{Element, Piece, System};

/// Newton iterations on a piecewise-linear residual, which end once the regimes are right.
const MOST_ITERATIONS: usize = 100;

/// Coordinates at rest under the constant load: `K q + Σ b f(bᵀq, 0) = F₀`. Damped Newton iterations from the rest of
/// the system with all elements linear, which for a preloaded clutch is the answer already.
///
/// A one-way clutch that the load presses holds its port at zero. Where nothing else carries the load, springs with a wind-up
/// hold theirs, and at last dry friction does.
///
/// # Errors
/// [`StudyError::NoAnswer`] if there is no such state (a mean load that nothing carries).
pub fn static_equilibrium(system: &System, frequency: f64) -> Result<Vec<f64>, StudyError> {
    Ok(rest(system, frequency)?.coordinates)
}

/// The state `(q, q', ζ)` at rest under the constant load; wind-ups carry what [`static_equilibrium`] makes them carry.
///
/// # Errors
/// As [`static_equilibrium`].
pub fn rest_state(system: &System, frequency: f64) -> Result<Vec<f64>, StudyError> {
    let n = system.order();
    let rest = rest(system, frequency)?;
    let mut state = rest.coordinates;
    state.resize(2 * n, 0.0);
    for (element, force) in system.elements.iter().zip(&rest.forces) {
        if element.law.has_internal_state() {
            let spring = wound(element).filter(|_| *force != 0.0);
            state.push(spring.map_or(0.0, |(constant, slope)| {
                // Below its preload a spring is not wound up.
                ((force - constant) / slope).max(if constant > 0.0 { 0.0 } else { f64::NEG_INFINITY })
            }));
        }
    }
    Ok(state)
}

/// A system at rest.
struct Rest {
    coordinates: Vec<f64>,
    /// Force of each element that is held; zero of the others.
    forces: Vec<f64>,
}

/// Force of an element's spring: at zero wind-up, and per wind-up.
fn wound(element: &Element) -> Option<(f64, f64)> {
    let pieces = element
        .law
        .regimes()?
        .regimes
        .into_iter()
        .map(|regime| regime.piece);
    pieces
        .filter_map(|piece| match piece {
            Piece::Affine {
                constant, internal, ..
            } if internal != 0.0 => Some((constant, internal)),
            _ => None,
        })
        .next()
}

/// Where an element can hold its port at rest and with which forces; `None` if it cannot.
fn holding(element: &Element) -> Option<Held> {
    let table = element.law.regimes()?;
    let at = |position: f64, low: f64, high: f64| Held {
        position,
        limits: (low, high),
    };
    let stick = table.regimes.iter().find(|regime| regime.sticks());
    if element.law.has_internal_state() {
        // What a spring with a wind-up carries is bounded below by the clutch in series with it, if there is one.
        let one_sided = table
            .regimes
            .iter()
            .any(|regime| !regime.transmitting && regime.piece == Piece::constant(0.0));
        let limit = table.regimes.iter().find_map(|regime| match regime.piece {
            Piece::Affine {
                constant, internal, ..
            } if internal == 0.0 && constant > 0.0 => Some(constant),
            _ => None,
        });
        let high = limit.unwrap_or(f64::INFINITY);
        wound(element)?;
        return Some(at(0.0, if one_sided { 0.0 } else { -high }, high));
    }
    let stick = stick?;
    let Piece::Stick { position } = stick.piece else {
        return None;
    };
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for guard in stick.guards.iter().filter(|guard| guard.force != 0.0) {
        let limit = -guard.constant / guard.force;
        if guard.force > 0.0 {
            low = limit
        } else {
            high = limit
        }
    }
    Some(at(position.unwrap_or(0.0), low, high))
}

/// A port held at rest.
#[derive(Debug, Clone, Copy)]
struct Held {
    position: f64,
    limits: (f64, f64),
}

fn rest(system: &System, frequency: f64) -> Result<Rest, StudyError> {
    let elements = &system.elements;
    let of = |wanted: &dyn Fn(&Element) -> bool| -> Vec<Option<Held>> {
        let held = elements.iter();
        held.map(|element| wanted(element).then(|| holding(element)).flatten())
            .collect()
    };
    let is_stop = |element: &Element| {
        let regimes = element.law.regimes().map_or_else(Vec::new, |table| table.regimes);
        regimes
            .iter()
            .any(|regime| matches!(regime.piece, Piece::Stick { position: Some(_) }))
    };
    let stages = [
        of(&|element| element.law.locks()),
        of(&|element| element.law.locks() || element.law.has_internal_state()),
        of(&|element| !is_stop(element)),
    ];
    for mut held in stages {
        // Ports that pull at what holds them are let go, ports that have passed a stop are put on it.
        for _ in 0..=2 * elements.len() {
            let Some((coordinates, forces)) = balance(system, frequency, &held) else {
                break;
            };
            let mut sound = true;
            for (e, element) in elements.iter().enumerate() {
                match held[e] {
                    Some(hold) => {
                        let slack = 1e-12 * forces.iter().fold(0.0_f64, |a, f| a.max(f.abs()));
                        if forces[e] < hold.limits.0 - slack || forces[e] > hold.limits.1 + slack {
                            held[e] = None;
                            sound = false;
                        }
                    }
                    None if is_stop(element) => {
                        let hold = holding(element);
                        if hold.is_some_and(|hold| element.port.project(&coordinates) > hold.position) {
                            held[e] = hold;
                            sound = false;
                        }
                    }
                    None => {}
                }
            }
            if sound {
                return Ok(Rest { coordinates, forces });
            }
        }
    }
    Err(StudyError::NoAnswer(
        "no static equilibrium was found: some part of the constant load is carried by nothing".to_owned(),
    ))
}

/// Whether neither stiffness nor an element acts on a coordinate.
fn is_free(system: &System, stiffness: &Matrix, coordinate: usize) -> bool {
    let acts = |element: &Element| element.port.terms().iter().any(|(index, _)| *index == coordinate);
    (0..stiffness.rows()).all(|k| stiffness[(coordinate, k)] == 0.0 && stiffness[(k, coordinate)] == 0.0)
        && !system.elements.iter().any(acts)
}

/// Coordinates and forces of held elements with which the constant load is balanced; `None` if none are found.
fn balance(system: &System, frequency: f64, held: &[Option<Held>]) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = system.order();
    let mut stiffness = system.stiffness_at(frequency);
    let load = &system.forcing.constant;
    // What nothing holds and nothing loads, as the rotation of a whole drive, rests where it is.
    for i in 0..n {
        if load[i] == 0.0 && is_free(system, &stiffness, i) {
            stiffness[(i, i)] = 1.0;
        }
    }
    let balance = Balance {
        system,
        stiffness: &stiffness,
        held: held
            .iter()
            .enumerate()
            .filter_map(|(element, hold)| Some((element, (*hold)?.position)))
            .collect(),
    };
    let engaged = balance.matrix(|element, _| element.law.linearized().0, &[]);
    let scale = load.iter().fold(0.0_f64, |a, f| a.max(f.abs()));
    let mut x = match Lu::new(&engaged) {
        Ok(lu) => lu.solve(&balance.right_side()),
        Err(_) => vec![0.0; engaged.rows()],
    };
    if x.iter().any(|value| !value.is_finite()) {
        x.fill(0.0);
    }
    let mut residual = balance.residual(&x);
    let mut stride = 1.0;
    for _ in 0..MOST_ITERATIONS {
        let size = slackside_linalg::norm(&residual);
        let forces = stiffness
            .times(&x[..n])
            .iter()
            .fold(scale, |a, force| a.max(force.abs()));
        if size <= 1e-12 * forces || size == 0.0 {
            let mut forces = vec![0.0; system.elements.len()];
            for ((element, _), force) in balance.held.iter().zip(&x[n..]) {
                forces[*element] = *force;
            }
            x.truncate(n);
            return Some((x, forces));
        }
        let tangent = balance.matrix(
            |element, q| element.law.response(element.port.project(q), 0.0).by_displacement,
            &x[..n],
        );
        let Ok(lu) = Lu::new(&tangent) else {
            // In a gap nothing carries the load: the tangent of engaged elements tells the way out, in growing strides.
            let step = Lu::new(&engaged).ok()?.solve(&residual);
            x.iter_mut().zip(&step).for_each(|(x, s)| *x -= stride * s);
            stride *= 2.0;
            residual = balance.residual(&x);
            if x.iter().all(|value| value.abs() < 1e100) {
                continue;
            }
            return None;
        };
        let step = lu.solve(&residual);
        let mut share = 1.0;
        loop {
            let trial: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x - share * s).collect();
            let found = balance.residual(&trial);
            if slackside_linalg::norm(&found) < size || share < 1e-3 {
                (x, residual) = (trial, found);
                break;
            }
            share *= 0.5;
        }
        if x.iter().any(|value| !value.is_finite()) {
            return None;
        }
    }
    None
}

/// The equations of rest in the coordinates and the forces of held elements.
struct Balance<'a> {
    system: &'a System,
    stiffness: &'a Matrix,
    /// Elements that are held, and where.
    held: Vec<(usize, f64)>,
}

impl Balance<'_> {
    fn is_held(&self, element: usize) -> bool {
        self.held.iter().any(|(held, _)| *held == element)
    }

    /// Derivative of the residual with the given slopes of the elements that are not held.
    fn matrix(&self, slope: impl Fn(&Element, &[f64]) -> f64, q: &[f64]) -> Matrix {
        let n = self.system.order();
        let size = n + self.held.len();
        let mut matrix = Matrix::zeros(size, size);
        for i in 0..n {
            matrix.row_mut(i)[..n].copy_from_slice(self.stiffness.row(i));
        }
        for (e, element) in self.system.elements.iter().enumerate() {
            if !self.is_held(e) {
                add_port(&mut matrix, element.port.terms(), slope(element, q));
            }
        }
        for (k, (element, _)) in self.held.iter().enumerate() {
            for &(i, factor) in self.system.elements[*element].port.terms() {
                matrix[(i, n + k)] = factor;
                matrix[(n + k, i)] = factor;
            }
        }
        matrix
    }

    fn right_side(&self) -> Vec<f64> {
        let mut right = self.system.forcing.constant.clone();
        right.extend(self.held.iter().map(|(_, position)| *position));
        right
    }

    fn residual(&self, x: &[f64]) -> Vec<f64> {
        let (q, forces) = x.split_at(self.system.order());
        let mut residual = self.stiffness.times(q);
        for (value, load) in residual.iter_mut().zip(&self.system.forcing.constant) {
            *value -= load;
        }
        for (e, element) in self.system.elements.iter().enumerate() {
            let force = match self.held.iter().position(|(held, _)| *held == e) {
                Some(k) => forces[k],
                None => element.law.response(element.port.project(q), 0.0).force,
            };
            for &(i, factor) in element.port.terms() {
                residual[i] += factor * force;
            }
        }
        let held = self.held.iter();
        residual.extend(
            held.map(|(element, position)| self.system.elements[*element].port.project(q) - position),
        );
        residual
    }
}

fn add_port(matrix: &mut Matrix, port: &[(usize, f64)], value: f64) {
    for &(i, a) in port {
        for &(j, b) in port {
            matrix[(i, j)] += a * b * value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slackside_mechanics::{Element, Forcing, Harmonic, Port, laws};

    fn oscillator(law: laws::PiecewiseLinear, load: f64) -> System {
        System {
            coordinates: vec!["x".into()],
            mass: Matrix::diagonal(&[1.0]),
            damping: Matrix::diagonal(&[0.1]),
            stiffness: Matrix::zeros(1, 1),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing {
                constant: vec![load],
                harmonics: vec![Harmonic {
                    order: 1,
                    cosine: vec![0.0],
                    sine: vec![1.0],
                }],
            },
            elements: vec![Element::new("spring", Port::new([(0, 1.0)]), law)],
            outputs: vec![],
        }
    }

    #[test]
    fn rest_lies_in_the_piece_that_carries_the_load() {
        let system = oscillator(laws::wrap_spring(4.0), 2.0);
        let rest = static_equilibrium(&system, 1.0).unwrap();
        assert!((rest[0] - 0.5).abs() < 1e-14);
        // A one-sided spring cannot carry a load that pulls the other way.
        let slack = oscillator(laws::wrap_spring(4.0), -2.0);
        assert!(matches!(
            static_equilibrium(&slack, 1.0),
            Err(StudyError::NoAnswer(_))
        ));
    }

    #[test]
    fn rest_is_found_beyond_a_gap() {
        let system = oscillator(laws::backlash(1.0, 50.0), -0.1);
        let rest = static_equilibrium(&system, 1.0).unwrap();
        assert!((rest[0] + 50.1).abs() < 1e-12, "{rest:?}");
    }

    /// A pulley on a spring and an accessory that nothing but the law holds, loaded against each other.
    fn drive(law: impl slackside_mechanics::Law + 'static, load: f64) -> System {
        System {
            coordinates: vec!["pulley".into(), "accessory".into()],
            mass: Matrix::diagonal(&[1.0, 2.0]),
            damping: Matrix::zeros(2, 2),
            stiffness: Matrix::diagonal(&[5.0, 0.0]),
            damping_linear_in_frequency: None,
            stiffness_quadratic_in_frequency: None,
            forcing: Forcing {
                constant: vec![0.5, -load],
                harmonics: vec![],
            },
            elements: vec![Element::new("clutch", Port::new([(0, 1.0), (1, -1.0)]), law)],
            outputs: vec![],
        }
    }

    #[test]
    fn a_pressed_clutch_carries_the_load_and_a_pulled_one_does_not() {
        // Both turn together until the belt's spring carries the sum of the loads.
        let rest = rest_state(&drive(laws::one_way(), 3.0), 1.0).unwrap();
        assert_eq!(rest.len(), 4);
        for (found, expected) in rest.iter().zip([-0.5, -0.5, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-14, "{rest:?}");
        }
        let pulled = static_equilibrium(&drive(laws::one_way(), -3.0), 1.0);
        assert!(matches!(pulled, Err(StudyError::NoAnswer(_))));
    }

    #[test]
    fn springs_with_a_wind_up_carry_the_load() {
        let of = |preload: f64| laws::Decoupler::new(50.0, 0.0, preload).unwrap();
        for (preload, windup) in [(0.0, 0.06), (1.0, 0.04), (4.0, 0.0)] {
            let rest = rest_state(&drive(of(preload), 3.0), 1.0).unwrap();
            assert_eq!(rest.len(), 5);
            assert!(
                (rest[0] + 0.5).abs() < 1e-14 && (rest[4] - windup).abs() < 1e-14,
                "{rest:?}"
            );
        }
        assert!(rest_state(&drive(of(0.0), -3.0), 1.0).is_err());
        let rest = rest_state(&drive(laws::spring_slider(50.0, 4.0), -3.0), 1.0).unwrap();
        assert!((rest[4] + 0.06).abs() < 1e-14, "{rest:?}");
        assert!(rest_state(&drive(laws::spring_slider(50.0, 2.0), -3.0), 1.0).is_err());
    }

    #[test]
    fn friction_holds_what_nothing_else_holds() {
        let held = rest_state(&drive(laws::coulomb(2.0, 2.0), 3.0), 1.0).unwrap();
        assert!((held[0] + 0.5).abs() < 1e-14, "{held:?}");
        assert!(rest_state(&drive(laws::coulomb(2.0, 1.0), 3.0), 1.0).is_err());
        // On a spring it rests where the spring is at ease.
        let mut system = drive(laws::coulomb(2.0, 1.0), 0.0);
        system.elements[0].port = Port::new([(0, 1.0)]);
        system.stiffness = Matrix::diagonal(&[5.0, 1.0]);
        assert!((rest_state(&system, 1.0).unwrap()[0] - 0.1).abs() < 1e-14);
    }

    #[test]
    fn a_load_against_a_rigid_stop_rests_on_it() {
        let mut system = drive(laws::rigid_stop(0.02, 0.5), 0.0);
        system.elements[0].port = Port::new([(0, 1.0)]);
        system.stiffness = Matrix::diagonal(&[5.0, 1.0]);
        assert!((rest_state(&system, 1.0).unwrap()[0] - 0.02).abs() < 1e-15);
        system.forcing.constant[0] = -0.5;
        assert!((rest_state(&system, 1.0).unwrap()[0] + 0.1).abs() < 1e-14);
    }
}
