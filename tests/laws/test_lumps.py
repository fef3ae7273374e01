"""Masses on cables: segments in series by first principles, in statics, energy and vibration."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.catenary_expansion import CableExtras, expand_catenaries
from cdpr_struct.dynamics.condensed_pose import knows
from cdpr_struct.dynamics.many_poses import lowest_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.interface.view import open_window
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.lump import Lump
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot, robot_of_text
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_state import cable_stiffness
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench, rotation_from_vector
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.potential_energy import potential_energy
from cdpr_struct.statics.static_stiffness import static_stiffness

TURN = rotation_from_vector(np.array([0.03, -0.02, 0.05]))
LUMPS = (Lump(1, 2.5, 0.5), Lump(1, 5.7, 1.0), Lump(3, 4.9, 0.8))


def loaded(name: str, lumps: tuple[Lump, ...] = LUMPS, **more: float) -> Robot:
    robot = load_robot(name)
    return replace(robot, lumps=lumps, extensions=Extensions.of(len(robot.cables), more))


def off_home(robot: Robot) -> np.ndarray:
    return robot.home.position + np.array([0.3, -0.2, 0.1])


def one_cable(density: float, lumps: list[tuple[float, float]], stiffness: float = 1e6) -> RobotArrays:
    """Arrays of a robot that is one cable from the world's origin; lumps as place [m], mass [kg]."""
    place, mass = np.array(lumps or [(0.0, 0.0)]).T
    return RobotArrays(
        platform_anchors=np.zeros((1, 3)), frame_anchors=np.zeros((1, 3)), axial_stiffness=np.array([stiffness]),
        linear_density=np.array([density]), pulley_radius=np.zeros(1), pulley_axis=np.array([[0.0, 0.0, 1.0]]),
        mass=np.asarray(1.0), center_of_mass=np.zeros(3), inertia=np.eye(3), gravity=np.asarray(9.81),
        lump_place=place[None], lump_mass=mass[None],
    )  # fmt: skip


SAGGING = cable_model("sagging")


def test_a_mass_at_the_middle_of_a_light_cable_makes_two_straight_lines():
    """2 T sin(a) = M g; each half is stretched by T l / EA."""
    arrays, mass, length = one_cable(1e-9, [(5.0, 3.0)]), 3.0, 10.0
    cable = SAGGING.states(arrays, np.array([[9.9, 0.0, 0.0]]), np.array([length]))
    tension = cable.tension_at_platform[0]
    half = 0.5 * length * (1.0 + tension / 1e6)
    depth = np.sqrt(half**2 - 4.95**2)
    assert 2.0 * tension * depth / half == pytest.approx(mass * 9.81, rel=1e-7)
    assert cable.sag[0] == pytest.approx(depth, rel=1e-7)
    assert cable.elongation[0] == pytest.approx(2.0 * half - length, rel=1e-6)


def test_ends_carry_the_cable_and_its_masses():
    arrays = one_cable(0.3, [(2.0, 1.5), (6.0, 0.4)])
    cable = SAGGING.states(arrays, np.array([[7.0, 3.0, -4.0]]), np.array([8.8]))
    held = cable.force_on_platform + cable.force_at_frame
    np.testing.assert_allclose(held[0], [0.0, 0.0, -9.81 * (0.3 * 8.8 + 1.9)], atol=1e-9)
    assert cable.whole_weight[0] == pytest.approx(9.81 * (0.3 * 8.8 + 1.9), rel=1e-14)


def test_many_masses_are_a_heavier_cable():
    """Equal masses at the middles of n pieces: forces tend to those of the heavy cable with the square of 1 / n."""
    end, length = np.array([[7.0, 0.0, 2.0]]), np.array([7.6])
    heavy = SAGGING.states(one_cable(0.5, []), end, length).force_on_platform
    errors = []
    for n in (4, 8, 16):
        places = [((i + 0.5) * 7.6 / n, 0.4 * 7.6 / n) for i in range(n)]
        errors.append(np.abs(SAGGING.states(one_cable(0.1, places), end, length).force_on_platform - heavy).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 2.0, atol=0.15)
    assert errors[-1] < 4e-3 * np.abs(heavy).max()  # measured: 2.5e-3


