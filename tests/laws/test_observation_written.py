"""One forward model: readings that the ordinary commands wrote leave no residual, whatever the robot has."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.parameters import AUXILIARY, EXTENSIONS
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import extended, mast_values, on_pulleys, plan_of, written

ROBOTS = {
    "thesis-3-1": lambda: load_robot("thesis-3-1"),
    "cogiro": lambda: load_robot("cogiro"),
    "pulleys": lambda: on_pulleys("cogiro", 0.05),
}
VARIED = np.array([1.0, 0.4, 0.8, 0.0, 1.3, 0.6, 0.2, 1.1])
HELD = 1e-9  # relative: what the solvers of statics leave


def fields_of(robot) -> dict[str, dict]:
    """Every extension at a size that one would notice, different for every cable."""
    center = robot.home.position + np.array([0.2, -0.1, 0.3])
    return {
        "series_compliance": {"series_compliance": 4e-6 * VARIED},
        "frame_compliance": {"frame_compliance": mast_values(robot, 2e-6 * VARIED)},
        "mast_bending": {"mast_bending": mast_values(robot, 3e-6 * VARIED), "mast_foot": -0.5},
        "mast_mass": {"frame_compliance": mast_values(robot, 2e-6 * VARIED), "mast_mass": 4.0 * VARIED},
        "hose": {"hose": 40.0, "hose_center": center},
        "force": {"force": [8.0, -5.0, 3.0]},
        "moment": {"moment": [1.5, -1.0, 0.8]},
        "drag_area": {"drag_area": 0.4, "wind": [5.0, -3.0, 0.0], "air_density": 1.2},
        "temperature_change": {"temperature_change": 15.0},
        "tilt": {"tilt": [4e-3, -3e-3]},
        "nonlinearity": {"nonlinearity": 0.15, "reference_tension": 400.0},
        "stiffening_exponent": {"stiffening_exponent": 0.2, "reference_tension": 400.0},
        "incremental_ratio": {"incremental_ratio": 1.3},
        "length_offset": {"length_offset": 4e-3 * (VARIED - 0.6)},
        "length_scale": {"length_scale": 1.0 + 2e-3 * (VARIED - 0.6)},
        "bending_stiffness": {"bending_stiffness": 0.5 * VARIED, "bending_fixity": 0.3 + 0.2 * VARIED},
        "added_mass": {"added_mass": 0.02 * VARIED, "added_mass_place": 0.2 + 0.2 * VARIED},
        "cell_gain": {"cell_gain": 1.0 + 0.05 * (VARIED - 0.6)},
        "cell_bias": {"cell_bias": 10.0 * (VARIED - 0.6)},
        "friction": {"friction": 0.05 * VARIED},
        "bearing_friction": {"bearing_friction": 0.04 * VARIED},
        "pulley_drag": {"pulley_drag": 3.0 * VARIED},
        "backlash": {"backlash": 3e-3 * VARIED},
        "tracker": {"tracker": [3e-3, -2e-3, 1e-3, 2e-3, -3e-3, 4e-3]},
        "creep": {"creep": 0.1},
        "slip": {"slip": 2e-3 * (VARIED - 0.6)},
        "accelerometer_gain": {"accelerometer_gain": [1.1, 0.9, 1.0, 1.0, 1.2, 1.0]},
        "sensor_mass": {"sensor_mass": 1.5},
        "internal_mass": {
            "internal_mass": 0.05 * robot.platform.mass, "internal_frequency": 7.0,
            "internal_direction": [0.6, 0.0, 0.8],
        },
        "swinging_mass": {
            "swinging_mass": 0.05 * robot.platform.mass, "swinging_frequency": 1.1,
            "swinging_place": [0.05, -0.02, -0.1],
        },
    }  # fmt: skip


def all_together(robot) -> dict:
    return {key: value for own in fields_of(robot).values() for key, value in own.items()}


ROUNDING = 2e-9  # of f: the certified frequencies are the middles of brackets of this width
LAYERS = 2e-8  # of f: clamped ends of stiff cables ask more of the polynomials than the first modes are given
KINK = 1e-4  # of f: polynomials meet the kink at a point mass to first order only, in `modes` as in the diagnosis
LOADS = (5.0,)
OF_READINGS = (
    "length_offset",
    "length_scale",
    "cell_gain",
    "cell_bias",
    "friction",
    "bearing_friction",
    "pulley_drag",
    "backlash",
    "tracker",
    "slip",
    "accelerometer_gain",
)
CLOCKS = ("encoder_delay", "cell_delay", "clock_drift")
ELSEWHERE = ("sensor_mass", "drag_width", "swivel_zero", *CLOCKS)
ALONE = [name for name in EXTENSIONS if name not in (*AUXILIARY, *ELSEWHERE)]
"""Wind on cables is refused; delays need states in motion, see `test_sensor_delay.py`; for swivels
see `test_swivel_angles.py`."""


def seen(campaign) -> Local:
    """The campaign about what was entered."""
    data = recorded(campaign)
    return Local.about(data, Point.entered(data))


def misses(campaign) -> dict[str, float]:
    """Largest relative residual of each kind of reading."""
    local = seen(campaign)
    static, load = local.r.static, campaign.robot.platform.mass * campaign.robot.gravity
    lengths = local.data.readings.length
    found = {"wrench": np.abs(static[:, :6]).max() / load, "length": np.abs(static[:, 6:] / lengths).max()}
    if local.vibrating is not None:
        found["cable"] = np.abs(local.r.cables).max(initial=0.0)
        found["robot"] = max(missed_peaks(campaign, local, k) for k in range(len(local.vibrating.log_hertz)))
    return found


def missed_peaks(campaign, local: Local, k: int) -> float:
    """Of the lowest modes of one state, in order."""
    own = campaign.robot_frequencies.state == local.vibrating.measured.states[k]
    if not own.any():
        return 0.0
    modes = local.vibrating.robot
    lowest = np.sort(modes.log_hertz[k][modes.mask[k]])[: own.sum()]
    return float(np.abs(np.sort(np.log(campaign.robot_frequencies.hertz[own])) - lowest).max())


def assert_held(found: dict[str, float], cable: float = HELD) -> None:
    limits = {"wrench": HELD, "length": HELD, "cable": cable, "robot": ROUNDING}
    for kind, value in found.items():
        assert value < limits[kind], f"{kind}: {value:.1e}"


@pytest.mark.parametrize("name", ROBOTS)
def test_readings_of_every_extension_leave_no_residual(name):
    """One robot for every extension alone."""
    robot = ROBOTS[name]()
    assert set(fields_of(robot)) == {*ALONE, "sensor_mass"}
    for key in ALONE:
        machine = extended(robot, **fields_of(robot)[key])
        vibrating = () if key in OF_READINGS else (0,)  # those mean the same states, and these the same modes
        found = misses(written(machine, plan_of(robot, 1, loads=LOADS, cables_in=vibrating, robot_in=vibrating)))
        assert_held(found, {"added_mass": KINK, "bending_stiffness": LAYERS}.get(key, HELD))


@pytest.mark.parametrize("name", ROBOTS)
def test_readings_of_all_extensions_together_leave_no_residual(name):
    robot = ROBOTS[name]()
    fields = all_together(robot)
    fields.pop("sensor_mass")  # of first order only, see below
    found = misses(written(extended(robot, **fields), plan_of(robot, 2, loads=LOADS, cables_in=(1,), robot_in=(1,))))
    assert_held(found, KINK)


@pytest.mark.parametrize(
    ("model", "assembly", "entered"),
    [
        ("spring", "consistent", {"series_compliance": 4e-6 * VARIED, "nonlinearity": 0.15}),
        ("static", "consistent", {"series_compliance": 4e-6 * VARIED, "hose": 40.0, "hose_center": [0.2, 0.1, 1.0]}),
        ("exact", "thesis", {"series_compliance": 4e-6 * VARIED, "tilt": [4e-3, -3e-3]}),
    ],
)
def test_every_simulation_that_may_be_under_test_has_one_forward_model(model, assembly, entered):
    robot = load_robot("cogiro")
    vibrating = () if model == "spring" else (1,)
    plan = plan_of(robot, 2, loads=LOADS, robot_in=vibrating, model=model, assembly=assembly)
    if "nonlinearity" in entered:
        entered = {**entered, "reference_tension": 400.0}
    assert_held(misses(written(extended(robot, **entered), plan)))


@pytest.mark.parametrize("changed", ["axial_stiffness", "linear_density", "mass"])
def test_a_wrong_robot_does_leave_residuals(changed):
    """The twin that must fail: one number 2 % off."""
    robot = load_robot("thesis-3-1")
    if changed == "mass":
        other = robot.with_load(mass=1.02 * robot.platform.mass)
    else:
        cables = tuple(replace(c, **{changed: 1.02 * getattr(c, changed)}) for c in robot.cables)
        other = replace(robot, cables=cables)
    found = misses(written(other, plan_of(robot, 2, loads=LOADS, cables_in=(1,), robot_in=(1,)), robot))
    with pytest.raises(AssertionError):
        assert_held(found)


def sensors_miss(mass: float, **fields) -> float:
    """Largest error of ln f where sensors of a mass hang on the platform."""
    robot = load_robot("thesis-3-1")
    machine = extended(robot, sensor_mass=mass, **fields)
    found = misses(written(machine, plan_of(robot, 2, cables_in=(1,), robot_in=(1,))))
    return max(found["cable"], found["robot"])


def test_the_mass_of_sensors_acts_to_first_order():
    """A tenth of the mass leaves a hundredth of the error, which is of second order in 1.5 kg of 60 kg."""
    whole, tenth = sensors_miss(1.5), sensors_miss(0.15)
    assert whole < 1e-4
    assert tenth < 0.02 * whole


@pytest.mark.xfail(strict=True, reason="tensions rise under the sensors' mass as if masts were rigid, moduli constant")
@pytest.mark.parametrize("fields", [{"frame_compliance": 1e-6}, {"nonlinearity": 0.15, "reference_tension": 400.0}])
def test_the_mass_of_sensors_acts_to_first_order_on_what_else_gives_way(fields):
    assert sensors_miss(0.15, **fields) < 0.02 * sensors_miss(1.5, **fields)
