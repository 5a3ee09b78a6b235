"""The shared benchmark problem: two pulleys coupled by a wrap-spring one-way clutch.

Equations and damping follow theory 02 §1.4 and §1.7. Within a regime the state
``x = (theta_p, theta_a, theta_p', theta_a')`` obeys

    x' = A x + b + F cos(W t),

with the clutch stiffness present in ``A`` when ``delta = theta_p - theta_a > 0`` and absent otherwise.
Everything the peers have in common lives here: parameters, tasks (a)-(c), timing, accuracy, output.
"""

import os

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[_variable] = "1"  # before NumPy loads its BLAS
os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"

import csv
import json
import math
import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, TypeVar

import numpy as np

REFERENCE_FOLDER = Path(__file__).resolve().parent.parent / "reference"
REFERENCE: dict[str, Any] = json.loads((REFERENCE_FOLDER / "clutch_benchmark.json").read_text())

ALPHA, BETA, BELT_STIFFNESS, CLUTCH_STIFFNESS, PRELOAD, DAMPING_RATIO = 2.0, 1.0, 20.0, 10.0, 1.0, 0.03
AMPLITUDES = {"A": 0.05, "B": 0.10}
FREQUENCY_RANGE = (0.3, 8.0)

MASS = np.diag([1.0, ALPHA])
STIFFNESS_ENGAGED = np.array(
    [[BELT_STIFFNESS + CLUTCH_STIFFNESS, -CLUTCH_STIFFNESS], [-CLUTCH_STIFFNESS, CLUTCH_STIFFNESS]]
)
STIFFNESS_DISENGAGED = np.diag([BELT_STIFFNESS, 0.0])


def _damping() -> np.ndarray:
    """Return the damping matrix of equal modal ratios in the engaged modes (theory 02, C5)."""
    natural = np.sqrt(np.linalg.eigvals(np.linalg.solve(MASS, STIFFNESS_ENGAGED)))
    return 2.0 * DAMPING_RATIO * (STIFFNESS_ENGAGED + natural.prod() * MASS) / natural.sum()


DAMPING = _damping()


def state_matrix(engaged: bool) -> np.ndarray:
    """Return ``A`` of the regime, shape (4, 4)."""
    stiffness = STIFFNESS_ENGAGED if engaged else STIFFNESS_DISENGAGED
    lower = -np.linalg.solve(MASS, np.hstack([stiffness, DAMPING]))
    return np.vstack([np.hstack([np.zeros((2, 2)), np.eye(2)]), lower])


def constant_load() -> np.ndarray:
    """Return ``b``, shape (4,)."""
    return np.array([0.0, 0.0, PRELOAD, -PRELOAD / ALPHA])


def forcing(case: str) -> float:
    """Return the amplitude of the harmonic force on the pulley, ``f = beta K_b A_m``."""
    return BETA * BELT_STIFFNESS * AMPLITUDES[case]


# Tasks (b) and (c) -----------------------------------------------------------------------------------------------

START = np.array([0.0, -0.1, 0.0, 0.0])
MOTION_FREQUENCY, MOTION_PERIODS = 1.6, 2000
SETTLE_PERIODS, SAMPLED_PERIODS, SAMPLES_PER_PERIOD = 300, 50, 100
STEPS_EACH_WAY = 200
# The legs that slow peers run: 4 % of the legs, 4.1 % of the clutch events, 3.9 % of the time span of the whole.
SHARE = slice(19, None, 25)
NO_SAMPLES = np.empty(0)


@dataclass(frozen=True)
class Leg:
    """One frequency of the sweep: direction ("up" or "down"), index on the frequency grid, frequency."""

    direction: str
    index: int
    frequency: float


def sweep_legs() -> list[Leg]:
    """Return the 400 legs of task (b) in the order in which they are run."""
    low, high = FREQUENCY_RANGE
    frequency = [low + (high - low) * i / (STEPS_EACH_WAY - 1) for i in range(STEPS_EACH_WAY)]
    up = [Leg("up", i, frequency[i]) for i in range(STEPS_EACH_WAY)]
    return up + [Leg("down", leg.index, leg.frequency) for leg in reversed(up)]


