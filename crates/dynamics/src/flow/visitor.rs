//! Who looks on while a motion is computed.

use super::step_map::StepMap;

/// A piece of the motion within one regime, at most one step long.
pub(crate) struct Piece<'a> {
    /// The regime's tables.
    pub map: &'a StepMap,
    /// Position of the regime in the flow's store.
    pub position: usize,
    /// Augmented state at the start of the piece.
    pub z: &'a [f64],
    /// Time since the start of the load's period.
    pub time: f64,
    /// Length of the piece in time.
    pub duration: f64,
    /// Length of the piece as a share of the regime's step.
    pub share: f64,
}

/// An event.
pub(crate) struct Event {
    /// Time since the start of the load's period.
    pub time: f64,
    pub element: usize,
    pub from: usize,
    pub to: usize,
}

/// Looks on while a motion is computed; the default looks at nothing and costs nothing.
pub(crate) trait Visitor {
    /// Whether pieces are shown.
    const WANTS_PIECES: bool = false;
    fn piece(&mut self, _piece: &Piece<'_>) {}
    fn event(&mut self, _event: &Event) {}
    /// An element's impact takes this kinetic energy.
    fn impact(&mut self, _element: usize, _energy: f64) {}
}

/// Counts events.
#[derive(Debug, Default)]
pub(crate) struct EventCount {
    pub events: usize,
}

impl Visitor for EventCount {
    fn event(&mut self, _: &Event) {
        self.events += 1;
    }
}
