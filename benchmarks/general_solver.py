"""The force distribution of chapter 5 by general nonlinear solvers: what the package's own solver is measured against.

The thesis's formulation, pose by pose: unknowns fx, fz and unstrained length of every cable, equality constraints
(5.1)-(5.7), bounds (5.8)-(5.9), all with exact first derivatives. Nothing here uses the package's distribution code;
the catenary's end point and compliance come from the generated closed forms.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from cdpr_struct.generated.cable_compliance import compliance
from cdpr_struct.generated.catenary import end_point


@dataclass(frozen=True)
class PoseProblem:
    """One pose.

    span, rise : (m,) horizontal and vertical distance from frame anchor to platform anchor [m]
    heading    : (m, 2) horizontal unit vectors;  arms : (m, 3) lever arms, world [m]
    load       : (6,) weight, inertia and external wrench [N, N m]
    low        : (m,) lower bound [N], or what it is times the unstrained length [N/m] if `per_length`
    """

    span: np.ndarray
    rise: np.ndarray
    heading: np.ndarray
    arms: np.ndarray
    load: np.ndarray
    low: np.ndarray
    high: np.ndarray
    axial_stiffness: np.ndarray
    weight: np.ndarray
    per_length: bool = False
    power: float = 2.0

    @classmethod
    def at(cls, robot, position, load, low, high=1e5, per_length=False, power=2.0):
        """Pose of a platform that is not turned."""
        offset = position + robot.platform_anchors - robot.frame_anchors
        span = np.hypot(offset[:, 0], offset[:, 1])
        m = len(span)
        return cls(
            span, offset[:, 2], offset[:, :2] / span[:, None], robot.platform_anchors, load,
            np.broadcast_to(low, m), np.broadcast_to(high, m), robot.axial_stiffness, robot.weight_per_length,
            per_length, power,
        )  # fmt: skip

    @property
    def count(self) -> int:
        return len(self.span)

    def split(self, x):
        m = self.count
        return x[:m] * SCALE, x[m : 2 * m] * SCALE, x[2 * m :]

    def cost(self, x):
        fx, fz, _ = self.split(x)
        tension = np.hypot(fx, fz) / SCALE
        p = self.power
        slope = tension ** (p - 2.0)
        return (tension**p).sum() / p, np.concatenate([slope * fx, slope * fz, np.zeros(self.count)]) / SCALE

    def equalities(self, x):
        """End points (2 m) [m] and balance (6) over SCALE."""
        fx, fz, length = self.split(x)
        reached_x, reached_z = end_point(fx, fz, length, self.axial_stiffness, self.weight)
        forces = self._forces(fx, fz)
        wrench = np.concatenate([forces.sum(axis=0), np.cross(self.arms, forces).sum(axis=0)]) + self.load
        return np.concatenate([reached_x - self.span, reached_z - self.rise, wrench / SCALE])

    def equalities_jacobian(self, x):
        fx, fz, length = self.split(x)
        m = self.count
        axial, xx, xz, zz = compliance(fx, fz, length, self.axial_stiffness, self.weight)
        bottom = fz - self.weight * length
        stretch = 1.0 / self.axial_stiffness + 1.0 / np.hypot(fx, bottom)
        diagonal = [
            ((axial + xx) * SCALE, xz * SCALE, fx * stretch),
            (xz * SCALE, (axial + zz) * SCALE, bottom * stretch),
        ]
        top = np.block([[np.diag(entry) for entry in row] for row in diagonal])
        along, up = self._forces(np.ones(m), np.zeros(m)), self._forces(np.zeros(m), np.ones(m))
        columns = [np.concatenate([f, np.cross(self.arms, f)], axis=1).T for f in (along, up)]
        return np.vstack([top, np.hstack([*columns, np.zeros((6, m))])])

    def inequalities(self, x):
        fx, fz, length = self.split(x)
        tension = np.hypot(fx, fz)
        low = self.low * length if self.per_length else self.low
        return np.concatenate([tension - low, self.high - tension]) / SCALE

    def inequalities_jacobian(self, x):
        fx, fz, _ = self.split(x)
        tension = np.hypot(fx, fz)
        rates = np.hstack([np.diag(fx / tension), np.diag(fz / tension)])
        length_rate = np.diag(-self.low / SCALE) if self.per_length else np.zeros((self.count, self.count))
        return np.vstack([np.hstack([rates, length_rate]), np.hstack([-rates, np.zeros((self.count, self.count))])])

    def straight_start(self):
        """Straight cables at a moderate tension."""
        chord = np.hypot(self.span, self.rise)
        low = self.low * chord if self.per_length else self.low
        tension = np.maximum(np.linalg.norm(self.load[:3]), 1.5 * low)
        return np.concatenate([tension * self.span / chord / SCALE, tension * self.rise / chord / SCALE, chord])

    def tensions(self, x):
        fx, fz, _ = self.split(x)
        return np.hypot(fx, fz)

    def _forces(self, fx, fz):
        return np.concatenate([-fx[:, None] * self.heading, -fz[:, None]], axis=1)


SCALE = 1000.0
"""[N] forces are divided by this before a general solver sees them."""


def slsqp(problem: PoseProblem, start=None, tolerance=1e-15):
    """Solution by sequential least squares; returns (x, converged)."""
    constraints = [
        {"type": "eq", "fun": problem.equalities, "jac": problem.equalities_jacobian},
        {"type": "ineq", "fun": problem.inequalities, "jac": problem.inequalities_jacobian},
    ]
    found = minimize(
        problem.cost, problem.straight_start() if start is None else start, jac=True, method="SLSQP",
        constraints=constraints, options={"ftol": tolerance, "maxiter": 300},
    )  # fmt: skip
    return found.x, bool(np.abs(problem.equalities(found.x)).max() < 1e-9)


def trust_constr(problem: PoseProblem, start=None):
    """Solution by the trust-region interior-point method."""
    from scipy.optimize import NonlinearConstraint

    constraints = [
        NonlinearConstraint(problem.equalities, 0.0, 0.0, jac=problem.equalities_jacobian),
        NonlinearConstraint(problem.inequalities, 0.0, np.inf, jac=problem.inequalities_jacobian),
    ]
    found = minimize(
        problem.cost, problem.straight_start() if start is None else start, jac=True, method="trust-constr",
        constraints=constraints, options={"gtol": 1e-12, "xtol": 1e-14, "barrier_tol": 1e-14, "maxiter": 3000},
    )  # fmt: skip
    return found.x, bool(np.abs(problem.equalities(found.x)).max() < 1e-8)