class Advance(Protocol):
    """Integrate one regime until the clutch switches or ``end`` is reached."""

    def __call__(
        self, engaged: bool, frequency: float, start: float, state: np.ndarray, end: float, samples: np.ndarray
    ) -> tuple[float, np.ndarray, np.ndarray]:
        """Return the time reached (less than ``end`` only at a switch), the state there, and ``delta`` at
        those of the ascending ``samples`` (all in ``(start, end]``) that were passed."""
        ...


def follow(
    advance: Advance, frequency: float, state: np.ndarray, start: float, end: float, samples: np.ndarray = NO_SAMPLES
) -> tuple[np.ndarray, list[float], np.ndarray]:
    """Follow the motion from event to event; return end state, event times and ``delta`` at the samples."""
    engaged = bool(state[0] > state[1])
    now, events, pieces, taken = start, [], [], 0
    while True:
        now, state, deltas = advance(engaged, frequency, now, state, end, samples[taken:])
        taken += len(deltas)
        pieces.append(deltas)
        if now >= end:
            return state, events, np.concatenate(pieces)
        events.append(now)
        engaged = not engaged
        delta = state.item(0) - state.item(1)
        if delta == 0.0 or (delta > 0.0) != engaged:
            # Root finding leaves delta at zero up to round-off. Start strictly inside the new regime: an event function
            # that starts at exactly zero hides a second crossing within the same step (heyoka 7.13, SciPy 1.17).
            state[0] = math.nextafter(state.item(1), math.inf if engaged else -math.inf)


def run_leg(advance: Advance, frequency: float, state: np.ndarray) -> tuple[np.ndarray, float]:
    """Run one leg of task (b) from forcing phase 0; return the end state and the RMS of ``delta`` about its mean.

    Samples lie at the phases k/100 periods, k = 0 ... 4999, after the settling periods.
    """
    period = 2.0 * np.pi / frequency
    settled, end = SETTLE_PERIODS * period, (SETTLE_PERIODS + SAMPLED_PERIODS) * period
    state, _, _ = follow(advance, frequency, state, 0.0, settled)
    samples = settled + period / SAMPLES_PER_PERIOD * np.arange(1, SAMPLED_PERIODS * SAMPLES_PER_PERIOD)
    first = state[0] - state[1]
    state, _, deltas = follow(advance, frequency, state, settled, end, samples)
    return state, float(np.std(np.concatenate([[first], deltas])))


@dataclass
class SweepResult:
    """RMS of each leg, and the state in which each leg starts."""

    legs: list[Leg]
    rms: list[float] = field(default_factory=list)
    starts: list[np.ndarray] = field(default_factory=list)


def run_sweep(advance: Advance) -> SweepResult:
    """Run all of task (b), the state carried over from leg to leg."""
    result, state = SweepResult(sweep_legs()), START.copy()
    for leg in result.legs:
        result.starts.append(state)
        state, rms = run_leg(advance, leg.frequency, state)
        result.rms.append(rms)
    return result


def run_sweep_share(advance: Advance) -> SweepResult:
    """Run a share of the legs of task (b), each from its stored start state (see `write_sweep`)."""
    legs = sweep_legs()[SHARE]
    result = SweepResult(legs, starts=_read_starts()[SHARE])
    for leg, start in zip(legs, result.starts, strict=True):
        result.rms.append(run_leg(advance, leg.frequency, start)[1])
    return result


def run_motion(advance: Advance) -> tuple[np.ndarray, list[float]]:
    """Run task (c); return the end state and the event times."""
    end = 2.0 * np.pi / MOTION_FREQUENCY * MOTION_PERIODS
    state, events, _ = follow(advance, MOTION_FREQUENCY, START.copy(), 0.0, end)
    return state, events


# Accuracy --------------------------------------------------------------------------------------------------------


def motion_accuracy(state: np.ndarray, events: list[float]) -> dict[str, Any]:
    """Compare the end of task (c) with the periodic orbit: event count, end state, phases of the last two events.

    Phases are fractions of the forcing period.
    """
    reference = REFERENCE["task_c_exact"]
    phases = np.sort(np.array(events[-2:]) * MOTION_FREQUENCY / (2.0 * np.pi) % 1.0)
    exact = np.array([float(reference["disengage_phase"]), float(reference["engage_phase"])])
    return {
        "events": len(events),
        "events_expected": reference["events"],
        "end_state_error": float(np.abs(state - np.array(reference["x_end"], dtype=float)).max()),
        "event_phase_error": float(np.abs(phases - exact).max()),
    }


