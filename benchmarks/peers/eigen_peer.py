"""NumPy and SciPy on the eigenproblems of task (e): the same matrices, one set of modes for each of the 100 speeds.

The matrices come from ``slackside-benchmarks matrices``: the middle speed, solved as often as the diagram has speeds.
"""

import problem  # before NumPy: it restricts the numerics to one thread

import argparse
import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy
from scipy import linalg

ROOT = Path(__file__).resolve().parent.parent.parent
COMMAND = ["cargo", "run", "--release", "--quiet", "-p", "slackside-benchmarks", "--", "matrices"]


def hermitian(mass: np.ndarray, gyroscopic: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Frequencies and shapes by the Hermitian problem of theory 04 (4.1)."""
    size = len(mass)
    lower, stiff = linalg.cholesky(mass, lower=True), linalg.cholesky(stiffness, lower=True)
    turning = linalg.solve_triangular(lower, gyroscopic, lower=True)
    turning = linalg.solve_triangular(lower, turning.T, lower=True).T
    coupling = linalg.solve_triangular(lower, stiff, lower=True)
    matrix = 1j * np.block([[turning, coupling], [-coupling.T, np.zeros((size, size))]])
    values, vectors = linalg.eigh(matrix, driver="evd", overwrite_a=True, check_finite=False)
    linalg.solve_triangular(stiff, vectors[size:, size:], lower=True, trans="T", check_finite=False)
    return values[size:]


def general(mass: np.ndarray, gyroscopic: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Frequencies and shapes by the general eigenproblem of the first-order form."""
    size = len(mass)
    right = linalg.solve(mass, np.hstack([stiffness, gyroscopic]), assume_a="pos")
    matrix = np.block([[np.zeros((size, size)), np.eye(size)], [-right[:, :size], -right[:, size:]]])
    values, _ = linalg.eig(matrix, overwrite_a=True, check_finite=False)
    return np.sort(values.imag[values.imag > 0.0])


def main() -> None:
    """Time both ways and print one JSON line for each."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--tasks", default="e", help="only (e) is done here")
    options = parser.parse_args()
    done = subprocess.run(COMMAND, capture_output=True, text=True, check=True, cwd=ROOT)
    data = json.loads(done.stdout)
    matrices = [np.array(data[name]) for name in ("mass", "gyroscopic", "stiffness")]
    expected = np.array(data["frequencies"])
    ways: dict[str, Callable[..., np.ndarray]] = {"scipy-eigh": hermitian, "scipy-eig": general}
    for name, solve in ways.items():
        run = lambda solve=solve: [solve(*matrices) for _ in range(data["speeds"])][-1]
        found, seconds = problem.measure(run, options.repeats)
        difference = float(np.max(np.abs(found / expected - 1.0)))
        note = f"{solve.__doc__.rstrip('.')}; only the eigenproblems, at one speed, matrices given"
        problem.report(
            peer=name,
            version=scipy.__version__,
            task="e",
            case="A",
            seconds=seconds,
            accuracy={"largest_difference_of_a_frequency": difference},
            note=note,
        )


if __name__ == "__main__":
    main()
