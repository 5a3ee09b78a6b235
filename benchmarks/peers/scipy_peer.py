"""SciPy: ``solve_ivp`` with LSODA and DOP853, terminal events; task (c) and a share of task (b)."""

import problem  # before NumPy: it restricts the numerics to one thread

import numpy as np
import scipy
from scipy.integrate import solve_ivp

import peer_cli
from compiled_rate import Rate, make_rate

# The loosest relative tolerance tried of each method that keeps event phases within 1e-11 and RMS within 1e-10.
RELATIVE_TOLERANCE = {"LSODA": 1e-11, "DOP853": 1e-10}
ABSOLUTE_TO_RELATIVE = 1e-2


class ScipyAdvance:
    """One compiled right-hand side per regime; the clutch crossing that ends the regime is a terminal event."""

    def __init__(self, case: str, method: str) -> None:
        self._method = method
        self._rates: dict[bool, Rate] = {engaged: make_rate(engaged, case) for engaged in (True, False)}
        self._switches = {True: self._switch(-1.0), False: self._switch(1.0)}

    @staticmethod
    def _switch(direction: float):
        def delta(time: float, state: np.ndarray) -> float:
            return state[0] - state[1]

        delta.terminal, delta.direction = True, direction
        return delta

    def __call__(
        self, engaged: bool, frequency: float, start: float, state: np.ndarray, end: float, samples: np.ndarray
    ) -> tuple[float, np.ndarray, np.ndarray]:
        """See `problem.Advance`."""
        rate = self._rates[engaged]

        def right_side(time: float, x: np.ndarray) -> np.ndarray:
            out = np.empty(4)
            rate(time, x, frequency, out)
            return out

        solution = solve_ivp(
            right_side,
            (start, end),
            state,
            method=self._method,
            t_eval=np.append(samples, end),
            events=self._switches[engaged],
            rtol=RELATIVE_TOLERANCE[self._method],
            atol=RELATIVE_TOLERANCE[self._method] * ABSOLUTE_TO_RELATIVE,
        )
        if not solution.success:
            raise RuntimeError(f"{self._method} stopped at {solution.t}: {solution.message}")
        if len(solution.t) == 0:  # the clutch switched before the first output time
            return solution.t_events[0][0], solution.y_events[0][0], problem.NO_SAMPLES
        deltas = solution.y[0] - solution.y[1]
        if solution.status == 1:
            return solution.t_events[0][0], solution.y_events[0][0], deltas[: len(samples)]
        return end, solution.y[:, -1].copy(), deltas[:-1]


def main() -> None:
    """Run the tasks and print one JSON line for each."""
    for method, tolerance in RELATIVE_TOLERANCE.items():
        note = (
            f"{method}, rtol {tolerance:g}, atol {tolerance * ABSOLUTE_TO_RELATIVE:g}; right-hand side "
            "compiled with Numba, but one Python call-back for each evaluation, and the stepping is Python"
        )
        peer_cli.run(f"scipy-{method}", scipy.__version__, lambda method=method: ScipyAdvance("A", method), note)


if __name__ == "__main__":
    main()
