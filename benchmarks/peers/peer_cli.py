"""Command line shared by the time-integration peers: tasks (b) and (c) of case A."""

import argparse
from collections.abc import Callable
from pathlib import Path

import problem  # before NumPy: it restricts the numerics to one thread

import numpy as np


def run(peer: str, version: str, prepare: Callable[[], problem.Advance], note: str, slow: bool = True) -> None:
    """Prepare the integrator, run the tasks asked for on the command line, print one JSON line for each.

    A slow peer runs only a share of task (b) unless ``--full`` is given; the line then states the share of the 140,000
    periods that was run, and its times are those of the share.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--repeats", type=int, default=5, help="repeats of runs under 10 s (longer ones: 2)")
    parser.add_argument("--tasks", default="bc", help="letters of the tasks to run")
    parser.add_argument("--full", action="store_true", help="run all legs of task (b)")
    parser.add_argument("--write-sweep", type=Path, metavar="FOLDER", help="only run task (b) and write it as CSV")
    options = parser.parse_args()

    def first_use() -> problem.Advance:
        """Prepare, and visit both regimes so that just-in-time compilation is over before the clock starts."""
        advance = prepare()
        for engaged in (True, False):
            start = problem.START if engaged else -problem.START
            advance(engaged, problem.MOTION_FREQUENCY, 0.0, start, 1e-3, np.array([5e-4]))
        return advance

    advance, compile_seconds = problem.timed(first_use)
    if options.write_sweep:
        problem.write_sweep(problem.run_sweep(advance), options.write_sweep)
        return
    common = {"peer": peer, "version": version, "case": "A", "compile_seconds": compile_seconds}
    if "c" in options.tasks:
        motion, seconds = problem.measure(lambda: problem.run_motion(advance), options.repeats)
        problem.report(task="c", seconds=seconds, accuracy=problem.motion_accuracy(*motion), note=note, **common)
    if "b" in options.tasks:
        work = problem.run_sweep
        if slow and not options.full:
            work = problem.run_sweep_share
            note += "; (b): every 25th leg only, each from its stored start state"
        sweep, seconds = problem.measure(lambda: work(advance), options.repeats)
        accuracy = problem.sweep_accuracy(sweep)
        share = problem.share_of_periods(sweep)
        problem.report(task="b", seconds=seconds, accuracy=accuracy, note=note, share=share, **common)
