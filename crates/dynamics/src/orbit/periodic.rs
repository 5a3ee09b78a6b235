//! One periodic motion at one operating point, from wherever: march, then Newton on the period map, and march on if that does
//! not converge (theory 05 §7).
//!
//! Where the motion is unique and attracts every other (theory 05 §2.1) this finds it from any start. Directions that the
//! equations leave free are pinned: the angle of an overrunning accessory at zero, the place at which a port sticks for all
//! time where it is.

use super::floquet::multipliers;
use crate::flow::{Flow, FlowError, Record, Request};
use slackside_linalg::{Complex, LinalgError, Lu, Matrix, dot};
use slackside_mechanics::{Output, Piece, System};

/// How a periodic motion is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicSettings {
    /// Periods of the load after which the motion repeats.
    pub periods: usize,
    /// Periods of the motion marched before the first Newton step.
    pub march: usize,
    /// Largest residual accepted, relative to the size of the state.
    pub tolerance: f64,
    /// Rounds of marching on and trying again.
    pub rounds: usize,
    /// Whether a port that sticks for all time stays where the march left it, instead of in the middle of where it may.
    pub keep_place: bool,
}

impl Default for PeriodicSettings {
    fn default() -> Self {
        Self {
            periods: 1,
            march: 10,
            tolerance: 1e-12,
            rounds: 60,
            keep_place: false,
        }
    }
}

/// Why no periodic motion was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PeriodicError {
    /// The flow failed.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// Neither Newton's method nor marching came to rest.
    #[error(
        "no motion that repeats after {periods} period(s) was reached: after {marched} periods the state still misses itself \
         by {residual:.1e} of its size"
    )]
    NotReached {
        /// Periods of the load after which it should repeat.
        periods: usize,
        /// Periods of the load marched.
        marched: usize,
        /// Last residual.
        residual: f64,
    },
}

/// A periodic motion at one operating point.
#[derive(Debug, Clone)]
pub struct PeriodicMotion {
    /// State `(q, q', ζ)` at phase zero.
    pub start: Vec<f64>,
    /// Periods of the load after which it repeats.
    pub periods: usize,
    /// Derivative of the period map at the start.
    pub monodromy: Matrix,
    /// What the state misses itself by, relative to its size; free directions left out.
    pub residual: f64,
    /// Newton steps.
    pub iterations: usize,
    /// Periods of the load marched.
    pub marched: usize,
    /// Events in the motion's period.
    pub events: usize,
    /// Elements of dry friction that stick for all time: where they do so is not determined.
    pub stuck: Vec<usize>,
}

impl PeriodicMotion {
    /// Floquet multipliers of the directions that are not pinned, largest modulus first.
    ///
    /// # Errors
    /// [`LinalgError`] if the eigenvalue iteration fails.
    pub fn multipliers(&self) -> Result<Vec<Complex>, LinalgError> {
        multipliers(&self.monodromy)
    }
}

/// A direction in which the period map moves nothing: the row that measures it and the unit of motion along it.
#[derive(Debug, Clone)]
struct Pin {
    row: Vec<f64>,
    direction: Vec<f64>,
    /// Where the row is held; `None` for where it is.
    target: Option<f64>,
}

impl Pin {
    /// The cyclic coordinate `i` of a state of length `nx`, held at zero.
    fn coordinate(i: usize, nx: usize) -> Self {
        let mut row = vec![0.0; nx];
        row[i] = 1.0;
        Self {
            direction: row.clone(),
            row,
            target: Some(0.0),
        }
    }

    /// How far the state is from where the pin holds it.
    fn offset(&self, x: &[f64]) -> f64 {
        self.target.map_or(0.0, |target| dot(&self.row, x) - target)
    }
}

/// Share of the period from which on a port that sticks is looked at as one that may stick for all time.
const CREEP: f64 = 0.98;

/// Newton steps from one start.
const NEWTON_LIMIT: usize = 12;

