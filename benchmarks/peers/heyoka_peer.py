"""heyoka: Taylor integration with just-in-time compiled code and terminal events; tasks (b) and (c)."""

import problem  # before NumPy: it restricts the numerics to one thread

import heyoka as hy
import numpy as np

import peer_cli

# Output times handed over in one call (two periods). heyoka allocates the whole grid at each call, so a longer grid is
# paid for again at each event; this length was the fastest measured.
GRID_LENGTH = 2 * problem.SAMPLES_PER_PERIOD


class HeyokaAdvance:
    """One compiled integrator per regime, stopped by the clutch crossing that ends the regime."""

    def __init__(self, case: str) -> None:
        self._integrators = {}
        for engaged in (True, False):
            integrator = self._compile(engaged, case)
            # The arrays are views of the integrator's memory: fetched once, written before each propagation.
            self._integrators[engaged] = integrator, integrator.state, integrator.pars

    @staticmethod
    def _compile(engaged: bool, case: str) -> hy.taylor_adaptive:
        variables = hy.make_vars("theta_p", "theta_a", "rate_p", "rate_a")
        force = problem.forcing(case) * hy.cos(hy.par[0] * hy.time)
        right_side = []
        for i, (row, load) in enumerate(zip(problem.state_matrix(engaged), problem.constant_load())):
            terms = [float(a) * x for a, x in zip(row, variables) if a != 0.0]
            if i == 2:
                terms.append(force)
            right_side.append(hy.sum(terms) + float(load))
        direction = hy.event_direction.negative if engaged else hy.event_direction.positive
        switch = hy.t_event(variables[0] - variables[1], direction=direction)
        return hy.taylor_adaptive(list(zip(variables, right_side)), [0.0] * 4, t_events=[switch], pars=[1.0])

    def __call__(
        self, engaged: bool, frequency: float, start: float, state: np.ndarray, end: float, samples: np.ndarray
    ) -> tuple[float, np.ndarray, np.ndarray]:
        """See `problem.Advance`."""
        integrator, current, parameters = self._integrators[engaged]
        integrator.reset_cooldowns()  # a cool-down left by the previous visit must not hide an event
        integrator.time = start
        parameters[0] = frequency
        current[:] = state
        deltas = problem.NO_SAMPLES
        for first in range(0, len(samples), GRID_LENGTH):
            grid = np.concatenate([[integrator.time], samples[first : first + GRID_LENGTH]])
            outcome, *_, states = integrator.propagate_grid(grid)
            deltas = np.concatenate([deltas, states[1:, 0] - states[1:, 1]])
            if outcome != hy.taylor_outcome.time_limit:
                return integrator.time, current.copy(), deltas
        outcome = integrator.propagate_until(end)[0]
        reached = end if outcome == hy.taylor_outcome.time_limit else integrator.time
        return reached, current.copy(), deltas


def main() -> None:
    """Run the tasks and print one JSON line for each."""
    note = "Taylor method at machine precision, LLVM code; one Python round trip per clutch event"
    peer_cli.run("heyoka", hy.__version__, lambda: HeyokaAdvance("A"), note, slow=False)


if __name__ == "__main__":
    main()
