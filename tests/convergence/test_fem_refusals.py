"""The finite elements take numbers up to their limits, and refuse those beyond with name and value."""

import dataclasses

import numpy as np
import pytest

from cdpr_struct.fem_reference import (
    CableData,
    PlatformData,
    PulleyData,
    RobotData,
    integrate,
    robot_modes,
    solve_robot,
)
from cdpr_struct.fem_reference.arrays import element_count, fixed_array
from cdpr_struct.fem_reference.bar_element import bar_mass
from cdpr_struct.fem_reference.cable_damping import damping_rates
from cdpr_struct.fem_reference.cable_modes import cable_modes, end_dynamic_stiffness
from cdpr_struct.fem_reference.cable_statics import solve_cable
from cdpr_struct.fem_reference.extrapolation import extrapolate
from cdpr_struct.fem_reference.inner_mass import InnerMassData
from cdpr_struct.fem_reference.pendulum import PendulumData
from cdpr_struct.fem_reference.surroundings import SurroundingsData

CABLE, BODY = CableData(5.1, 1e5, 0.05), PlatformData(20.0, np.zeros(3), np.eye(3))
CORNERS = np.array([[x, y, z] for z in (4.0, 0.0) for x, y in ((-3, -2), (-3, 2), (3, -2), (3, 2))], dtype=float)
PLATFORM = 0.1 * CORNERS
PLACE, PULLEY = np.array([0.1, 0.0, 1.6]), PulleyData(0.1, [0.0, 0.0, 1.0])
INFINITE = (np.inf, np.nan)


def robot(**changes):
    chords = np.linalg.norm(PLACE + PLATFORM - CORNERS, axis=1)
    cables = tuple(CableData(chord * (1.0 - 1e-3), 1e5, 0.05) for chord in chords)
    return RobotData(CORNERS, PLATFORM, **({"cables": cables, "platform": BODY} | changes))


def with_each_cable(**changes):
    return tuple(dataclasses.replace(cable, **changes) for cable in robot().cables)


@pytest.fixture(scope="module")
def rest():
    return solve_robot(robot(), PLACE, np.eye(3), 2)


@pytest.fixture(scope="module")
def held():
    return solve_cable(CABLE, [0.0, 0.0, 3.0], [4.0, 0.0, 0.0], 4)


NUMBERS = [  # what is made, field, whether zero is taken
    *(
        (lambda **one: dataclasses.replace(CABLE, **one), name, False)
        for name in ("unstrained_length", "axial_stiffness")
    ),
    (lambda **one: dataclasses.replace(CABLE, **one), "linear_density", False),
    *(
        (lambda **one: dataclasses.replace(CABLE, **one), name, True)
        for name in ("line_give", "winch_tension", "drag_width")
    ),
    (lambda **one: dataclasses.replace(BODY, **one), "mass", False),
    (lambda **one: dataclasses.replace(PULLEY, **one), "radius", False),
    (
        lambda **one: InnerMassData(**({"mass": 1.0, "spring": 1.0, "place": np.zeros(3), "axis": [0, 0, 1]} | one)),
        "mass",
        False,
    ),
    (
        lambda **one: InnerMassData(**({"mass": 1.0, "spring": 1.0, "place": np.zeros(3), "axis": [0, 0, 1]} | one)),
        "spring",
        False,
    ),
    *(
        (lambda **one: PendulumData(**({"mass": 1.0, "length": 1.0, "hook": np.zeros(3)} | one)), name, False)
        for name in ("mass", "length", "axial_stiffness")
    ),
    (lambda **one: SurroundingsData(masts=((0, 1), (2,)), **one), "mast_compliance", True),
    (lambda **one: SurroundingsData(masts=((0, 1), (2,)), **one), "mast_bending", True),
    (lambda **one: SurroundingsData(**one), "tether_stiffness", True),
    (robot, "air_density", True),
]


@pytest.mark.parametrize(
    ("make", "name", "zero"), NUMBERS, ids=[f"{number} {name}" for number, (_, name, _) in enumerate(NUMBERS)]
)
def test_numbers_are_finite_and_positive_or_zero_where_that_means_something(make, name, zero):
    make(**{name: 1e-9})
    for wrong in (-1e-9, np.inf, np.nan, *([] if zero else [0.0])):
        with pytest.raises(ValueError, match=rf"{name} must be .*{wrong!r}"):
            make(**{name: wrong})
    if zero:
        make(**{name: 0.0})


