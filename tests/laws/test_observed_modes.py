"""Modes in measured states: rates of their frequencies are derivatives of the full computation, for everything."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import StaticCables, cable_dynamics, expand_catenaries_at, polynomial_order
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.observation.cable_modes import CableRows, cable_modes_at, cable_rates
from cdpr_struct.observation.robot_modes import changes_of, log_changes, modes_at, of_states_apart
from cdpr_struct.robot.parameters import PARAMETERS
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.equilibrium import PlatformArms, rotation_from_vector
from cdpr_struct.statics.inverse_kinematics import inverse

IDLE = {
    "force_min", "force_max", "damping_ratio", "length_offset", "length_scale", "hose_center", "force", "nonlinearity",
    "stiffening_exponent", "reference_tension", "cell_gain", "cell_bias", "friction", "bearing_friction",
    "pulley_drag", "backlash", "tracker", "creep", "slip",
    "accelerometer_gain", "sensor_mass", "swivel_zero",
}  # fmt: skip
"""Parameters that act on readings or on the state, not on the vibration about it; and what a winch holds, a switch."""
STEPS = {
    "axial_stiffness": 30.0, "mass": 1e-3, "series_compliance": 2e-10, "frame_compliance": 2e-11, "hose": 1e-2,
    "linear_density": 2e-7, "bending_stiffness": 1e-4, "added_mass": 3e-6, "gravity": 1e-4, "inertia": 1e-5,
    "tilt": 1e-4, "mast_bending": 2e-11,
}  # fmt: skip
STEP = 1e-6  # m, or the unit of what is not named: a millionth, so that close modes do not veer
TENSION_STEP = 1e-3  # N
NOISE = 4e-12  # rounding of ln omega, a few differences summed: up to 3e-12 with some processors' BLAS kernels


VIBRATING = {"added_mass", "added_mass_place", "bending_stiffness", "bending_fixity"}
"""Of cables with mass only."""


def rates(modes, points, steps):
    """(B, F, M) rates of ln f towards nearby states after steps (B,)."""
    return log_changes(modes, changes_of(modes, points) / steps[:, None, None])


@dataclass(frozen=True)
class State:
    """A state by its readings; leading axes are a batch."""

    arrays: RobotArrays
    position: np.ndarray
    rotation: np.ndarray
    tension: np.ndarray

    def point(self, model: str = "sagging") -> OperatingPoint:
        arms = PlatformArms.at(self.arrays, self.position, self.rotation)
        cables = cable_model(model).hold(self.arrays, arms.points, self.tension).states
        return OperatingPoint(self.arrays, self.position, self.rotation, cables)

    def moved(self, name: str, step: np.ndarray) -> "State":
        """A batch of states with one reading or parameter changed by steps (d,)."""
        d = len(step)
        batch = State(
            self.arrays, np.stack([self.position] * d), np.stack([self.rotation] * d), np.stack([self.tension] * d)
        )
        one = np.zeros((d, 3))
        one[:, 1] = step
        if name == "position":
            return replace(batch, position=batch.position + one)
        if name == "rotation":
            return replace(batch, rotation=rotation_from_vector(one) @ batch.rotation)
        if name == "tension":
            batch.tension[:, 2] += step
            return batch
        value = np.stack([getattr(self.arrays, name)] * d)
        if name == "inertia":
            value[:, [0, 1], [1, 0]] += step[:, None]
        elif name in ("frame_compliance", "mast_bending"):
            value += step[:, None] * self.arrays.masts[2]
        else:
            value[(slice(None), *((2,) if value.shape[1:2] == (len(self.tension),) else ()), *([1] * _rest(name)))] += (
                step
            )
        return replace(batch, arrays=replace(self.arrays, **{name: value}))


def _rest(name: str) -> int:
    return PARAMETERS[name].axes - (PARAMETERS[name].shape[:1] == ("m",))


def state_of(name: str, **more: float | np.ndarray) -> State:
    """A pose off the middle; extensions alike for all cables."""
    robot = load_robot(name)
    arrays, m = RobotArrays.of(robot), len(robot.cables)
    turn = rotation_from_vector(np.array([0.02, 0.03, -0.05])) @ robot.home.rotation
    place = robot.home.position + np.array([0.3, -0.2, 0.1])
    tension = inverse(robot, place, turn).tensions
    each = {n: np.full(m, value) if PARAMETERS[n].shape == ("m",) else np.asarray(value) for n, value in more.items()}
    return State(replace(arrays, **each), place, turn, tension)


def single(state: State) -> OperatingPoint:
    """As a batch of one state."""
    everywhere = State(state.arrays, state.position[None], state.rotation[None], state.tension[None])
    return everywhere.point()


EXTENDED = {
    "pulley_radius": 0.05, "series_compliance": 5e-7, "frame_compliance": 3e-7, "mast_bending": 4e-7,
    "bending_stiffness": 2.0, "bending_fixity": 0.7, "added_mass": 0.02, "added_mass_place": 0.3, "hose": 500.0,
    "center_of_mass": np.array([0.05, -0.02, 0.08]),
}  # fmt: skip
INTERNAL = {
    "internal_mass": 5.0, "internal_frequency": 6.0, "internal_direction": np.array([0.0, 0.6, 0.8]),
    "center_of_mass": np.array([0.05, -0.02, 0.08]),
}  # fmt: skip
SWINGING = {
    "swinging_mass": 12.0, "swinging_frequency": 0.9, "swinging_place": np.array([0.1, -0.05, -0.2]),
    "center_of_mass": np.array([0.05, -0.02, 0.08]),
}  # fmt: skip
STATES: dict[str, Callable[[], State]] = {
    "six cables": lambda: state_of("six-cable-4mm"),
    "everything gives way": lambda: state_of("thesis-3-1", **EXTENDED),
    "cogiro on pulleys": lambda: state_of("cogiro", pulley_radius=0.05),
    "a tool on a mount": lambda: state_of("cogiro", **INTERNAL),
    "a swinging payload": lambda: state_of("cogiro", **SWINGING),
}
READINGS = ("position", "rotation", "tension")
AS_ENTERED = (
    "masts",
    "uprights",
    "mast_foot",
    "down",
    "guided",
    "winch_tension",
    "drag_width",
    "lump_place",
    "lump_mass",
)
ACTING = tuple(n for n in PARAMETERS if n not in IDLE and n not in AS_ENTERED)  # what a diagnosis may change


def derivative(state: State, name: str, log_omega: Callable[[OperatingPoint], np.ndarray]) -> tuple[np.ndarray, float]:
    """d ln omega / d(name), by central differences, or forward ones from where a parameter cannot be less."""
    step = TENSION_STEP if name == "tension" else STEPS.get(name, STEP)
    at_bound = name in PARAMETERS and PARAMETERS[name].least == 0.0 and not np.any(getattr(state.arrays, name))
    nodes, factors = ([1, 2, 3], [-2.5, 4.0, -1.5]) if at_bound else ([-2, -1, 1, 2], [1 / 12, -2 / 3, 2 / 3, -1 / 12])
    values = log_omega(state.moved(name, step * np.array(nodes, dtype=float)).point())
    return np.tensordot(factors, values, axes=(0, 0)) / step, step


def nearby(state: State, name: str, step: float) -> OperatingPoint:
    """(1, 1) the state after a small part of a step of the differences."""
    point = state.moved(name, np.array([1e-2 * step])).point()
    batched = {
        f.name: getattr(point.arrays, f.name)[None]
        for f in fields(RobotArrays)
        if getattr(point.arrays, f.name).ndim > PARAMETERS[f.name].axes
    }
    cables = point.cables.at(None)
    return OperatingPoint(replace(point.arrays, **batched), point.position[None], point.rotation[None], cables)


@pytest.mark.parametrize("case", STATES)
def test_rates_of_robot_modes_are_derivatives_of_the_full_computation(case):
    state = STATES[case]()
    point = single(state)
    highest = 2.3 * first_string(point)
    modes = modes_at(point, np.array([highest]))
    count = int((modes.mask[0] & (modes.log_hertz[0] < np.log(highest / (2.0 * np.pi)))).sum())
    order = polynomial_order(point, 1.3 * highest, rough="everything" not in case)

    def log_omega(points: OperatingPoint) -> np.ndarray:
        return np.log(ritz_modes(points, expand_catenaries_at(points, order).reduced(1.3 * highest), count).omega)

    for name in READINGS + tuple(n for n in ACTING if n not in skipped(state)):
        expected, step = derivative(state, name, log_omega)
        found = rates(modes, nearby(state, name, step), np.array([1e-2 * step]))[0, 0, :count]
        atol = 1e-4 * np.abs(expected).max() + NOISE / step
        np.testing.assert_allclose(found, expected, rtol=0, atol=atol, err_msg=name)


def skipped(state: State) -> set[str]:
    """Frequencies go with the root of EI where it is zero; axes of pulleys without a wheel and tilt do nothing here."""
    arrays = state.arrays
    none = set() if arrays.bending_stiffness.any() else {"bending_stiffness", "bending_fixity"}
    none |= set() if arrays.added_mass.any() else {"added_mass_place"}
    none |= set() if arrays.has_pulleys else {"pulley_axis", "pulley_radius"}
    none |= set() if arrays.has_internal_mass else {"internal_mass", "internal_frequency", "internal_direction"}
    swinging = {"swinging_mass", "swinging_frequency", "swinging_place"}
    none |= set() if arrays.has_swinging_mass else swinging
    return none | (set() if arrays.center_of_mass.any() else {"tilt"})


def first_string(point: OperatingPoint) -> float:
    """[rad/s], of the cable that swings slowest."""
    return float((np.pi / point.cables.chord * np.sqrt(point.cables.tension / point.arrays.linear_density)).min())


@pytest.mark.parametrize("assembly", ["consistent", "thesis"])
@pytest.mark.parametrize(
    ("case", "count"),
    [("six cables", 6), ("everything gives way", 6), ("a tool on a mount", 7), ("a swinging payload", 8)],
)
def test_rates_on_massless_cables_are_derivatives_too(case, count, assembly):
    state = STATES[case]()
    modes = modes_at(single(state), np.array([1.0]), assembly, "static")
    assert modes.mask.sum() == count

    def log_omega(points: OperatingPoint) -> np.ndarray:
        return np.log(ritz_modes(points, StaticCables(points).expansion(0.0), count, assembly).omega)

    for name in READINGS + tuple(n for n in ACTING if n not in skipped(state) | VIBRATING):
        expected, step = derivative(state, name, log_omega)
        found = rates(modes, nearby(state, name, step), np.array([1e-2 * step]))[0, 0]
        atol = 1e-4 * np.abs(expected).max() + NOISE / step
        np.testing.assert_allclose(found, expected, rtol=0, atol=atol, err_msg=name)


@pytest.mark.parametrize("case", STATES)
def test_rates_of_cable_modes_are_derivatives_of_the_full_computation(case):
    state = STATES[case]()
    m = len(state.tension)
    cable, mode, in_plane = (a.ravel() for a in np.meshgrid(np.arange(m), [1, 2, 3], [False, True], indexing="ij"))
    rows = CableRows(np.zeros(len(cable), dtype=int), cable, mode, in_plane)
    modes = cable_modes_at(single(state), rows)

    def log_omega(points: OperatingPoint) -> np.ndarray:
        several = [replace(rows, state=np.full(len(cable), i)) for i in range(len(points.position))]
        return np.stack([cable_modes_at(points, each).log_hertz for each in several])

    for name in READINGS + tuple(n for n in ACTING if n not in skipped(state)):
        expected, step = derivative(state, name, log_omega)
        found = cable_rates(modes, nearby(state, name, step), np.array([1e-2 * step]))[0]
        atol = 1e-4 * np.abs(expected).max() + NOISE / step
        np.testing.assert_allclose(found, expected, rtol=0, atol=atol, err_msg=name)


@pytest.mark.parametrize("name", sorted(IDLE))
def test_what_acts_on_readings_only_changes_no_frequency(name):
    state = STATES["six cables"]()
    modes = modes_at(single(state), np.array([120.0]))
    point = single(state)
    other = replace(point.arrays, **{name: getattr(point.arrays, name) + 0.01})
    there = OperatingPoint(other, point.position[None], point.rotation[None], point.cables.at(None))
    assert not rates(modes, there, np.ones(1)).any()


@pytest.mark.parametrize("case", STATES)
def test_no_mode_below_the_band_limit_is_missing(case):
    state = STATES[case]()
    highest = 2.3 * first_string(single(state))
    modes = modes_at(single(state), np.array([highest]))
    alone = state.point()
    cables = cable_dynamics(alone, "exact", highest)
    counted = int(count_below(alone, cables, np.array([highest]))[0])
    assert (modes.mask & (np.exp(modes.log_hertz) * 2.0 * np.pi < highest)).sum() == counted
    assert (modes.share[modes.mask] > 0.0).all()


def test_cable_modes_of_one_plane_are_the_clamped_cables_own():
    """Taut weightless string: n c / 2 l out of plane and in plane."""
    state = STATES["six cables"]()
    point = state.point("spring")
    batch = OperatingPoint(point.arrays, point.position[None], point.rotation[None], point.cables.at(None))
    rows = CableRows(*(np.array(a) for a in ([0, 0, 0], [1, 1, 4], [1, 2, 3], [False, True, True])))
    chord, tension = point.cables.chord[rows.cable], point.cables.tension[rows.cable]
    stretched = point.arrays.linear_density[rows.cable] / (1.0 + tension / point.arrays.axial_stiffness[rows.cable])
    expected = rows.mode / (2.0 * chord) * np.sqrt(tension / stretched)
    np.testing.assert_allclose(np.exp(cable_modes_at(batch, rows).log_hertz), expected, rtol=1e-9)


def test_modes_that_symmetry_makes_equal_share_the_rate_of_their_mean():
    """Four-fold symmetry about the vertical: pairs of equal frequencies, which EA of one cable splits."""
    state = symmetric()
    modes = modes_at(single(state), np.array([200.0]))
    log = modes.log_hertz[0][modes.mask[0]]
    pairs = np.flatnonzero(np.diff(log) < 1e-8)
    assert len(pairs) > 3

    def log_omega(points: OperatingPoint) -> np.ndarray:
        order = polynomial_order(single(state), 260.0, rough=True)
        return np.log(ritz_modes(points, expand_catenaries_at(points, order), len(log)).omega)

    expected, step = derivative(state, "axial_stiffness", log_omega)
    found = rates(modes, nearby(state, "axial_stiffness", step), np.array([1e-2 * step]))[0, 0]
    whole = [i for i in pairs if np.diff(log)[i - 1] > 1e-8 and np.diff(log)[min(i + 1, len(log) - 2)] > 1e-8]
    for i in whole:
        assert found[i] == found[i + 1]
        assert found[i] == pytest.approx(0.5 * (expected[i] + expected[i + 1]), abs=1e-4 * np.abs(expected).max())


def symmetric() -> State:
    arrays = RobotArrays.of(load_robot("thesis-3-1"))
    turn = np.pi / 4.0 + np.pi / 2.0 * np.arange(4)
    ring = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=-1)
    high = np.array([0.0, 0.0, 1.0])
    frame = np.concatenate([4.0 * ring, 4.0 * ring + 3.0 * high])
    platform = np.concatenate([0.3 * ring + 0.3 * high, 0.3 * ring])
    body = {
        "center_of_mass": np.zeros(3),
        "inertia": np.diag([1.0, 1.0, 1.5]),
        "masts": np.eye(8),
        "uprights": 0.5 * np.eye(8),
    }
    arrays = replace(arrays, frame_anchors=frame, platform_anchors=platform, **body)
    return State(arrays, np.array([0.0, 0.0, 1.3]), np.eye(3), np.repeat([500.0, 900.0], 4))


def test_a_state_without_modes_stands_beside_others():
    """Modes state by state are those of the batch; where a state has none, only the others' rates remain."""
    robot = RobotArrays.of(load_robot("thesis-3-1"))
    places = np.array([[0.0, 0.0, 1.0], [0.6, -0.4, 1.2]])
    found = [inverse(robot, place, np.eye(3)) for place in places]
    states = [State(robot, place, np.eye(3), f.tensions) for place, f in zip(places, found, strict=True)]
    both = State(robot, places, np.stack([np.eye(3)] * 2), np.stack([f.tensions for f in found])).point()
    highest = 2.0 * np.pi * np.array([6.0, 9.0])
    batch = modes_at(both, highest)
    alone = [
        modes_at(State(robot, s.position[None], s.rotation[None], s.tension[None]).point(), highest[[k]])
        for k, s in enumerate(states)
    ]
    joined = of_states_apart(alone)
    for k, one in enumerate(alone):
        count = one.mask[0].sum()
        np.testing.assert_array_equal(joined.mask[k, : one.mask.shape[1]], one.mask[0])
        assert joined.mask[k].sum() == count
        np.testing.assert_array_equal(joined.gradient[k, :, : one.mask.shape[1]], one.gradient[0])
    inside = [batch.log_hertz[k][batch.mask[k]] < np.log(highest[k] / (2.0 * np.pi)) for k in range(2)]
    for k in range(2):
        own = joined.log_hertz[k][joined.mask[k]]
        own = own[own < np.log(highest[k] / (2.0 * np.pi))]
        np.testing.assert_allclose(own, batch.log_hertz[k][batch.mask[k]][inside[k]], atol=1e-9)
    half = of_states_apart([None, alone[1]])
    assert not half.mask[0].any()
    assert (rates(half, both, np.ones(1))[:, 0] == 0.0).all()
    with pytest.raises(UnstableEquilibriumError, match="every state"):
        of_states_apart([None, None])
