//! Progress and interruption.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is told while a study runs.
#[derive(Debug, Clone, PartialEq)]
pub enum Progress {
    /// So many jobs of the study are done.
    Jobs {
        /// Finished jobs.
        done: usize,
        /// All jobs.
        of: usize,
    },
    /// A job has got so far; the text says how far, for example the last parameter value.
    Step(String),
}

type Listener = dyn Fn(Progress) + Send + Sync;

/// Progress out of, and interruption into, a running study. Clones share both.
#[derive(Clone)]
pub struct Signal {
    interrupted: Arc<AtomicBool>,
    listener: Arc<Listener>,
}

impl Signal {
    /// A signal that interrupts when the flag is set and tells progress to `listener`, from any thread.
    pub fn new(interrupted: Arc<AtomicBool>, listener: impl Fn(Progress) + Send + Sync + 'static) -> Self {
        Self {
            interrupted,
            listener: Arc::new(listener),
        }
    }

    /// A signal that never interrupts and tells nobody.
    pub fn none() -> Self {
        Self::new(Arc::new(AtomicBool::new(false)), |_| {})
    }

    /// Whether the study should finish what it is at and stop.
    pub fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Asks the study to stop.
    pub fn interrupt(&self) {
        self.interrupted.store(true, Ordering::Relaxed);
    }

    /// Tells progress.
    pub fn tell(&self, progress: Progress) {
        (self.listener)(progress);
    }
}
