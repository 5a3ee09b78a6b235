//! A study: plan self-contained jobs, run each, collect.

use crate::{Progress, Signal, StudyError};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A question: it plans jobs, runs any of them by itself and collects what they gave.
pub trait Study: Sync {
    /// A self-contained piece of work.
    type Job: Send + Sync;
    /// What a job gives.
    type Rows: Send;
    /// The answer.
    type Document;

    /// The jobs, in the order in which [`Self::collect`] gets their rows.
    ///
    /// # Errors
    /// [`StudyError`] if the question is wrong.
    fn plan(&self) -> Result<Vec<Self::Job>, StudyError>;

    /// Runs one job. When the signal interrupts, a job returns what it has if that is of use.
    ///
    /// # Errors
    /// [`StudyError`] if the job has no answer.
    fn run(&self, job: &Self::Job, signal: &Signal) -> Result<Self::Rows, StudyError>;

    /// The answer from the jobs that were run; `None` stands for one that was interrupted before it began.
    ///
    /// # Errors
    /// [`StudyError`] if nothing is worth an answer.
    fn collect(
        &self,
        rows: Vec<Option<Result<Self::Rows, StudyError>>>,
        interrupted: bool,
    ) -> Result<Self::Document, StudyError>;
}

/// Plans a study, runs its jobs in parallel and collects. When interrupted, running jobs come to their end and no other
/// begins.
///
/// # Errors
/// [`StudyError`].
pub fn execute<S: Study>(study: &S, signal: &Signal) -> Result<S::Document, StudyError> {
    let jobs = study.plan()?;
    let of = jobs.len();
    let done = AtomicUsize::new(0);
    signal.tell(Progress::Jobs { done: 0, of });
    let rows: Vec<_> = jobs
        .par_iter()
        .map(|job| {
            if signal.is_interrupted() {
                return None;
            }
            let rows = study.run(job, signal);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            signal.tell(Progress::Jobs { done, of });
            Some(rows)
        })
        .collect();
    study.collect(rows, signal.is_interrupted())
}
