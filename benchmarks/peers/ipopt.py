"""IPOPT, as CasADi's wheel brings it: the force distribution of `general_solver` with CasADi's own derivatives."""

from typing import Any

import numpy as np

from benchmarks.general_solver import SCALE, PoseProblem
from benchmarks.peers import load

_OPTIONS = {
    "print_time": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-10,
    "ipopt.mu_init": 1e-4,
    "ipopt.warm_start_init_point": "yes",
}


class Distribution:
    """The same problem for every pose of a robot: built once, its poses are parameters."""

    def __init__(self, like: PoseProblem) -> None:
        """like : any pose; number of cables, kind of bound and cable data are taken from it."""
        casadi: Any = load("CasADi")
        m = like.count
        x, p = casadi.SX.sym("x", 3 * m), casadi.SX.sym("p", 8 * m + 6)
        fx, fz, length = SCALE * x[:m], SCALE * x[m : 2 * m], x[2 * m :]
        span, rise = p[:m], p[m : 2 * m]
        heading, arms = casadi.reshape(p[2 * m : 4 * m], m, 2), casadi.reshape(p[4 * m : 7 * m], m, 3)
        low, load_ = p[7 * m : 8 * m], p[8 * m :]
        weight, stiff = like.weight, like.axial_stiffness
        foot = fz - weight * length
        reached_x = fx * length / stiff + fx / weight * (casadi.asinh(fz / fx) - casadi.asinh(foot / fx))
        reached_z = (fz - weight * length / 2) * length / stiff
        reached_z += (casadi.sqrt(fx**2 + fz**2) - casadi.sqrt(fx**2 + foot**2)) / weight
        force = casadi.horzcat(-fx * heading[:, 0], -fx * heading[:, 1], -fz)
        moment = casadi.vertcat(*[casadi.cross(arms[i, :].T, force[i, :].T).T for i in range(m)])
        wrench = casadi.vertcat(casadi.sum1(force).T, casadi.sum1(moment).T) + load_
        tension = casadi.sqrt(fx**2 + fz**2)
        bound = low * length if like.per_length else low
        limits = casadi.vertcat(tension - bound, like.high - tension) / SCALE
        equal = casadi.vertcat(reached_x - span, reached_z - rise, wrench / SCALE)
        cost = casadi.sumsqr(tension / SCALE) / 2
        problem = {"x": x, "p": p, "f": cost, "g": casadi.vertcat(equal, limits)}
        self._solver = casadi.nlpsol("distribution", "ipopt", problem, _OPTIONS)
        self._upper = np.r_[np.zeros(2 * m + 6), np.full(2 * m, np.inf)]

    def solve(self, problem: PoseProblem, start: np.ndarray) -> np.ndarray:
        """x of `PoseProblem.split`, from a start."""
        flat = [problem.heading.ravel(order="F"), problem.arms.ravel(order="F"), problem.low, problem.load]
        given = np.concatenate([problem.span, problem.rise, *flat])
        found = self._solver(x0=start, p=given, lbg=0.0, ubg=self._upper)
        return np.asarray(found["x"]).ravel()
