//! One periodic motion at one operating point, from wherever: march, then Newton on the period map, and march on if that does
//! not converge (theory 05 §7).
//!
//! Where the motion is unique and attracts every other (theory 05 §2.1) this finds it from any start. Directions that the
//! equations leave free are pinned: the angle of an overrunning accessory at zero, the place at which a port sticks for all
//! time where it is.

mod pins;
mod places;

use super::floquet::multipliers;
use crate::flow::{Flow, FlowError, Record, Request};
use pins::{Pin, newton_step, project, restricted};
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

/// Newton steps from one start.
const NEWTON_LIMIT: usize = 12;

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