/// Middle of the force limits within which an element sticks, if they are fixed and finite.
fn middle_of_limits(system: &System, element: usize) -> Option<f64> {
    let table = system.elements[element].law.regimes()?;
    let stick = table.regimes.iter().find(|regime| regime.sticks())?;
    let mut limits = [None; 2];
    for guard in &stick.guards {
        if guard.displacement != 0.0 || guard.internal != 0.0 {
            return None;
        }
        let limit = -guard.constant / guard.force;
        limits[usize::from(guard.force < 0.0)] = Some(limit);
    }
    let middle = 0.5 * (limits[0]? + limits[1]?);
    middle.is_finite().then_some(middle)
}

/// The search for periodic motions of one system, with what does not change from one start to the next.
pub struct PeriodicSearch<'a> {
    flow: &'a mut dyn Flow,
    system: &'a System,
    settings: PeriodicSettings,
    cyclic: Vec<usize>,
    /// The regime in which each element holds its port by a law of the velocity, if it has one and its place matters.
    sticking: Vec<Option<usize>>,
    /// Weights of the norm: `√M_ii` of velocities, times `Ω` of coordinates.
    weights: Vec<f64>,
}

impl<'a> PeriodicSearch<'a> {
    /// A search with the flow of `system`.
    pub fn new(flow: &'a mut dyn Flow, system: &'a System, settings: PeriodicSettings) -> Self {
        let n = system.order();
        let root = |i: usize| system.mass[(i, i)].sqrt();
        let frequency = flow.frequency();
        let internal = flow.dimension() - 2 * n;
        let weights = (0..n)
            .map(|i| frequency * root(i))
            .chain((0..n).map(root))
            .chain((0..internal).map(|_| 1.0))
            .collect();
        let cyclic = system.cyclic_coordinates();
        let sticking = system.elements.iter().map(|element| {
            // The place of a locked clutch is the angle of its accessory, which is pinned already.
            let terms = element.port.terms();
            if terms.iter().any(|(i, _)| cyclic.contains(i)) {
                return None;
            }
            let regimes = element.law.regimes()?.regimes;
            regimes
                .iter()
                .position(|regime| regime.piece == Piece::Stick { position: None })
        });
        let sticking = sticking.collect();
        Self {
            cyclic,
            sticking,
            flow,
            system,
            settings,
            weights,
        }
    }

    /// The periodic motion that is reached from a state. Where a port of dry friction sticks for all time, the place at which
    /// it does is not determined; the motion in the middle of all possible ones is given (theory 05 §5.2), unless the
    /// settings keep the place that was reached.
    ///
    /// # Errors
    /// [`PeriodicError`].
    pub fn from_state(&mut self, start: &[f64]) -> Result<PeriodicMotion, PeriodicError> {
        let motion = self.reach(start)?;
        if self.settings.keep_place {
            return Ok(motion);
        }
        let motion = self.brought_to_rest(motion)?;
        Ok(self.centred(&motion)?.unwrap_or(motion))
    }

    fn reach(&mut self, start: &[f64]) -> Result<PeriodicMotion, PeriodicError> {
        let PeriodicSettings {
            periods,
            march,
            tolerance,
            rounds,
            ..
        } = self.settings;
        let mut x = start.to_vec();
        let (mut marched, mut iterations) = (0, 0);
        let mut residual = f64::INFINITY;
        let mut length = march;
        for _ in 0..rounds {
            self.march(&mut x, length)?;
            marched += length * periods;
            let attempt = self.newton(&x, &[])?;
            iterations += attempt.iterations;
            residual = attempt.residual;
            if residual <= tolerance {
                return Ok(PeriodicMotion {
                    iterations,
                    marched,
                    ..attempt
                });
            }
            // Contraction goes on where Newton's method lost its way: a little longer every time.
            length = (length + length / 2 + 5).min(400);
        }
        Err(PeriodicError::NotReached {
            periods,
            marched,
            residual,
        })
    }