@pytest.mark.parametrize("length", [7.9, 8.0623, 9.0])
def test_stiffness_of_a_cable_is_the_derivative_of_its_force(length):
    arrays, end = one_cable(0.3, [(2.0, 1.5), (6.0, 0.4)]), np.array([[7.0, 2.0, -3.4]])

    def force(moved: np.ndarray) -> np.ndarray:
        return SAGGING.states(arrays, end + moved, np.array([length])).force_on_platform[0]

    matrix = cable_stiffness(SAGGING.states(arrays, end, np.array([length])))[0]
    differences = np.array([force(-step) - force(step) for step in 1e-6 * np.eye(3)]).T / 2e-6
    np.testing.assert_allclose(matrix, differences, atol=1e-7 * np.abs(matrix).max())  # measured: below 1e-8


def test_tension_and_length_are_two_questions_with_one_answer():
    arrays, end = one_cable(0.3, [(2.0, 1.5), (6.0, 0.4)]), np.array([[7.0, 2.0, -3.4]])
    held = SAGGING.hold(arrays, end, np.array([60.0]))
    again = SAGGING.states(arrays, end, held.states.length)
    np.testing.assert_allclose(again.force_on_platform, held.states.force_on_platform, rtol=1e-10)
    assert again.tension[0] == pytest.approx(60.0, rel=1e-10)
    rates = [SAGGING.hold(arrays, end, np.array([60.0 + d])).states.force_on_platform for d in (-1e-4, 1e-4)]
    np.testing.assert_allclose(held.force_rate, (rates[1] - rates[0]) / 2e-4, atol=1e-7)


@pytest.mark.parametrize(
    "given", [{}, {"series_compliance": 2e-5}, {"frame_compliance": 1e-5}], ids=["plain", "in line", "masts"]
)
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_lengths_that_inverse_gives_lead_forward_to_the_pose(given, radius):
    robot = loaded("cogiro", **given)
    robot = replace(robot, pulleys=(Pulley(radius),) * 8) if radius else robot
    place = off_home(robot)
    held = inverse(robot, place, TURN)
    found = forward(robot, held.lengths, place + np.array([0.02, 0.01, -0.02]), TURN)
    assert found.stable
    np.testing.assert_allclose(found.position, place, atol=1e-10)
    np.testing.assert_allclose(found.tensions, held.tensions, rtol=1e-8)


def test_stiffness_and_energy_are_derivatives_at_locked_lengths():
    robot = loaded("six-cable-8mm")
    place, arrays = off_home(robot), RobotArrays.of(robot)
    held = inverse(robot, place, np.eye(3))
    length = arrays.paid_out(held.lengths)

    def at(motion: np.ndarray) -> tuple[np.ndarray, float]:
        position, turn = place + motion[:3], rotation_from_vector(motion[3:])
        arms = PlatformArms.at(arrays, position, turn)
        states = SAGGING.states(arrays, arms.points, length)
        wrench = cable_wrench(states, arms) + load_wrench(arrays, arms)
        return wrench, float(potential_energy(arrays, position, turn, states, np.zeros(6)))

    matrix = static_stiffness(robot, place, np.eye(3), held.cables).matrix
    differences = np.array([at(-step)[0] - at(step)[0] for step in 1e-6 * np.eye(6)]).T / 2e-6
    np.testing.assert_allclose(matrix, differences, atol=3e-7 * np.abs(matrix).max())
    away = np.array([0.05, -0.03, 0.04, 0.02, -0.01, 0.03])
    work = -np.array([at(away + step)[1] - at(away - step)[1] for step in 1e-5 * np.eye(6)][:3]) / 2e-5
    np.testing.assert_allclose(work, at(away)[0][:3], atol=1e-5 * np.abs(at(away)[0]).max())


