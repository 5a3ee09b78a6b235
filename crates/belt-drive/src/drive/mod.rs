//! What a serpentine drive is made of: belt, pulleys, tensioners, and how it was installed.
//!
//! Everything is in SI units. Pulleys stand in the order in which the belt meets them; span `i` runs from pulley `i` to
//! pulley `i + 1`, counted cyclically (theory 04 §0).

mod belt;
mod condition;
mod excitation;
mod load;
mod pulley;
mod tensioner;
mod tensioner_friction;

pub use belt::{ArcStretch, Belt, BeltDamping, BeltModel, LossFactor, ModalDamping, SpanEnds};
pub use condition::Condition;
pub use excitation::{Excitation, OrderAmplitude, OrderTable};
pub use load::{Load, LoadTable, Speeds};
pub use pulley::{Coupling, Flexible, Mount, Pulley, Sense};
pub use tensioner::{Guide, PulleyContact, StopContact, Tensioner};
pub use tensioner_friction::TensionerFriction;

/// A belt drive with any number of pulleys, spans and tensioners.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// The belt.
    pub belt: Belt,
    /// The pulleys in the order of belt travel, at least two.
    pub pulleys: Vec<Pulley>,
    /// The tensioners; none for fixed centres.
    pub tensioners: Vec<Tensioner>,
    /// Index of the pulley that drives the belt.
    pub driver: usize,
    /// What is known of the installation.
    pub installation: Installation,
}

/// What fixes the natural length of the belt and the spring torque of the tensioners (theory 04 §2.5).
#[derive(Debug, Clone, PartialEq)]
pub enum Installation {
    /// At rest, unloaded, with this uniform tension (N) and every arm at its reference position. The spring torque at the
    /// reference position follows from the balance of each arm.
    Tension(f64),
    /// Natural belt length (m); every tensioner has a spring preload.
    NaturalLength(f64),
    /// Every arm stands at its reference position at the operating point, and every tensioner has a spring preload. The
    /// belt length follows; with several tensioners all arms must be in balance at one tension.
    OperatingPosition {
        /// Driver speed at which the arms stand there, rad/s.
        driver_speed: f64,
    },
}

impl Drive {
    /// Index of the pulley after `pulley` in the direction of travel.
    pub fn next(&self, pulley: usize) -> usize {
        (pulley + 1) % self.pulleys.len()
    }

    /// Index of the span that ends at `pulley`.
    pub fn span_before(&self, pulley: usize) -> usize {
        (pulley + self.pulleys.len() - 1) % self.pulleys.len()
    }

    /// Name of a span, `from-to`.
    pub fn span_name(&self, span: usize) -> String {
        format!(
            "{}-{}",
            self.pulleys[span].name,
            self.pulleys[self.next(span)].name
        )
    }

    /// Indices of the pulleys that a tensioner carries.
    pub fn carried_by(&self, tensioner: usize) -> impl Iterator<Item = usize> + '_ {
        self.pulleys
            .iter()
            .enumerate()
            .filter(move |(_, pulley)| matches!(pulley.mount, Mount::Carried { tensioner: t, .. } if t == tensioner))
            .map(|(index, _)| index)
    }

    /// Reference positions of all arms.
    pub fn reference_positions(&self) -> Vec<f64> {
        self.tensioners
            .iter()
            .map(|tensioner| tensioner.reference)
            .collect()
    }

    /// Belt speed at a driver speed (rad/s), m/s.
    pub fn belt_speed(&self, driver_speed: f64) -> f64 {
        self.pulleys[self.driver].radius * driver_speed
    }

    /// Load torques of all pulleys at a driver speed (rad/s), N·m, positive against the belt's travel; zero at the driver.
    pub fn load_torques(&self, driver_speed: f64) -> Vec<f64> {
        let belt_speed = self.belt_speed(driver_speed);
        let torque = |(index, pulley): (usize, &Pulley)| {
            if index == self.driver {
                return 0.0;
            }
            pulley.load.torque(&Speeds {
                driver: driver_speed,
                pulley: belt_speed / pulley.radius,
            })
        };
        self.pulleys.iter().enumerate().map(torque).collect()
    }

    /// The same pulleys with every sense reversed.
    pub fn reversed(&self) -> Self {
        let mut reversed = self.clone();
        for pulley in &mut reversed.pulleys {
            pulley.sense = pulley.sense.reversed();
        }
        reversed
    }

    /// The same drive without any viscous damping; dry friction stays.
    pub fn undamped(&self) -> Self {
        let mut undamped = self.clone();
        undamped.belt.damping = BeltDamping::default();
        for pulley in &mut undamped.pulleys {
            pulley.bearing_damping = 0.0;
            pulley.accessory_damping = 0.0;
            match &mut pulley.coupling {
                Coupling::Rigid { .. } | Coupling::OneWay { .. } => {}
                Coupling::Isolator(spring)
                | Coupling::WrapSpring(spring)
                | Coupling::Decoupler { spring, .. } => {
                    spring.damping = 0.0;
                }
            }
        }
        for tensioner in &mut undamped.tensioners {
            tensioner.damping = 0.0;
            tensioner.one_way_damping = 0.0;
        }
        undamped
    }

    /// The same drive with all lengths of its structure (centres, radii, arms, ways of slides) times a factor; the
    /// belt and the torques of the springs at their reference positions stay.
    pub fn enlarged(&self, factor: f64) -> Self {
        let mut enlarged = self.clone();
        for pulley in &mut enlarged.pulleys {
            pulley.radius *= factor;
            match &mut pulley.mount {
                Mount::Fixed(place) | Mount::Carried { place, .. } => *place *= factor,
            }
        }
        for tensioner in &mut enlarged.tensioners {
            match &mut tensioner.guide {
                Guide::Rotary { pivot } => *pivot *= factor,
                // The coordinate is a length of the structure too.
                Guide::Linear { .. } => {
                    tensioner.reference *= factor;
                    tensioner.stops = tensioner.stops.map(|stops| stops.map(|stop| stop * factor));
                }
            }
        }
        enlarged
    }
}