    /// Newton's method on the period map from a state, as long as it gains; the best state met, whatever its residual.
    /// `places` fixes where ports that stick throughout do so.
    fn newton(&mut self, x: &[f64], places: &[(usize, f64)]) -> Result<PeriodicMotion, PeriodicError> {
        let tolerance = self.settings.tolerance;
        let mut best = PeriodicMotion {
            start: x.to_vec(),
            periods: self.settings.periods,
            monodromy: Matrix::zeros(0, 0),
            residual: f64::INFINITY,
            iterations: 0,
            marched: 0,
            events: 0,
            stuck: Vec::new(),
        };
        let mut current = x.to_vec();
        for iterations in 0..NEWTON_LIMIT {
            let Ok((end, monodromy, events)) = self.map(&current) else {
                break;
            };
            let (pins, stuck) = self.pins(&current, places)?;
            let misses = self.misses(&current, &end, &pins);
            let offset = pins
                .iter()
                .map(|pin| pin.offset(&current).abs())
                .fold(0.0, f64::max);
            let residual = self.size(&misses) / self.size(&end).max(f64::MIN_POSITIVE) + offset;
            let gained = residual < 0.5 * best.residual;
            if residual < best.residual {
                best = PeriodicMotion {
                    start: current.clone(),
                    monodromy: restricted(monodromy.clone(), &pins),
                    residual,
                    iterations,
                    events,
                    stuck,
                    ..best
                };
            }
            if !gained || !residual.is_finite() || residual <= 1e-3 * tolerance {
                break;
            }
            let Some(step) = newton_step(monodromy, &misses, &current, &pins) else {
                break;
            };
            for (value, change) in current.iter_mut().zip(&step) {
                *value += change;
            }
        }
        Ok(best)
    }

    /// The motion with a port at rest that was reached while creeping: just above its critical friction a port goes on slipping
    /// ever less at the edge of the places where it may stick (theory 05 §5.2), and never arrives. Moved to their middle,
    /// it sticks.
    fn brought_to_rest(&mut self, motion: PeriodicMotion) -> Result<PeriodicMotion, PeriodicError> {
        let n = self.system.order();
        for (element, share) in self.sticking_shares(&motion.start)? {
            if motion.stuck.contains(&element) || share < CREEP {
                continue;
            }
            let Some(middle) = middle_of_limits(self.system, element) else {
                continue;
            };
            let excess = self.middle_of_force(&motion, element)? - middle;
            let Some(response) = self.static_response(element) else {
                continue;
            };
            let mut moved = motion.start.clone();
            for (q, response) in moved[..n].iter_mut().zip(&response) {
                *q += excess * response;
            }
            let at_rest = self.newton(&moved, &[])?;
            if at_rest.residual <= self.settings.tolerance && at_rest.stuck.contains(&element) {
                return Ok(PeriodicMotion {
                    iterations: motion.iterations + at_rest.iterations,
                    marched: motion.marched,
                    ..at_rest
                });
            }
        }
        Ok(motion)
    }

    /// The motion whose stuck ports sit in the middle of the places where they may; `None` if none is stuck or the middle is
    /// not known. The force of a stuck port is linear in its place, so that two more motions give it.
    fn centred(&mut self, motion: &PeriodicMotion) -> Result<Option<PeriodicMotion>, PeriodicError> {
        let mut centre: Option<PeriodicMotion> = None;
        for &element in &motion.stuck {
            let now = centre.as_ref().unwrap_or(motion).clone();
            let Some(middle) = middle_of_limits(self.system, element) else {
                continue;
            };
            let port = &self.system.elements[element].port;
            let n = self.system.order();
            let dense = port.dense(n);
            let stiffness = dot(
                &dense,
                &self.system.stiffness_at(self.flow.frequency()).times(&dense),
            );
            let excess = self.middle_of_force(&now, element)? - middle;
            let place = port.project(&now.start[..n]);
            // Less than the place is off by: the stiffness with all else held is the largest there is.
            let trial = excess / stiffness;
            if trial == 0.0 || !trial.is_finite() {
                continue;
            }
            let moved = self.newton(&now.start, &[(element, place + trial)])?;
            let slope = (excess - (self.middle_of_force(&moved, element)? - middle)) / trial;
            let target = place + excess / slope;
            let moved = self.newton(&moved.start, &[(element, target)])?;
            if moved.residual <= self.settings.tolerance && moved.stuck == now.stuck {
                centre = Some(PeriodicMotion {
                    iterations: now.iterations + 2,
                    marched: now.marched,
                    ..moved
                });
            }
        }
        Ok(centre)
    }

