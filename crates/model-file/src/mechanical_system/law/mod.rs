//! The laws that an element of a mechanical system may have.

mod friction;
mod hysteresis_loop;
mod keys;
mod memory;
mod one_way;
mod piecewise_linear;
mod spring;
mod stop;

use schemars::JsonSchema;
use serde::Serialize;

pub use friction::{Coulomb, SpringSlider};
pub use hysteresis_loop::HysteresisLoop;
pub use memory::{Dahl, Lugre, Valanis};
pub use one_way::{Decoupler, OneWay, OneWayDamper};
pub use piecewise_linear::PiecewiseLinear;
pub use spring::{Backlash, Cubic, Isolator, WrapSpring};
pub use stop::Stop;

use crate::error::{Issue, Problem};
use crate::nearest::enumerate;
use crate::node::Node;
use crate::reader::{Read, TableReader, read_text, table_entries, unknown_choice};
use crate::scalar::{Numbers, Scalars, join, split_first};
use crate::smoothing::Smoothing;
use crate::units::quantities;
use keys::{LawKeys, SharedLaw, read_plain, read_smoothable};

/// A law: the force or torque of an element as a function of its deflection `u = b·q` and its rate `v`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Law {
    /// Wrap-spring clutch: `stiffness · u` for positive deflection, otherwise zero (theory 02 §1.1).
    WrapSpring(WrapSpring),
    /// Spring with free play: zero between -clearance and clearance, slope `stiffness` outside.
    Backlash(Backlash),
    /// One-sided stop where the deflection reaches the gap: compliant, `stiffness · (u - gap)` and a damper that does not
    /// pull, or rigid with a coefficient of restitution (theory 05 §6).
    Stop(Stop),
    /// Continuous piecewise-linear spring with zero force at zero deflection.
    PiecewiseLinear(PiecewiseLinear),
    /// Relative-velocity one-way clutch: `f ≥ 0`, `v ≤ 0`, and `f v = 0` (theory 05 §4.1).
    OneWay(OneWay),
    /// Damper that acts in one direction: `damping · v` for positive rate, otherwise zero.
    OneWayDamper(OneWayDamper),
    /// Overrunning decoupler: a spring in series with a one-way clutch (theory 05 §6.3).
    Decoupler(Decoupler),
    /// Dry friction: constant against the motion, up to `static_ratio` times as much at rest (theory 05 §5.1).
    Coulomb(Coulomb),
    /// Spring in series with dry friction (theory 05 §6.3).
    SpringSlider(SpringSlider),
    /// Measured loop of force over deflection (theory 05 §6.1).
    HysteresisLoop(HysteresisLoop),
    /// Friction with an elastic onset of sliding, `f' = stiffness · v (1 - f sgn v / torque)` (theory 05 §6.3).
    Dahl(Dahl),
    /// Bristles that deflect and slip, with friction that may fall with the rate (theory 05 §6.3).
    Lugre(Lugre),
    /// Joint with micro-slip and a stiffness of its own in gross slip (theory 05 §6.3).
    Valanis(Valanis),
    /// Linear spring and damper: `stiffness · u + damping · v`.
    Isolator(Isolator),
    /// Cubic spring: `linear · u + cubic · u³`.
    Cubic(Cubic),
}

/// Kinds of law in this version.
const KINDS: [&str; 15] = [
    "wrap-spring",
    "backlash",
    "stop",
    "piecewise-linear",
    "one-way",
    "one-way-damper",
    "decoupler",
    "coulomb",
    "spring-slider",
    "hysteresis-loop",
    "dahl",
    "lugre",
    "valanis",
    "isolator",
    "cubic",
];