def share_of_periods(result: SweepResult) -> float:
    """Return the share of the 140,000 forcing periods of task (b) that ``result`` covers."""
    return len(result.legs) / (2 * STEPS_EACH_WAY)


def jump_intervals(result: SweepResult, direction: str) -> list[list[float]]:
    """Return the neighbouring frequencies between which the RMS of a full sweep jumps (largest two changes)."""
    pairs = [
        (leg.frequency, rms) for leg, rms in zip(result.legs, result.rms, strict=True) if leg.direction == direction
    ]
    steps = sorted(zip(pairs, pairs[1:]), key=lambda step: -abs(step[1][1] - step[0][1]))[:2]
    return sorted([round(before[0], 4), round(after[0], 4)] for before, after in steps)


def sweep_accuracy(result: SweepResult) -> dict[str, Any]:
    """Compare task (b), or a share of it, with the stored sweep, and the jumps of a full sweep with the reference."""
    stored = {(row["direction"], int(row["i"])): float(row["rms"]) for row in _read(REFERENCE_FOLDER / SWEEP_FILE)}
    errors = [abs(rms - stored[leg.direction, leg.index]) for leg, rms in zip(result.legs, result.rms, strict=True)]
    accuracy: dict[str, Any] = {"legs": len(errors), "rms_difference_from_stored_sweep": max(errors)}
    if len(result.legs) == 2 * STEPS_EACH_WAY:
        expected = REFERENCE["task_b_exact"]
        accuracy["jumps_match"] = all(
            jump_intervals(result, way) == sorted(expected[f"{way}_jumps_between"]) for way in ("up", "down")
        )
    return accuracy


SWEEP_FILE, STARTS_FILE = "sweep_heyoka.csv", "sweep_starts.csv"


def write_sweep(result: SweepResult, folder: Path) -> None:
    """Write RMS and start state of every leg, 17 significant digits."""
    folder.mkdir(parents=True, exist_ok=True)
    keys = [[leg.direction, leg.index, f"{leg.frequency:.17g}"] for leg in result.legs]
    rms = [[f"{value:.17g}"] for value in result.rms]
    starts = [[f"{value:.17g}" for value in start] for start in result.starts]
    state_names = ["theta_p", "theta_a", "theta_p_rate", "theta_a_rate"]
    for name, columns, rows in ((SWEEP_FILE, ["rms"], rms), (STARTS_FILE, state_names, starts)):
        with (folder / name).open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["direction", "i", "frequency", *columns])
            writer.writerows(key + row for key, row in zip(keys, rows, strict=True))


def _read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _read_starts() -> list[np.ndarray]:
    return [
        np.array([float(value) for value in list(row.values())[3:]]) for row in _read(REFERENCE_FOLDER / STARTS_FILE)
    ]


# Timing and output -----------------------------------------------------------------------------------------------

Result = TypeVar("Result")


def timed(run: Callable[[], Result]) -> tuple[Result, float]:
    """Return the result of ``run`` and its CPU time in seconds (all threads of this process)."""
    began = time.process_time()
    result = run()
    return result, time.process_time() - began


def measure(run: Callable[[], Result], repeats: int = 5, long_run: float = 10.0) -> tuple[Result, list[float]]:
    """Time ``run`` ``repeats`` times, or twice only when a run takes ``long_run`` CPU seconds or more."""
    result, first = timed(run)
    seconds = [first]
    for _ in range((repeats if first < long_run else min(repeats, 2)) - 1):
        seconds.append(timed(run)[1])
    return result, seconds


def report(
    peer: str,
    version: str,
    task: str,
    case: str,
    seconds: Iterable[float],
    accuracy: dict[str, Any],
    note: str,
    **extra: Any,
) -> None:
    """Print one JSON line; ``extra`` holds what only some peers state (compile time, share of the work done)."""
    values = list(seconds)
    line = {
        "peer": peer,
        "version": version,
        "task": task,
        "case": case,
        "cpu_seconds_min": min(values),
        "cpu_seconds_median": statistics.median(values),
        "repeats": len(values),
        "accuracy": accuracy,
        "note": note,
        **extra,
    }
    print(json.dumps(line), flush=True)