    /// Static displacements under a unit force at an element's port, cyclic coordinates held; `None` if the rest is not stiff.
    fn static_response(&self, element: usize) -> Option<Vec<f64>> {
        let n = self.system.order();
        let kept: Vec<usize> = (0..n).filter(|i| !self.cyclic.contains(i)).collect();
        let stiffness = self.system.stiffness_at(self.flow.frequency()).selected(&kept);
        let port = self.system.elements[element].port.dense(n);
        let load: Vec<f64> = kept.iter().map(|&i| port[i]).collect();
        let mut response = vec![0.0; n];
        for (&i, value) in kept.iter().zip(Lu::new(&stiffness).ok()?.solve(&load)) {
            response[i] = value;
        }
        response.iter().all(|value| value.is_finite()).then_some(response)
    }

    /// Middle of the range of an element's force over the motion.
    fn middle_of_force(&mut self, motion: &PeriodicMotion, element: usize) -> Result<f64, PeriodicError> {
        let output = Output::element_force("force", element);
        let request = Request {
            extremes: true,
            ..Request::default()
        };
        let record = self.record(motion, &[output], &request)?;
        Ok(record
            .measures
            .first()
            .map_or(0.0, |measure| 0.5 * (measure.max + measure.min)))
    }

    /// Summary of a periodic motion.
    ///
    /// # Errors
    /// [`FlowError`].
    pub fn record(
        &mut self,
        motion: &PeriodicMotion,
        outputs: &[Output],
        request: &Request,
    ) -> Result<Record, FlowError> {
        let mut state = motion.start.clone();
        self.flow.record(&mut state, motion.periods, outputs, request)
    }

    /// Moves on by whole periods of the motion; cyclic coordinates are turned back so that they do not grow.
    fn march(&mut self, x: &mut [f64], periods: usize) -> Result<(), FlowError> {
        if periods > 0 {
            self.flow.advance(x, periods * self.settings.periods, &mut [])?;
        }
        for &i in &self.cyclic {
            x[i] = 0.0;
        }
        Ok(())
    }

    fn map(&mut self, x: &[f64]) -> Result<(Vec<f64>, Matrix, usize), FlowError> {
        let nx = x.len();
        let mut variations = vec![0.0; nx * nx];
        for i in 0..nx {
            variations[i * nx + i] = 1.0;
        }
        let mut end = x.to_vec();
        let events = self
            .flow
            .advance(&mut end, self.settings.periods, &mut variations)?;
        let mut monodromy = Matrix::zeros(nx, nx);
        for j in 0..nx {
            for i in 0..nx {
                monodromy[(i, j)] = variations[j * nx + i];
            }
        }
        Ok((end, monodromy, events))
    }

