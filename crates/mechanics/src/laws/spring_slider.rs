//! A spring in series with a dry-friction slider, the Jenkins element (theory 05 §6.3).

use crate::law::{Guard, InternalRate, Law, Piece, Regime, RegimeTable, Response, Transition};

/// A spring of `stiffness` in series with a slider that yields at `torque`. Several of them at one port are an Iwan model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringSlider {
    stiffness: f64,
    torque: f64,
}

/// The element with `stiffness > 0` of the spring and `torque > 0` of the slider; its internal state is the wind-up of the
/// spring.
pub fn spring_slider(stiffness: f64, torque: f64) -> SpringSlider {
    SpringSlider { stiffness, torque }
}

impl Law for SpringSlider {
    fn kind(&self) -> &'static str {
        "spring-slider"
    }

    fn response(&self, _: f64, velocity: f64) -> Response {
        let force = if velocity == 0.0 {
            0.0
        } else {
            self.torque * velocity.signum()
        };
        Response {
            force,
            ..Response::default()
        }
    }

    fn regimes(&self) -> Option<RegimeTable> {
        let slip = |name: &'static str, sign: f64| {
            let back = Guard::on_velocity(sign, 0.0, Transition::To(1));
            Regime::new(name, false, Piece::constant(sign * self.torque), vec![back])
        };
        let stick = Regime {
            internal_rate: InternalRate {
                velocity: 1.0,
                ..InternalRate::default()
            },
            ..Regime::new(
                "stick",
                true,
                Piece::Affine {
                    constant: 0.0,
                    displacement: 0.0,
                    velocity: 0.0,
                    internal: self.stiffness,
                },
                vec![
                    Guard::on_internal(self.stiffness, self.torque, Transition::To(0)),
                    Guard::on_internal(-self.stiffness, self.torque, Transition::To(2)),
                ],
            )
        };
        Some(RegimeTable {
            regimes: vec![slip("slip-", -1.0), stick, slip("slip+", 1.0)],
            rests: Vec::new(),
            internal: true,
        })
    }

    fn is_monotone(&self) -> bool {
        true
    }

    fn linearized(&self) -> (f64, f64) {
        (self.stiffness, 0.0)
    }
}
