//! Repeated measurement in CPU time.

use cpu_time::ProcessTime;
use serde_json::{Value, json};

/// CPU seconds of several runs, and the last result.
pub(crate) struct Timing<T> {
    seconds: Vec<f64>,
    pub result: T,
}

/// Runs `work` once untimed and then `repeats` times timed.
pub(crate) fn measure<T>(repeats: usize, mut work: impl FnMut() -> T) -> Timing<T> {
    let mut result = work();
    let mut seconds = Vec::with_capacity(repeats);
    for _ in 0..repeats.max(1) {
        let start = ProcessTime::now();
        result = work();
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    Timing { seconds, result }
}

impl<T> Timing<T> {
    /// The same for one of `count` equal pieces of the work.
    pub fn divided(mut self, count: usize) -> Self {
        self.seconds
            .iter_mut()
            .for_each(|seconds| *seconds /= count as f64);
        self
    }

    /// The shortest time.
    pub fn least(&self) -> f64 {
        self.seconds[0]
    }

    /// The JSON line of a task.
    pub fn line(&self, task: &str, case: &str, accuracy: Value, flops: f64, note: &str) -> Value {
        json!({
            "peer": "slackside",
            "version": env!("CARGO_PKG_VERSION"),
            "task": task,
            "case": case,
            "cpu_seconds_min": self.seconds[0],
            "cpu_seconds_median": self.seconds[self.seconds.len() / 2],
            "repeats": self.seconds.len(),
            "accuracy": accuracy,
            "flops": flops.round(),
            "gigaflops_per_second": flops / self.seconds[0] * 1e-9,
            "note": note,
        })
    }
}
