//! Stops that the port cannot pass, and stops that push back only while they are pressed (theory 05 §6.3, §6.4).

use crate::law::{Guard, Law, Piece, Regime, RegimeTable, Response, Rest, Transition};

/// A rigid stop at the displacement `gap`: impacts with a coefficient of restitution, and contact when they have ceased.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidStop {
    gap: f64,
    restitution: f64,
}

/// A rigid stop at `gap` with `0 ≤ restitution ≤ 1`.
pub fn rigid_stop(gap: f64, restitution: f64) -> RigidStop {
    RigidStop { gap, restitution }
}

impl Law for RigidStop {
    fn kind(&self) -> &'static str {
        "stop"
    }

    fn response(&self, _: f64, _: f64) -> Response {
        Response::default()
    }

    fn regimes(&self) -> Option<RegimeTable> {
        let free = Guard::on_displacement(
            -1.0,
            self.gap,
            Transition::Impact {
                restitution: self.restitution,
                rest: 0,
            },
        );
        let contact = Piece::Stick {
            position: Some(self.gap),
        };
        let pressed = Guard::on_force(1.0, 0.0, Transition::Rest(0));
        Some(RegimeTable {
            regimes: vec![
                Regime::new("free", false, Piece::constant(0.0), vec![free]),
                Regime::new("contact", true, contact, vec![pressed]),
            ],
            rests: vec![Rest {
                backward: Some(0),
                stick: Some(1),
                forward: None,
            }],
            internal: false,
        })
    }

    fn is_monotone(&self) -> bool {
        false
    }

    fn linearized(&self) -> (f64, f64) {
        (0.0, 0.0)
    }
}

/// A stop with a spring and a damper, which pushes but does not pull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampedStop {
    gap: f64,
    stiffness: f64,
    damping: f64,
}

/// `f = max(stiffness · (u − gap) + damping · v, 0)` beyond the gap, for positive `stiffness` and `damping`. Without damping
/// [`super::stop`] is the same and continuous.
pub fn damped_stop(gap: f64, stiffness: f64, damping: f64) -> DampedStop {
    DampedStop {
        gap,
        stiffness,
        damping,
    }
}

impl Law for DampedStop {
    fn kind(&self) -> &'static str {
        "stop"
    }

    fn response(&self, displacement: f64, velocity: f64) -> Response {
        let force = self.stiffness * (displacement - self.gap) + self.damping * velocity;
        if displacement > self.gap && force > 0.0 {
            Response {
                force,
                by_displacement: self.stiffness,
                by_velocity: self.damping,
            }
        } else {
            Response::default()
        }
    }

    fn regimes(&self) -> Option<RegimeTable> {
        let (free, contact, released) = (0, 1, 2);
        let pressure = |sign: f64, to: usize| Guard {
            displacement: sign * self.stiffness,
            velocity: sign * self.damping,
            ..Guard::on_force(0.0, -sign * self.stiffness * self.gap, Transition::To(to))
        };
        let inside = Guard::on_displacement(1.0, -self.gap, Transition::To(free));
        let piece = Piece::Affine {
            constant: -self.stiffness * self.gap,
            displacement: self.stiffness,
            velocity: self.damping,
            internal: 0.0,
        };
        let outside = Guard::on_displacement(-1.0, self.gap, Transition::To(contact));
        Some(RegimeTable::of_function(vec![
            Regime::new("free", false, Piece::constant(0.0), vec![outside]),
            Regime::new("contact", true, piece, vec![pressure(1.0, released)]),
            Regime::new(
                "released",
                false,
                Piece::constant(0.0),
                vec![inside, pressure(-1.0, contact)],
            ),
        ]))
    }

    fn is_monotone(&self) -> bool {
        false
    }

    /// Free, or pressed if there is no gap: then it is a wrap spring with a damper.
    fn linearized(&self) -> (f64, f64) {
        if self.gap > 0.0 {
            (0.0, 0.0)
        } else {
            (self.stiffness, self.damping)
        }
    }
}
