//! Friction of a tensioner that depends on the direction of its motion (theory 05 §5, §6).

/// A law of friction. "Loading" is the motion in which the belt pushes the tensioner back against its spring, "unloading" the
/// one in which the spring tightens the belt. Torques are N·m, or N for a slide; angles rad, or m.
#[derive(Debug, Clone, PartialEq)]
pub enum TensionerFriction {
    /// Dry friction: constant in each direction, anything in between at rest.
    Coulomb {
        /// Friction while loading.
        loading: f64,
        /// Friction while unloading.
        unloading: f64,
        /// Friction at rest over that in motion, at least 1.
        static_ratio: f64,
    },
    /// Dry friction behind a spring, so that the tensioner gives before it slides.
    SpringSlider {
        /// Friction in both directions.
        torque: f64,
        /// Stiffness of the spring.
        stiffness: f64,
    },
    /// Friction that builds up gradually over the way, `f' = σ v (1 − f sgn(v)/T)`.
    Dahl {
        /// Friction of steady sliding.
        torque: f64,
        /// Stiffness `σ` at the turning points.
        stiffness: f64,
    },
    /// Friction of elastic bristles, with a maximum at slow motion.
    LuGre {
        /// Friction of fast sliding.
        torque: f64,
        /// Friction of very slow sliding over that, at least 1.
        static_ratio: f64,
        /// Velocity over which it falls, rad/s or m/s.
        stribeck_velocity: f64,
        /// Stiffness of the bristles.
        stiffness: f64,
        /// Damping of the bristles, in the same units times seconds.
        damping: f64,
        /// Viscous friction.
        viscous: f64,
    },
    /// The loop of a test bench over the whole stroke: torque of the tensioner, spring and friction together, positive where it
    /// tightens the belt.
    MeasuredLoop {
        /// Positions of the tensioner, ascending, at least two.
        positions: Vec<f64>,
        /// Torque while loading: the larger one.
        loading: Vec<f64>,
        /// Torque while unloading.
        unloading: Vec<f64>,
    },
}
