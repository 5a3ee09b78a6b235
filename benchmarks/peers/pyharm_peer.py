"""pyHarm: harmonic balance with arc-length continuation; task (a), cases A and B.

The clutch is pyHarm's own penalty element for one-sided contact with zero gap: exactly ``K_d max(delta, 0)``, evaluated
by alternating frequency and time. pyHarm computes the curve only: no multipliers, no special points located.
"""

import argparse
import logging
import os
import tempfile
import warnings
from dataclasses import dataclass
from functools import partial
from typing import Any

import problem  # before NumPy: it restricts the numerics to one thread

import numpy as np

os.chdir(tempfile.gettempdir())  # pyHarm writes a folder .pyHarm where it is imported
import pyHarm
from pyHarm._version import __version__ as VERSION

warnings.filterwarnings("ignore", message=".*faster on contiguous arrays.*")
logging.disable(logging.CRITICAL)  # pyHarm logs every step

HARMONICS = (10, 20)
TIME_STEPS = 512
LARGEST_STEP, FIRST_STEP, SMALLEST_STEP = 0.05, 0.01, 1e-6


@dataclass
class Curve:
    """Accepted points in order along the branch: frequency and RMS of ``delta`` about its mean."""

    frequency: np.ndarray
    rms: np.ndarray
    complete: bool


def model(case: str, harmonics: int) -> dict[str, Any]:
    """Return pyHarm's input: the drive without clutch, the clutch, the loads, the analysis."""
    low, high = problem.FREQUENCY_RANGE
    pulley, accessory = {"drive": [0]}, {"drive": [1]}
    matrices = {"M": problem.MASS, "C": problem.DAMPING, "K": problem.STIFFNESS_DISENGAGED}
    load = {"type": "GOForcing", "dirs": [0], "dto": 0}
    return {
        "system": {"type": "Base", "nh": harmonics, "nti": TIME_STEPS},
        "substructures": {"drive": {"matrix": matrices, "ndofs": 1}},
        "connectors": {
            "clutch": {
                "type": "PenaltyUnilateralGap",
                "connect": {"drive": [0], "INTERNAL": [1]},
                "dirs": [0],
                "g": 0.0,
                "k": problem.CLUTCH_STIFFNESS,
            },
            "crank": load | {"connect": pulley, "ho": 1, "amp": problem.forcing(case)},
            "belt_preload": load | {"connect": dict(pulley), "ho": 0, "amp": problem.PRELOAD},
            "accessory_load": load | {"connect": accessory, "ho": 0, "amp": -problem.PRELOAD},
        },
        "analysis": {
            "response": {
                "study": "frf",
                "solver": "NewtonRaphson",
                "solver_options": {"tol_residual": 1e-9, "tol_delta_x": 1e-8, "max_iter": 20},
                "corrector": "pseudo_arc_length",
                "puls_inf": low,
                "puls_sup": high,
                "ds0": FIRST_STEP,
                "ds_min": SMALLEST_STEP,
                "ds_max": LARGEST_STEP,
                "verbose": False,
                "predictor_options": {"verbose": False},
            }
        },
    }


def trace(case: str, harmonics: int) -> Curve:
    """Run the continuation from the lower end of the frequency range upwards."""
    maestro = pyHarm.Maestro(model(case, harmonics))
    maestro.operate()
    points = np.array([point.x for point in maestro.nls["response"].SolList if point.flag_accepted])
    dofs = maestro.system.expl_dofs
    oscillating = dofs["harm"] > 0
    pulley = dofs.index[oscillating & (dofs["node_num"] == 0)]
    accessory = dofs.index[oscillating & (dofs["node_num"] == 1)]
    rms = np.sqrt(0.5 * ((points[:, pulley] - points[:, accessory]) ** 2).sum(axis=1))
    frequency = points[:, -1]
    return Curve(frequency, rms, bool(frequency[-1] >= problem.FREQUENCY_RANGE[1] - 1e-3))


def extremes(values: np.ndarray, sign: float | None = None) -> list[float]:
    """Return the local extremes of a sequence (maxima only if ``sign`` is 1) as vertices of parabolas."""
    found = []
    for before, here, after in zip(values, values[1:], values[2:]):
        left, right = here - before, here - after
        if left * right > 0.0 and (sign is None or left * sign > 0.0):
            found.append(float(here + (left - right) ** 2 / (8.0 * (left + right))))
    return found


def nearest_errors(found: list[float], expected: list[str]) -> list[float]:
    """Return, for each expected value, the distance to the nearest one found; nothing when none was found."""
    return [round(min(abs(value - float(exact)) for value in found), 7) for exact in expected if found]


def accuracy(case: str, curve: Curve) -> dict[str, Any]:
    """Compare turning points of the frequency and (case A) maxima of the RMS with the exact folds and peaks."""
    if case == "A":
        reference = problem.REFERENCE["caseA_exact"]
        folds = [fold["W"] for fold in reference["folds"]]
        peaks = [peak["rms"] for peak in reference["rms_peaks"]]
    else:
        folds, peaks = problem.REFERENCE["caseB_exact"]["LP"], []
    turning_points = extremes(curve.frequency)
    result = {
        "points": len(curve.frequency),
        "complete": curve.complete,
        "turning_points": len(turning_points),
        "turning_points_expected": len(folds),
        "fold_errors": nearest_errors(turning_points, folds),
    }
    if peaks:
        result["rms_peak_errors"] = nearest_errors(extremes(curve.rms, 1.0), peaks)
    return result


def main() -> None:
    """Run task (a) with each number of harmonics and print one JSON line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5, help="repeats of runs under 10 s (longer ones: 2)")
    parser.add_argument("--cases", default="AB", help="letters of the cases to run")
    options = parser.parse_args()
    for case in options.cases:
        for harmonics in HARMONICS:
            run = partial(trace, case, harmonics)
            _, first_seconds = problem.timed(run)
            curve, seconds = problem.measure(run, options.repeats)
            note = (
                f"{harmonics} harmonics, {TIME_STEPS} time steps, largest step {LARGEST_STEP:g}; curve only, without "
                "multipliers or special points (folds here: parabolas through three points); Python and Numba"
            )
            problem.report(
                f"pyharm-{harmonics}",
                VERSION,
                "a",
                case,
                seconds,
                accuracy(case, curve),
                note,
                compile_seconds=max(0.0, first_seconds - min(seconds)),
            )


if __name__ == "__main__":
    main()