def test_poses_in_one_batch_are_those_alone():
    robot = loaded("thesis-3-1")
    places = off_home(robot) + np.array([[0.0, 0.0, 0.0], [0.7, -0.5, 0.3], [-0.4, 0.9, -0.2]])
    together = inverse(robot, places, TURN)
    for i, place in enumerate(places):
        np.testing.assert_allclose(together.tensions[i], inverse(robot, place, TURN).tensions, rtol=1e-8)
    np.testing.assert_allclose(forward(robot, together.lengths, places + 0.01, TURN).position, places, atol=1e-10)


def test_a_mass_at_mid_cable_slows_a_taut_string():
    """Across a taut string with a mass M at its middle: 2 T k cot(k l / 2) = M omega^2, k = omega sqrt(mu / T).

    T differs by the weight along the string, 1e-5 of it.
    """
    density, mass = 0.05, 0.4
    cables = SAGGING.states(one_cable(density, [(5.0, mass)]), np.array([[10.02, 0.0, 0.0]]), np.array([10.0]))
    extras = CableExtras(*np.zeros((4, 1)), np.array([[mass]]))
    found = expand_catenaries(cables, np.array([density]), 20, cable_stiffness(cables), None, extras)
    first = np.sqrt(found.omega_squared[0, 0])
    tension, length = cables.tension_at_platform[0], cables.chord[0]
    k = first * np.sqrt(density / (tension * (1.0 + tension / 1e6)))
    assert 2.0 * tension * k / np.tan(0.5 * k * length) == pytest.approx(mass * first**2, rel=1e-3)
    assert first < 0.8 * np.pi / length * np.sqrt(tension / density)  # twin: without the mass


def test_masses_far_apart_and_none_at_all_share_the_functions():
    """A cable without masses is cut in vain: its own frequencies stay those of the whole catenary."""
    robot = loaded("thesis-3-1")
    held = inverse(robot, off_home(robot), TURN)
    point = OperatingPoint(robot, off_home(robot), TURN, held.cables)
    first = cable_dynamics(point, "exact").first_frequency
    bare = OperatingPoint(load_robot("thesis-3-1"), point.position, TURN, held.cables)
    alone = [i for i in range(8) if i not in (0, 2)]
    none = replace(held.cables, lump_place=np.zeros((8, 1)), lump_weight=np.zeros((8, 1)))
    plain = cable_dynamics(replace(bare, cables=none), "exact").first_frequency
    np.testing.assert_allclose(first[alone], plain[alone], rtol=1e-10)
    assert (first[[0, 2]] < 0.9 * plain[[0, 2]]).all()


def test_fast_paths_leave_masses_to_the_exact_model():
    robot = loaded("thesis-3-1")
    places = off_home(robot) + np.linspace(0.0, 0.3, 7)[:, None] * np.array([1.0, 0.5, 0.0])
    held = inverse(robot, places, TURN)
    point = OperatingPoint(robot, places, np.broadcast_to(TURN, (7, 3, 3)), held.cables)
    found = lowest_frequencies(point, 6)
    assert not found.quick.any()
    own = cs.modes(robot, [*places[0], *np.zeros(3)], count=3)
    assert not knows(own.point)


def test_a_lump_is_written_and_read_again():
    robot = loaded("thesis-3-1")
    assert robot_of_text(robot_toml(robot, "loaded"), "loaded.toml").lumps == LUMPS


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("cable = 9\nfrom_platform = 1.0\nmass = 1.0", "lumps: .*there is no cable 9: cables are numbered from 1 to 8"),
        ("cable = 1\nfrom_platform = 1.0\nmass = -1.0", r"lumps\[1\]\.mass: got -1\.0"),
        ("cable = 1\nfrom_platform = 0.0\nmass = 1.0", r"lumps\[1\]\.from_platform: got 0\.0"),
        ("cable = 1\nmass = 1.0", r"lumps\[1\]\.from_platform is missing; .*required"),
    ],
)
def test_an_unusable_lump_is_refused_by_its_field(table, said):
    text = robot_toml(load_robot("thesis-3-1"), "loaded") + f"\n[[lumps]]\n{table}\n"
    with pytest.raises(InputError, match=said):
        robot_of_text(text, "loaded.toml")


