//! Where ports that stick for all time do so (theory 05 §5.2).

use super::{PeriodicError, PeriodicMotion, PeriodicSearch};
use crate::flow::Request;
use slackside_linalg::{Lu, dot};
use slackside_mechanics::{Output, System};

/// Share of the period from which on a port that sticks is looked at as one that may stick for all time.
const CREEP: f64 = 0.98;

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

impl PeriodicSearch<'_> {
    /// The motion with a port at rest that was reached while creeping: just above its critical friction a port goes on slipping
    /// ever less at the edge of the places where it may stick (theory 05 §5.2), and never arrives. Moved to their middle,
    /// it sticks.
    pub(super) fn brought_to_rest(
        &mut self,
        motion: PeriodicMotion,
    ) -> Result<PeriodicMotion, PeriodicError> {
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
    pub(super) fn centred(
        &mut self,
        motion: &PeriodicMotion,
    ) -> Result<Option<PeriodicMotion>, PeriodicError> {
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
}
