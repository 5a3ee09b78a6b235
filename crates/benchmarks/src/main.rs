//! The shared clutch problem (α = 2, β = 1, K_b = 20, K_d = 10, M = 1, ζ = 3 %) and the eight-pulley drive, timed in CPU
//! seconds on one thread.
//!
//! `slackside-benchmarks a|b|c|d|e|f|g|h|i|j|k [--case A|B] [--repeats N]` prints one JSON line per task: minimum and median over the
//! repeats, and how far the result is from the reference. Everything runs through the public interfaces of the engine.

mod balance;
mod curve;
mod drive;
mod flops;
mod history;
mod nonsmooth;
mod scales;
mod speed_run;
mod sweep;
mod timing;

use clap::{Parser, ValueEnum};

/// A task of the shared problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Task {
    /// Frequency-response curve with special points and multipliers.
    A,
    /// Sweep up and down, 140,000 periods.
    B,
    /// One motion of 2,000 periods.
    C,
    /// 1,000 steady states of the eight-pulley drive.
    D,
    /// Campbell diagram of the eight-pulley drive, 100 speeds.
    E,
    /// One resonance by multiple scales, a curve of 1,000 points.
    F,
    /// One periodic orbit of a drive of thirteen coordinates with an overrunning clutch, with statistics.
    G,
    /// 300 such orbits over frequency.
    H,
    /// The eight-pulley drive with decoupler and dry friction at 500 speeds.
    I,
    /// The critical load of the drive of thirteen coordinates, per frequency.
    J,
    /// 300 points of condensed harmonic balance with dry friction, 20 harmonics.
    K,
    /// Nothing is timed: the matrices of the eight-pulley drive at one speed, for peers.
    Matrices,
}

/// Amplitude of the crank: case A 0.05, case B 0.10.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "UPPER")]
pub(crate) enum Case {
    /// Four folds.
    A,
    /// Six folds, four period doublings, eight Neimark–Sacker points.
    B,
}

#[derive(Debug, Parser)]
struct Arguments {
    /// Which task.
    task: Task,
    /// Which amplitude (task a only).
    #[arg(long, default_value = "A")]
    case: Case,
    /// Timed repeats.
    #[arg(long, default_value_t = 5)]
    repeats: usize,
}

fn main() {
    let arguments = Arguments::parse();
    let line = match arguments.task {
        Task::A => curve::run(arguments.case, arguments.repeats),
        Task::B => sweep::run(arguments.repeats),
        Task::C => history::run(arguments.repeats),
        Task::D => drive::sheets(arguments.repeats),
        Task::E => drive::diagram(arguments.repeats),
        Task::F => scales::run(arguments.repeats),
        Task::G => nonsmooth::one(arguments.repeats),
        Task::H => nonsmooth::sweep(arguments.repeats),
        Task::I => speed_run::run(arguments.repeats),
        Task::J => nonsmooth::critical_load(arguments.repeats),
        Task::K => balance::run(arguments.repeats),
        Task::Matrices => drive::matrices(),
    };
    println!("{line}");
}
