"""Frequencies of one hanging cable to twelve digits and more, by means that no code under test uses.

Statics: the elastic catenary in elementary functions, solved with 40 digits. Vibration: Newton's and Hooke's laws
for small motion u(s) about it, as initial-value problems in extended precision (64-bit mantissa),

    u' = N / EA + (1 - t t^T) N / T,   N' = -mu omega^2 u,

integrated by the Gragg-Bulirsch-Stoer method from one end; omega where a force at this end exists that leaves the
other end at rest. The search begins at the finite elements' frequencies, whose count is certified.
"""

from dataclasses import dataclass

import numpy as np

import cdpr_struct.fem_reference as fem
from benchmarks.held_cable import GRAVITY, HeldCable

_SEGMENTS, _ROWS, _STEPS = 36, 8, 12
_MESH = 200


@dataclass(frozen=True, eq=False)
class Catenary:
    """H, V_start [N] of the cable at rest: tension vector (H, V_start + w s) at the unstrained length s."""

    horizontal: np.longdouble
    vertical_at_start: np.longdouble
    weight: np.longdouble

    def tangent(self, s: np.longdouble) -> tuple[np.ndarray, np.longdouble]:
        """Unit vector (2,) and tension [N]."""
        pull = np.array([self.horizontal, self.vertical_at_start + self.weight * s])
        tension = np.sqrt(pull @ pull)
        return pull / tension, tension


def catenary(cable: HeldCable) -> Catenary:
    """Statics of a cable in the plane y = 0."""
    import mpmath as mp

    with mp.workdps(40):
        offset = cable.end - cable.start
        length, stiff = mp.mpf(cable.unstrained_length), mp.mpf(cable.axial_stiffness)
        weight = mp.mpf(cable.linear_density) * mp.mpf(GRAVITY)

        def miss(h, v):  # type: ignore[no-untyped-def]
            top = v + weight * length
            x = h * length / stiff + h / weight * (mp.asinh(top / h) - mp.asinh(v / h))
            z = (v * length + weight * length**2 / 2) / stiff + (mp.hypot(h, top) - mp.hypot(h, v)) / weight
            return [x - mp.mpf(float(offset[0])), z - mp.mpf(float(offset[2]))]

        rest = fem.solve_cable(
            fem.CableData(cable.unstrained_length, cable.axial_stiffness, cable.linear_density),
            cable.start, cable.end, _MESH, (0.0, 0.0, -GRAVITY),
        )  # fmt: skip
        found = mp.findroot(miss, (-rest.start_force[0], -rest.start_force[2]))
        return Catenary(*(np.longdouble(mp.nstr(value, 30)) for value in (found[0], found[1], weight)))


def exact_frequencies(cable: HeldCable, count: int) -> tuple[np.ndarray, np.ndarray]:
    """First `count` frequencies in the plane the cable hangs in, and across it [Hz]."""
    rest = fem.solve_cable(
        fem.CableData(cable.unstrained_length, cable.axial_stiffness, cable.linear_density),
        cable.start, cable.end, _MESH, (0.0, 0.0, -GRAVITY),
    )  # fmt: skip
    modes = fem.cable_modes(rest, 2 * count + 2)
    inside = modes.in_plane_share > 0.5
    shape, found = catenary(cable), []
    for mask, planar in ((inside, True), (~inside, False)):
        near = 2.0 * np.pi * modes.frequencies_hz[mask][:count].astype(np.longdouble)
        found.append((_roots(cable, shape, near, planar) / (2.0 * np.pi)).astype(float))
    return found[0], found[1]


def _roots(cable: HeldCable, shape: Catenary, omega: np.ndarray, planar: bool) -> np.ndarray:
    """Secant steps on all roots at once."""
    before = omega * (1 + np.longdouble(1e-7))
    last = _end_motion(cable, shape, before, planar)
    for _ in range(_STEPS):
        value = _end_motion(cable, shape, omega, planar)
        moved = value != last
        step = np.where(moved, value * (omega - before) / np.where(moved, value - last, 1), 0)
        before, last, omega = omega, value, omega - step
        if (np.abs(step) < 1e-16 * omega).all():
            break
    return omega


def _end_motion(cable: HeldCable, shape: Catenary, omega: np.ndarray, planar: bool) -> np.ndarray:
    """(k,) determinant of the end's motion per force at the start, with the start at rest."""
    size = 2 if planar else 1
    state = np.zeros((len(omega), 2 * size, size), dtype=np.longdouble)
    state[:, size:] = np.eye(size)
    step = np.longdouble(cable.unstrained_length) / _SEGMENTS
    for segment in range(_SEGMENTS):
        state = _segment(cable, shape, omega, segment * step, step, state)
    motion = state[:, :size]
    return motion[:, 0, 0] if size == 1 else motion[:, 0, 0] * motion[:, 1, 1] - motion[:, 0, 1] * motion[:, 1, 0]


def _segment(
    cable: HeldCable, shape: Catenary, omega: np.ndarray, start: np.longdouble, step: np.longdouble, state: np.ndarray
) -> np.ndarray:
    """Gragg's midpoint rule with 2, 4, .. substeps, extrapolated in the square of the substep (Aitken, Neville)."""
    last: list[np.ndarray] = []
    for row in range(1, _ROWS + 1):
        count = 2 * row
        h = step / count
        slow, fast = state, state + h * _rate(cable, shape, omega, start, state)
        for i in range(1, count):
            slow, fast = fast, slow + 2 * h * _rate(cable, shape, omega, start + i * h, fast)
        better = [(slow + fast + h * _rate(cable, shape, omega, start + step, fast)) / 2]
        for back, old in enumerate(last, start=1):
            ratio = np.longdouble(row) / np.longdouble(row - back)
            better.append(better[-1] + (better[-1] - old) / (ratio**2 - 1))
        last = better
    return last[-1]


def _rate(cable: HeldCable, shape: Catenary, omega: np.ndarray, s: np.longdouble, state: np.ndarray) -> np.ndarray:
    size = state.shape[1] // 2
    tangent, tension = shape.tangent(s)
    across = np.eye(2, dtype=np.longdouble) - np.outer(tangent, tangent) if size == 2 else np.eye(1)
    give = np.eye(size) / np.longdouble(cable.axial_stiffness) + across / tension
    inertia = -np.longdouble(cable.linear_density) * omega**2
    return np.concatenate([np.matmul(give, state[:, size:]), inertia[:, None, None] * state[:, :size]], axis=1)