impl Law {
    pub(super) fn read(node: &Node, path: &str) -> Read<Self> {
        table_entries(node, path)?;
        let kind_path = join(path, "kind");
        let Some(kind_node) = node.child("kind") else {
            return Err(
                Issue::new(Problem::MissingKey, kind_path, "the kind of the law is missing")
                    .at(&node.origin)
                    .with_help(format!("add `kind = …`; known are {}", enumerate(KINDS))),
            );
        };
        /// Reads a law that may be smoothed.
        macro_rules! smoothable {
            ($variant:ident, $width:expr) => {{
                let (mut law, smoothing) = read_smoothable::<$variant>(node, path, $width)?;
                law.smoothing = smoothing;
                Ok(Self::$variant(law))
            }};
        }
        match read_text(kind_node, &kind_path)? {
            "wrap-spring" => smoothable!(WrapSpring, &quantities::DISPLACEMENT),
            "backlash" => smoothable!(Backlash, &quantities::DISPLACEMENT),
            "stop" => smoothable!(Stop, &quantities::DISPLACEMENT),
            "piecewise-linear" => PiecewiseLinear::read(node, path).map(Self::PiecewiseLinear),
            "one-way" => {
                refuse_smoothing(node, path)?;
                TableReader::open(node, path, &["kind"])?;
                Ok(Self::OneWay(OneWay {}))
            }
            "one-way-damper" => smoothable!(OneWayDamper, &quantities::RATE),
            "decoupler" => read_plain(node, path).map(Self::Decoupler),
            "coulomb" => smoothable!(Coulomb, &quantities::RATE),
            "spring-slider" => read_plain(node, path).map(Self::SpringSlider),
            "hysteresis-loop" => HysteresisLoop::read(node, path).map(Self::HysteresisLoop),
            "dahl" => read_plain(node, path).map(Self::Dahl),
            "lugre" => read_plain(node, path).map(Self::Lugre),
            "valanis" => read_plain(node, path).map(Self::Valanis),
            "isolator" => read_plain(node, path).map(Self::Isolator),
            "cubic" => read_plain(node, path).map(Self::Cubic),
            unknown => Err(unknown_choice(
                kind_node,
                &kind_path,
                "kind of law",
                unknown,
                KINDS.into_iter(),
            )),
        }
    }

    pub(super) fn check(&self, path: &str) -> Read<()> {
        self.keys().check(path)?;
        match self.smoothing() {
            Some(smoothing) => smoothing.check(&join(path, "smoothing")),
            None => Ok(()),
        }
    }

    /// The law as the equations of motion have it.
    pub(super) fn law(&self, path: &str) -> Read<SharedLaw> {
        self.keys().law(path)
    }

    /// The smoothing, if the law has one.
    pub fn smoothing(&self) -> Option<&Smoothing> {
        self.keys().smoothing()
    }

    fn keys(&self) -> &dyn LawKeys {
        match self {
            Self::WrapSpring(law) => law,
            Self::Backlash(law) => law,
            Self::Stop(law) => law,
            Self::PiecewiseLinear(law) => law,
            Self::OneWay(law) => law,
            Self::OneWayDamper(law) => law,
            Self::Decoupler(law) => law,
            Self::Coulomb(law) => law,
            Self::SpringSlider(law) => law,
            Self::HysteresisLoop(law) => law,
            Self::Dahl(law) => law,
            Self::Lugre(law) => law,
            Self::Valanis(law) => law,
            Self::Isolator(law) => law,
            Self::Cubic(law) => law,
        }
    }

    fn keys_mut(&mut self) -> &mut dyn LawKeys {
        match self {
            Self::WrapSpring(law) => law,
            Self::Backlash(law) => law,
            Self::Stop(law) => law,
            Self::PiecewiseLinear(law) => law,
            Self::OneWay(law) => law,
            Self::OneWayDamper(law) => law,
            Self::Decoupler(law) => law,
            Self::Coulomb(law) => law,
            Self::SpringSlider(law) => law,
            Self::HysteresisLoop(law) => law,
            Self::Dahl(law) => law,
            Self::Lugre(law) => law,
            Self::Valanis(law) => law,
            Self::Isolator(law) => law,
            Self::Cubic(law) => law,
        }
    }
}

impl Numbers for Law {
    fn number_mut(&mut self, path: &str) -> Option<&mut f64> {
        match split_first(path) {
            ("smoothing", rest) => self.keys_mut().smoothing_mut()?.scalar_mut(rest),
            _ => self.keys_mut().number_mut(path),
        }
    }

    fn collect_keys(&self, prefix: &str, keys: &mut Vec<String>) {
        self.keys().collect_keys(prefix, keys);
        if let Some(smoothing) = self.smoothing() {
            smoothing.collect_scalar_keys(&join(prefix, "smoothing"), keys);
        }
    }
}

/// A one-way clutch has no finite torque on one side of rest, and therefore no smooth form of its own.
fn refuse_smoothing(node: &Node, path: &str) -> Read<()> {
    let Some(smoothing) = node.child("smoothing") else {
        return Ok(());
    };
    Err(Issue::new(
        Problem::WrongValue,
        join(path, "smoothing"),
        "a one-way clutch has no torque to smooth between",
    )
    .at(&smoothing.origin)
    .with_help("use `kind = \"one-way-damper\"` with a large `damping`, which may be smoothed"))
}
