//! A set-valued graph of the velocity with one vertical segment at rest: one-way clutch and dry friction (theory 05 §6.1).

use crate::law::{Guard, Law, Piece, Regime, RegimeTable, Response, Rest, Transition};

/// The force along one side of the graph: `constant + damping · v`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Force at the edge of rest.
    pub constant: f64,
    /// Slope, not negative.
    pub damping: f64,
}

/// A maximal monotone graph `v → f` with a vertical segment at `v = 0`: a ray for `v < 0`, the segment between the two rays'
/// ends, a ray for `v > 0`. A missing ray makes `v = 0` a one-sided constraint. The static limits within which the port
/// stays at rest may reach beyond the segment (`static friction above kinetic`), and then the law is no longer monotone.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityGraph {
    kind: &'static str,
    backward: Option<Ray>,
    forward: Option<Ray>,
    /// Static limits of the force.
    limits: (f64, f64),
    /// Names of the regimes: moving backward, at rest, moving forward.
    names: [&'static str; 3],
    /// Whether modes are computed with the port locked.
    locks: bool,
}

/// The relative-velocity one-way clutch: `f ≥ 0`, `v ≤ 0`, `f v = 0` (theory 05 §4.1).
pub fn one_way() -> VelocityGraph {
    VelocityGraph {
        kind: "one-way",
        backward: Some(Ray {
            constant: 0.0,
            damping: 0.0,
        }),
        forward: None,
        limits: (0.0, f64::INFINITY),
        names: ["overrunning", "locked", ""],
        locks: true,
    }
}

/// Dry friction: `f = torque · sgn v`, at rest `|f| ≤ static_ratio · torque` (theory 05 §5.1).
pub fn coulomb(torque: f64, static_ratio: f64) -> VelocityGraph {
    asymmetric_coulomb(torque, torque, static_ratio)
}

/// Dry friction that depends on the direction: `f = −negative` for `v < 0`, `f = positive` for `v > 0`, at rest between
/// `static_ratio` times the two.
pub fn asymmetric_coulomb(negative: f64, positive: f64, static_ratio: f64) -> VelocityGraph {
    dry_friction(
        Ray {
            constant: -negative,
            damping: 0.0,
        },
        Ray {
            constant: positive,
            damping: 0.0,
        },
        static_ratio,
    )
}

/// Dry friction with a viscous part on either side. The rays start below and above zero.
pub fn dry_friction(backward: Ray, forward: Ray, static_ratio: f64) -> VelocityGraph {
    VelocityGraph {
        kind: "coulomb",
        backward: Some(backward),
        forward: Some(forward),
        limits: (static_ratio * backward.constant, static_ratio * forward.constant),
        names: ["slip-", "stick", "slip+"],
        locks: false,
    }
}

impl VelocityGraph {
    /// The ray of backward motion, if the port may move backward.
    pub fn backward(&self) -> Option<Ray> {
        self.backward
    }

    /// The ray of forward motion, if the port may move forward.
    pub fn forward(&self) -> Option<Ray> {
        self.forward
    }

    /// Limits of the force at rest.
    pub fn limits(&self) -> (f64, f64) {
        self.limits
    }

    /// The ends of the vertical segment between the two rays.
    fn segment(&self) -> (f64, f64) {
        (
            self.backward.map_or(f64::NEG_INFINITY, |ray| ray.constant),
            self.forward.map_or(f64::INFINITY, |ray| ray.constant),
        )
    }
}

impl Law for VelocityGraph {
    fn kind(&self) -> &'static str {
        self.kind
    }

    fn response(&self, _: f64, velocity: f64) -> Response {
        let ray = if velocity < 0.0 {
            self.backward
        } else if velocity > 0.0 {
            self.forward
        } else {
            None
        };
        ray.map_or_else(Response::default, |ray| Response {
            force: ray.constant + ray.damping * velocity,
            by_displacement: 0.0,
            by_velocity: ray.damping,
        })
    }

    fn regimes(&self) -> Option<RegimeTable> {
        let rest = Transition::Rest(0);
        let moving = |name: &'static str, ray: Ray, sign: f64| {
            let piece = Piece::Affine {
                constant: ray.constant,
                displacement: 0.0,
                velocity: ray.damping,
                internal: 0.0,
            };
            Regime::new(name, false, piece, vec![Guard::on_velocity(sign, 0.0, rest)])
        };
        let mut regimes = Vec::new();
        let mut rests = Rest::default();
        if let Some(ray) = self.backward {
            rests.backward = Some(regimes.len());
            regimes.push(moving(self.names[0], ray, -1.0));
        }
        let mut guards = Vec::new();
        if self.backward.is_some() {
            guards.push(Guard::on_force(1.0, -self.limits.0, rest));
        }
        if self.forward.is_some() {
            guards.push(Guard::on_force(-1.0, self.limits.1, rest));
        }
        rests.stick = Some(regimes.len());
        regimes.push(Regime::new(
            self.names[1],
            true,
            Piece::Stick { position: None },
            guards,
        ));
        if let Some(ray) = self.forward {
            rests.forward = Some(regimes.len());
            regimes.push(moving(self.names[2], ray, 1.0));
        }
        Some(RegimeTable {
            regimes,
            rests: vec![rests],
            internal: false,
        })
    }

    fn is_monotone(&self) -> bool {
        let slopes = [self.backward, self.forward].into_iter().flatten();
        let (low, high) = self.segment();
        self.limits == (low, high) && low <= high && slopes.into_iter().all(|ray| ray.damping >= 0.0)
    }

    fn linearized(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn locks(&self) -> bool {
        self.locks
    }

    fn resolvent(&self, w: f64, r: f64) -> Option<(f64, f64)> {
        if !self.is_monotone() {
            return None;
        }
        for (ray, sign) in [(self.backward, -1.0), (self.forward, 1.0)] {
            if let Some(ray) = ray {
                let v = (w - r * ray.constant) / (1.0 + r * ray.damping);
                if sign * v > 0.0 {
                    return Some((v, ray.constant + ray.damping * v));
                }
            }
        }
        Some((0.0, w / r))
    }
}
