//! Which coordinates the linear model has, and where they stand.

use crate::drive::{BeltModel, Drive};
use std::ops::Range;

/// One coordinate of the linear model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coordinate {
    /// Rotation of a pulley, positive with the belt's travel, rad.
    Pulley(usize),
    /// Rotation of the accessory behind a pulley, rad.
    Accessory(usize),
    /// Position of a tensioner, rad or m.
    Arm(usize),
    /// Amplitude of a sine over a span, m.
    Sine {
        /// The span.
        span: usize,
        /// Number of half waves, from 1.
        term: usize,
    },
}

/// The coordinates in their order: pulleys, accessories with a rotation of their own, arms, sines span by span.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Coordinates {
    list: Vec<Coordinate>,
    arms: Range<usize>,
    /// First sine of every span, and one past the last.
    sines: Vec<usize>,
}

impl Coordinates {
    pub(super) fn new(drive: &Drive, disengaged: &[usize]) -> Self {
        let mut list: Vec<Coordinate> = (0..drive.pulleys.len()).map(Coordinate::Pulley).collect();
        let has_rotor = |j: &usize| {
            let coupling = &drive.pulleys[*j].coupling;
            disengaged.contains(j) || (coupling.flexible().is_some() && coupling.accessory_inertia() > 0.0)
        };
        list.extend(
            (0..drive.pulleys.len())
                .filter(has_rotor)
                .map(Coordinate::Accessory),
        );
        let first_arm = list.len();
        list.extend((0..drive.tensioners.len()).map(Coordinate::Arm));
        let arms = first_arm..list.len();
        let mut sines = vec![list.len()];
        for span in 0..drive.pulleys.len() {
            let terms = match drive.belt.model {
                BeltModel::Spring => 0,
                BeltModel::String | BeltModel::Beam => drive.belt.terms[span],
            };
            list.extend((1..=terms).map(|term| Coordinate::Sine { span, term }));
            sines.push(list.len());
        }
        Self { list, arms, sines }
    }

    /// Number of coordinates.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are none; never, for a drive has pulleys.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The coordinates in order.
    pub fn iter(&self) -> impl Iterator<Item = Coordinate> + '_ {
        self.list.iter().copied()
    }

    /// Position of a pulley's rotation.
    pub fn pulley(&self, pulley: usize) -> usize {
        pulley
    }

    /// Position of the rotation of an accessory, if it has one of its own.
    pub fn accessory(&self, pulley: usize) -> Option<usize> {
        self.list
            .iter()
            .position(|coordinate| *coordinate == Coordinate::Accessory(pulley))
    }

    /// Position of an arm.
    pub fn arm(&self, tensioner: usize) -> usize {
        self.arms.start + tensioner
    }

    /// Positions of the sines of a span.
    pub fn sines(&self, span: usize) -> Range<usize> {
        self.sines[span]..self.sines[span + 1]
    }

    /// Name of a coordinate: `rotation.<pulley>`, `rotation.<pulley>.accessory`, `arm.<tensioner>`, `sine.<span>.<term>`.
    pub fn name(&self, drive: &Drive, index: usize) -> String {
        match self.list[index] {
            Coordinate::Pulley(j) => format!("rotation.{}", drive.pulleys[j].name),
            Coordinate::Accessory(j) => format!("rotation.{}.accessory", drive.pulleys[j].name),
            Coordinate::Arm(arm) => format!("arm.{}", drive.tensioners[arm].name),
            Coordinate::Sine { span, term } => format!("sine.{}.{term}", drive.span_name(span)),
        }
    }
}
