"""scikit-sundae: SUNDIALS CVODE (Adams) with root finding; task (c) and a share of task (b)."""

import problem  # before NumPy: it restricts the numerics to one thread  # noqa: F401

import numpy as np
import sksundae
from sksundae.cvode import CVODE

import peer_cli
from compiled_rate import make_rate

RELATIVE_TOLERANCE, ABSOLUTE_TOLERANCE = 1e-12, 1e-14


class SundaeAdvance:
    """One CVODE solver per regime, stopped by the clutch crossing that ends the regime."""

    def __init__(self, case: str) -> None:
        self._frequency = [0.0]  # read by the right-hand sides, so that the solvers need not be rebuilt
        self._solvers = {engaged: self._solver(engaged, case) for engaged in (True, False)}

    def _solver(self, engaged: bool, case: str) -> CVODE:
        rate, frequency = make_rate(engaged, case), self._frequency

        def right_side(time: float, state: np.ndarray, out: np.ndarray) -> None:
            rate(time, state, frequency[0], out)

        def delta(time: float, state: np.ndarray, out: np.ndarray) -> None:
            out[0] = state[0] - state[1]

        delta.terminal, delta.direction = [True], [-1 if engaged else 1]
        return CVODE(
            right_side,
            method="Adams",
            rtol=RELATIVE_TOLERANCE,
            atol=ABSOLUTE_TOLERANCE,
            eventsfn=delta,
            num_events=1,
            max_num_steps=1_000_000,
        )

    def __call__(
        self, engaged: bool, frequency: float, start: float, state: np.ndarray, end: float, samples: np.ndarray
    ) -> tuple[float, np.ndarray, np.ndarray]:
        """See `problem.Advance`."""
        self._frequency[0] = frequency
        solver = self._solvers[engaged]
        solver.init_step(start, state)
        deltas = []
        for target in np.append(samples, end):
            step = solver.step(target)
            if not step.success:
                raise RuntimeError(f"CVODE stopped at {step.t}: {step.message}")
            if step.t < target:
                break
            deltas.append(step.y[0] - step.y[1])
        return float(step.t), np.array(step.y), np.array(deltas[: len(samples)])


def main() -> None:
    """Run the tasks and print one JSON line for each."""
    note = (
        f"CVODE Adams, rtol {RELATIVE_TOLERANCE:g}, atol {ABSOLUTE_TOLERANCE:g}; right-hand side compiled with Numba, "
        "but one Python call-back for each evaluation"
    )
    peer_cli.run("scikit-sundae", sksundae.__version__, lambda: SundaeAdvance("A"), note)


if __name__ == "__main__":
    main()