def test_lumps_do_not_go_with_wind_bending_or_weightlessness():
    for more in ({"drag_width": 0.01, "wind": [5.0, 0.0, 0.0]}, {"bending_stiffness": 1.0}, {"added_mass": 0.1}):
        with pytest.raises(ValueError, match="lumps do not go with"):
            loaded("thesis-3-1", **more)
    with pytest.raises(ValueError, match="lumps need gravity above 0"):
        replace(loaded("thesis-3-1"), gravity=0.0)
    with pytest.raises(ValueError, match="two lumps sit at one place"):
        loaded("thesis-3-1", (LUMPS[0], LUMPS[0]))


REFUSED = {
    "map": {"grid": "0,0:1:2,0.5", "quantity": "tension-max"},
    "pose_error": {"grid": "0,0:1:2,0.5"},
    "audit": {},
    "verify": {},
    "distribute": {"trajectory": "line:0,0,0.5:0.5,0,0.5:2", "instants": 3},
    "export": {"to": "moordyn"},
    "new_campaign": {},
    "inverse": {"model": "spring"},
    "forward": {"model": "ideal", "lengths": [10.0] * 8},
    "transient": {"initial_velocity": "0.1,0,0", "duration": 1.0},
}


@pytest.mark.parametrize("name", REFUSED)
def test_commands_without_masses_on_cables_refuse_by_the_field(name, tmp_path):
    path = tmp_path / "loaded.toml"
    path.write_text(robot_toml(loaded("thesis-3-1"), "loaded"))
    with pytest.raises(InputError, match=r"lumps: got '?0\.5 kg on cable 1'?; leave \[\[lumps\]\] out: "):
        getattr(cs, name)(path, **REFUSED[name])


def test_the_live_view_refuses_them():
    with pytest.raises(InputError, match=r"leave \[\[lumps\]\] out: "):
        open_window(loaded("thesis-3-1"))


def test_angles_left_free_hang_where_nothing_is_left_to_balance():
    robot = loaded("six-cable-8mm")
    found = cs.inverse(robot, [0.3, 0.2, 0.6], free="rx,ry,rz")
    again = inverse(robot, found.pose.position, found.pose.rotation)
    assert again.held.all()
    assert np.abs(again.residual_wrench).max() < 1e-8  # N and N m


def test_a_campaign_refuses_them(tmp_path):
    (tmp_path / "loaded.toml").write_text(robot_toml(loaded("thesis-3-1"), "loaded"))
    (tmp_path / "states.csv").write_text("case,x_m,y_m,z_m,cable,tension_N\na,0,0,0.5,1,100\n")
    sheet = 'kind = "static_state"\nfile = "states.csv"\nsigma = { tension_N = 3.0, position_m = 0.001 }\n'
    (tmp_path / "campaign.toml").write_text(f'robot = "loaded.toml"\nmodel = "exact"\n[[measurement]]\n{sheet}')
    with pytest.raises(InputError, match="masses on cables are not among what is diagnosed"):
        load_campaign(tmp_path / "campaign.toml")


def test_the_closed_form_refuses_them():
    with pytest.raises(CdprError, match="knows no masses on cables"):
        cs.modes(loaded("thesis-3-1"), model="dsm", count=3)


def test_a_mass_beyond_the_frame_end_is_refused_by_its_number():
    robot = loaded("thesis-3-1", (Lump(2, 3.0, 0.5), Lump(4, 15.0, 0.5)))
    for command in (cs.inverse, cs.modes):
        with pytest.raises(CdprError, match=r"lumps\[2\] is 15 m from the platform end of cable 4, but only 10\."):
            command(robot)


def test_the_least_tension_of_a_cable_is_that_of_its_own_masses():
    robot, plain = RobotArrays.of(loaded("thesis-3-1")), RobotArrays.of(loaded("thesis-3-1", ()))
    points = robot.platform_anchors + load_robot("thesis-3-1").home.position
    more, less = (SAGGING.least_chord_tension(arrays, points) for arrays in (robot, plain))
    carrying = np.isin(np.arange(8), [0, 2])
    assert (more[carrying] > less[carrying]).all()
    np.testing.assert_array_equal(more[~carrying], less[~carrying])
