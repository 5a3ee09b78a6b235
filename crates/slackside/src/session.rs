//! Threads, progress on standard error, and interruption by Ctrl-C.

use crate::failure::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use slackside_studies::{Progress, Signal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// A running study as the terminal sees it.
pub struct Session {
    interrupted: Arc<AtomicBool>,
    bar: ProgressBar,
}

impl Session {
    /// Starts the threads, listens for Ctrl-C and shows progress unless it is not wanted.
    ///
    /// # Errors
    /// [`Failure::Threads`].
    pub fn open(threads: Option<u16>, quiet: bool) -> Result<Self, Failure> {
        if let Some(threads) = threads {
            rayon::ThreadPoolBuilder::new()
                .num_threads(usize::from(threads))
                .build_global()?;
        }
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = interrupted.clone();
        // Without a handler Ctrl-C ends the program at once, which leaves nothing half-written either.
        let _ = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        });
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(None, target);
        if let Ok(style) =
            ProgressStyle::with_template("{spinner} {prefix} {elapsed} {wide_bar} {pos}/{len} {msg}")
        {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Ok(Self { interrupted, bar })
    }

    /// The signal for a study.
    pub fn signal(&self) -> Signal {
        let bar = self.bar.clone();
        Signal::new(self.interrupted.clone(), move |progress| match progress {
            Progress::Jobs { done, of } => {
                bar.set_length(of as u64);
                bar.set_position(done as u64);
            }
            Progress::Step(text) => bar.set_message(text),
        })
    }

    /// Says what is being done, beside the progress.
    pub fn say(&self, text: &str) {
        self.bar.set_prefix(text.to_owned());
    }

    /// Does something while progress is off the screen.
    pub fn suspend<T>(&self, action: impl FnOnce() -> T) -> T {
        self.bar.suspend(action)
    }

    /// Takes progress off the screen.
    pub fn close(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.close();
    }
}
