"""Right-hand side for the peers that call back into Python, compiled to machine code with Numba."""

from collections.abc import Callable

import problem  # before NumPy: it restricts the numerics to one thread

import numpy as np
from numba import njit


Rate = Callable[[float, np.ndarray, float, np.ndarray], None]


def make_rate(engaged: bool, case: str) -> Rate:
    """Return ``rate(time, state, frequency, out)``, which writes x' of one regime into ``out``."""
    matrix, load, force = problem.state_matrix(engaged), problem.constant_load(), problem.forcing(case)

    @njit(fastmath=False)
    def rate(time: float, state: np.ndarray, frequency: float, out: np.ndarray) -> None:
        out[0] = state[2]
        out[1] = state[3]
        for i in (2, 3):
            out[i] = load[i]
            for j in range(4):
                out[i] += matrix[i, j] * state[j]
        out[2] += force * np.cos(frequency * time)

    return rate