    /// Free directions: cyclic coordinates, and the places of ports that stick throughout, with the latter's elements.
    fn pins(&mut self, x: &[f64], places: &[(usize, f64)]) -> Result<(Vec<Pin>, Vec<usize>), FlowError> {
        let (n, nx) = (self.system.order(), x.len());
        let mut pins: Vec<Pin> = self.cyclic.iter().map(|&i| Pin::coordinate(i, nx)).collect();
        let mut stuck = Vec::new();
        for element in self.sticking_throughout(x)? {
            let port = self.system.elements[element].port.dense(n);
            stuck.push(element);
            let response = Lu::new(&self.system.mass)?.solve(&port);
            let mobility = dot(&port, &response);
            let mut row = port;
            row.resize(nx, 0.0);
            let mut direction: Vec<f64> = response.iter().map(|value| value / mobility).collect();
            direction.resize(nx, 0.0);
            let target = places
                .iter()
                .find(|(e, _)| *e == element)
                .map(|(_, place)| *place);
            pins.push(Pin {
                row,
                direction,
                target,
            });
        }
        Ok((pins, stuck))
    }

    /// Elements held by a law of the velocity throughout the period.
    fn sticking_throughout(&mut self, x: &[f64]) -> Result<Vec<usize>, FlowError> {
        let shares = self.sticking_shares(x)?.into_iter();
        Ok(shares
            .filter(|(_, share)| *share > 1.0 - 1e-12)
            .map(|(element, _)| element)
            .collect())
    }

    /// Elements that a law of the velocity may hold at a place that matters, each with the share of the period in which it does.
    fn sticking_shares(&mut self, x: &[f64]) -> Result<Vec<(usize, f64)>, FlowError> {
        if self.sticking.iter().all(Option::is_none) {
            return Ok(Vec::new());
        }
        let record = self
            .flow
            .record(&mut x.to_vec(), self.settings.periods, &[], &Request::default())?;
        let shares = self.sticking.iter().zip(&record.fractions).enumerate();
        Ok(shares
            .filter_map(|(element, (regime, shares))| Some((element, *shares.get((*regime)?)?)))
            .collect())
    }

    /// What the state misses itself by, without the free directions.
    fn misses(&self, start: &[f64], end: &[f64], pins: &[Pin]) -> Vec<f64> {
        let mut misses: Vec<f64> = end.iter().zip(start).map(|(e, s)| e - s).collect();
        project(&mut misses, pins);
        misses
    }

    fn size(&self, x: &[f64]) -> f64 {
        let weighted = x.iter().zip(&self.weights).map(|(x, w)| (x * w) * (x * w));
        weighted.sum::<f64>().sqrt()
    }
}

/// Removes from a vector its parts along the pins.
fn project(vector: &mut [f64], pins: &[Pin]) {
    for pin in pins {
        let share = dot(&pin.row, vector);
        for (value, d) in vector.iter_mut().zip(&pin.direction) {
            *value -= share * d;
        }
    }
}

/// The monodromy matrix without its free directions.
fn restricted(mut monodromy: Matrix, pins: &[Pin]) -> Matrix {
    let n = monodromy.rows();
    for j in 0..n {
        let mut column = monodromy.column(j);
        project(&mut column, pins);
        for (i, value) in column.into_iter().enumerate() {
            monodromy[(i, j)] = value;
        }
    }
    monodromy
}

/// Solves `(I − d pᵀ)(Mon − I) Δ − d pᵀ Δ = −misses + d (pᵀ x − target)`; `None` if the matrix is singular.
fn newton_step(monodromy: Matrix, misses: &[f64], x: &[f64], pins: &[Pin]) -> Option<Vec<f64>> {
    let n = misses.len();
    let mut matrix = monodromy;
    for i in 0..n {
        matrix[(i, i)] -= 1.0;
    }
    let mut matrix = restricted(matrix, pins);
    let mut right: Vec<f64> = misses.iter().map(|value| -value).collect();
    for pin in pins {
        let offset = pin.offset(x);
        for i in 0..n {
            right[i] += pin.direction[i] * offset;
            if pin.direction[i] != 0.0 {
                for j in 0..n {
                    matrix[(i, j)] -= pin.direction[i] * pin.row[j];
                }
            }
        }
    }
    let step = Lu::new(&matrix).ok()?.solve(&right);
    step.iter().all(|value| value.is_finite()).then_some(step)
}