REFUSED = {
    "cables must hold at least one": lambda: robot(cables=()),
    "pulleys must be empty or hold 8 entries, got 7": lambda: robot(pulleys=(None,) * 7),
    "pulleys do not go with masts that bend": lambda: robot(
        pulleys=(PULLEY,) + (None,) * 7, surroundings=SurroundingsData(masts=((0,),), mast_compliance=1e-5)
    ),
    "pulleys do not go with winches": lambda: robot(pulleys=(PULLEY,) * 8, cables=with_each_cable(winch_tension=9.0)),
    "guided must be numbers from 0 to 5": lambda: robot(guided=(6,)),
    "not all six": lambda: robot(guided=range(6)),
    r"frame_anchors must be finite, got np.float64\(nan\) at \(7, 2\)": lambda: RobotData(
        np.where(np.arange(24).reshape(8, 3) == 23, np.nan, CORNERS), PLATFORM, robot().cables, BODY
    ),
    "inertia must be symmetric": lambda: PlatformData(1.0, np.zeros(3), np.eye(3) + np.eye(3, k=1)),
    "inertia must be symmetric and positive": lambda: PlatformData(1.0, np.zeros(3), np.diag([1.0, 0.0, 1.0])),
    "axis must be a unit vector": lambda: PulleyData(0.1, [0.0, 0.0, 1.1]),
    "axis must have length 1": lambda: InnerMassData(1.0, 1.0, np.zeros(3), [0.0, 0.0, 0.9]),
    "2 masts, got": lambda: SurroundingsData(masts=((0, 1), (2,)), mast_compliance=(1e-5,) * 3),
    "name no cable twice": lambda: SurroundingsData(masts=((0, 1), (1,))),
    "exit_mass must be zero or more": lambda: SurroundingsData(exit_mass=(1.0, -1.0)),
    "elements must be an integer of at least 2, got 1": lambda: element_count(1),
    "elements must be an integer of at least 2, got 2.5": lambda: element_count(2.5),
    "must have shape": lambda: fixed_array("x", np.zeros((1, 3)), (3,)),
    "mass must be 'lumped' or 'consistent'": lambda: bar_mass(np.ones(1), "heavy"),
    "three increasing counts": lambda: extrapolate([4, 8], [1.0, 2.0]),
    "increasing counts, got": lambda: extrapolate([4, 8, 8], [1.0, 2.0, 3.0]),
    r"one entry per mesh \(3\), got 2": lambda: extrapolate([4, 8, 16], [1.0, 2.0]),
    "knows no CableData.line_give": lambda: solve_cable(
        dataclasses.replace(CABLE, line_give=1e-6), np.zeros(3), [4.0, 0.0, 0.0], 4
    ),
    "knows no CableData.winch_tension": lambda: solve_cable(
        dataclasses.replace(CABLE, winch_tension=1.0), np.zeros(3), [4.0, 0.0, 0.0], 4
    ),
    "proper rotation": lambda: solve_robot(robot(), PLACE, 1.001 * np.eye(3), 2),
}


@pytest.mark.parametrize(("message", "make"), REFUSED.items(), ids=REFUSED)
def test_what_does_not_fit_together_is_refused(message, make):
    with pytest.raises(ValueError, match=message):
        make()


def test_what_just_fits_together_is_taken():
    robot(pulleys=(None,) * 8, cables=with_each_cable(winch_tension=9.0))
    robot(pulleys=(PULLEY,) * 8)
    robot(guided=range(5))
    robot(surroundings=SurroundingsData(masts=((0, 1), (2,)), mast_compliance=(1e-5, 0.0)))
    assert element_count(2) == 2
    assert fixed_array("x", np.zeros((4, 3)), (None, 3)).shape == (4, 3)
    assert not fixed_array("x", np.zeros(3), (3,)).flags.writeable


def test_counts_of_modes_reach_from_one_to_the_unknowns(held, rest):
    for find, state, unknowns in ((cable_modes, held, 9), (robot_modes, rest, 30)):
        assert [len(find(state, count).frequencies_hz) for count in (1, unknowns)] == [1, unknowns]
        for wrong in (0, unknowns + 1):
            with pytest.raises(ValueError, match=f"count must be between 1 and {unknowns}, got {wrong}"):
                find(state, wrong)


def test_damping_needs_a_frequency_and_ratios_that_fit(held, rest):
    with pytest.raises(ValueError, match="needs reference_omega"):
        end_dynamic_stiffness(held, 3.0, damping_ratio=0.01)
    for wrong in (np.full(7, 0.01), -0.01, np.nan):
        with pytest.raises(ValueError, match="one or 8 numbers of at least 0"):
            damping_rates(rest, wrong)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"guided": (5,)}, "motion of a guided platform"),
        ({"surroundings": SurroundingsData(tether_stiffness=1.0)}, "knows no SurroundingsData"),
        ({"surroundings": SurroundingsData(platform_gravity=[0.0, 0.0, -9.0])}, "knows no SurroundingsData"),
        ({"cables": (*with_each_cable(winch_tension=100.0)[:1], *robot().cables[1:])}, "winches that hold a tension"),
        ({"cables": with_each_cable(lumps=((1.0, 0.01),))}, "knows no masses on cables"),
        ({"cables": with_each_cable(drag_width=0.01), "wind": [5.0, 0.0, 0.0]}, "knows no wind on cables"),
    ],
)
def test_motion_in_time_refuses_what_it_does_not_know(change, message):
    state = solve_robot(robot(**change), PLACE, np.eye(3), 2)
    with pytest.raises(ValueError, match=message):
        integrate(state, 0.1, 0.05, linear=False)


def test_steps_of_time_reach_the_end_and_records_the_last_inner_node(rest):
    assert integrate(rest, 0.1, 0.1).time == pytest.approx([0.0, 0.1])
    assert integrate(rest, 0.1, 0.04).time == pytest.approx([0.0, 0.04, 0.08, 0.12])
    assert integrate(rest, 0.1, 0.1, record=[(7, 1), (0, 1)]).cable_nodes.shape == (2, 2, 3)
    for wrong in ((8, 1), (-1, 1), (0, 0), (0, 2)):
        with pytest.raises(ValueError, match=r"record must hold cables 0 \.\.\. 7, nodes 1 \.\.\. 1, got"):
            integrate(rest, 0.1, 0.1, record=[wrong])
    for duration, step in ((0.1, 0.0), (0.1, 0.2), (np.inf, 0.1)):
        with pytest.raises(ValueError, match="time_step must lie between 0 and duration"):
            integrate(rest, duration, step)
    with pytest.raises(ValueError, match=r"external_wrench\(t\) must have shape \(6,\)"):
        integrate(rest, 0.1, 0.1, external_wrench=lambda time: np.zeros(3))
