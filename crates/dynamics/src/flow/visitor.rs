//! Who looks on while a motion is computed.

use super::step_map::StepMap;
use crate::orbit::EventRecord;

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
}

/// Nobody looks on.
pub(crate) struct Unwatched;

impl Visitor for Unwatched {}

/// Collects the events, with phases counted from `offset`.
#[derive(Debug, Default)]
pub(crate) struct EventList {
    pub frequency: f64,
    /// Phase at the start of the current period of the load.
    pub offset: f64,
    pub events: Vec<EventRecord>,
}

impl Visitor for EventList {
    fn event(&mut self, event: &Event) {
        self.events.push(EventRecord {
            phase: self.offset + event.time * self.frequency,
            element: event.element,
            from: event.from,
            to: event.to,
        });
    }
}
