"""Laws of the diagnosis: robots with fewer cables than freedoms, poses that nobody read, relative encoders."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.errors import InputError
from cdpr_struct.hypotheses.handled import promising, readings_felt
from cdpr_struct.hypotheses.handling import corrections
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.measurement.campaign import UNKNOWN_ZERO, Campaign, States
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.campaign_template import planned
from cdpr_struct.observation.rest import rest
from cdpr_struct.observation.vibrating import vibrating
from cdpr_struct.planning.candidates import placed, read_alike
from cdpr_struct.planning.places import home_of
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.statics.forward_kinematics import forward
from tests.laws.written_campaigns import NO_CABLES, NO_PEAKS, with_states

ROBOTS = Path(__file__).parents[1] / "blind" / "robots"
SIGMA = {"position": 3e-4, "rotation": 2e-4, "tension": 1.0, "length": 3e-4}


def robot_of(name: str, arm: float = 1.0) -> Robot:
    """A robot that hangs on few cables, its platform anchors `arm` times as far out."""
    robot = load_robot(ROBOTS / f"{name}-cables.toml")
    cables = replace(robot, platform_anchors=arm * robot.platform_anchors)
    body = replace(robot.platform, center_of_mass=arm * robot.platform.center_of_mass)
    return replace(cables, platform=body)


def hung(robot: Robot, count: int, noise: float = 0.0) -> Campaign:
    """States at rest at drawn lengths, with payloads; `noise` in stated sigmas."""
    draw = np.random.default_rng(3)
    place = robot.home.position + draw.uniform(-0.5, 0.5, (count, 3)) * [1.0, 0.2, 0.8]
    chords = np.linalg.norm(robot.frame_anchors - place[:, None] - robot.platform_anchors, axis=-1)
    payload = np.resize([0.0, 5.0, 10.0], count)
    rests = [forward(robot.with_load(p), own, x) for p, own, x in zip(payload, chords, place, strict=True)]
    angles = np.array([angles_from_rotation(rest.rotation) for rest in rests])
    read = {"position": np.array([rest.position for rest in rests]), "rotation": angles}
    read |= {"tension": np.array([rest.tensions for rest in rests]), "length": chords}
    read = {name: value + noise * SIGMA[name] * draw.standard_normal(value.shape) for name, value in read.items()}
    m, blank = len(robot.cables), np.full(count, np.nan)
    states = States(
        names=tuple(f"s{k}" for k in range(count)), position=read["position"], angles=read["rotation"],
        sigma_position=np.full(count, SIGMA["position"]), sigma_rotation=np.full(count, SIGMA["rotation"]),
        payload=payload, tension=read["tension"], tension_sigma=np.full((count, m), SIGMA["tension"]),
        length=read["length"], length_sigma=np.full((count, m), SIGMA["length"]), lock=np.arange(count),
        loaded=np.zeros(count, dtype=bool), static=np.ones(count, dtype=bool), temperature=blank,
        approach=np.full((count, m), np.nan), time=blank,
    )  # fmt: skip
    return Campaign("hung", robot, robot.name, "exact", Tolerances(), frozenset(), states, NO_CABLES, NO_PEAKS)


def unplaced(campaign: Campaign, inclined: bool, first: int = 0) -> Campaign:
    """Without positions from a state on, and without angles but perhaps rx and ry."""
    position, angles = campaign.states.position.copy(), campaign.states.angles.copy()
    position[first:] = np.nan
    angles[first:, 2 if inclined else 0 :] = np.nan
    return with_states(campaign, position=position, angles=angles)


@pytest.mark.parametrize("name", ["two", "five"])
@pytest.mark.parametrize("inclined", [True, False])
def test_a_pose_that_nobody_read_is_where_the_robot_rests_at_its_lengths(name, inclined):
    campaign = hung(robot_of(name), 3)
    found = recorded(unplaced(campaign, inclined)).readings
    # the fit meets balance to .05 N, a tenth of a millimetre on cables of 100 N and 3 m; without noise it is exact
    np.testing.assert_allclose(found.position, campaign.states.position, atol=2e-5)
    np.testing.assert_allclose(angles_from_rotation(found.rotation), campaign.states.angles, atol=2e-5)


def test_a_pose_that_nobody_read_needs_no_length_of_every_cable():
    campaign = hung(robot_of("four"), 3)
    lacking = campaign.states.length.copy()
    lacking[:, 1] = np.nan
    found = recorded(unplaced(with_states(campaign, length=lacking), True)).readings
    # balance alone says where it is along the missing cable: 0.05 N on the 30 N/m of a pendulum of 40 kg are 1.7 mm
    np.testing.assert_allclose(found.position, campaign.states.position, atol=2e-3)
    np.testing.assert_allclose(found.length, campaign.states.length, atol=3e-3)


def test_relative_encoders_say_as_much_wherever_they_begin():
    """The zero is unknown: what is added to all readings of one encoder changes no evidence."""
    campaign = hung(robot_of("three"), 4, noise=1.0)
    free = replace(campaign, relative_lengths=True, tolerances=replace(campaign.tolerances, length_m=UNKNOWN_ZERO))
    said = []
    for start in (0.0, 2.5):
        shift = start * np.array([1.0, -0.7, 0.0])
        data = recorded(with_states(unplaced(free, True, 2), length=campaign.states.length - shift))
        said.append(judged(data, layout(data), Hypothesis()).log_evidence)
    assert said[0] == pytest.approx(said[1], abs=1e-3)  # nats; the linearisation is begun at slightly other poses
    absolute = recorded(with_states(unplaced(campaign, True, 2), length=campaign.states.length - shift))
    assert judged(absolute, layout(absolute), Hypothesis()).log_evidence < said[0] - 10.0  # there it does


def test_relative_encoders_need_one_measured_pose():
    free = replace(hung(robot_of("three"), 2), relative_lengths=True)
    with pytest.raises(InputError, match=r"cable 1: got 'no such state'.*measured pose"):
        recorded(unplaced(free, True))


@pytest.mark.parametrize(("arm", "felt"), [(1.0, True), (0.0, False)])
def test_the_unit_of_angles_is_evidence_only_where_angles_matter(arm, felt):
    """On a point mass they change nothing: angles of a level platform are as small in any unit."""
    data = recorded(hung(robot_of("three", arm), 6, noise=1.0))
    said = readings_felt(data)
    assert said[:, 3:6].all() == felt
    assert said[:, [0, 1, 2, 6, 7, 8, 9, 10, 11]].all()
    assert not promising(data, corrections(data.campaign), said)


def test_readings_that_nothing_could_contradict_are_refused():
    campaign = unplaced(hung(robot_of("three"), 2), False)
    nothing = np.full_like(campaign.states.length, np.nan)
    with pytest.raises(InputError, match="no state where one could contradict another"):
        recorded(with_states(campaign, length=nothing))
    recorded(campaign)  # lengths beside tensions could


def test_a_load_cell_is_found_without_any_pose():
    campaign = unplaced(hung(robot_of("three"), 9, noise=1.0), False)
    off = campaign.states.tension * [1.08, 1.0, 1.0]
    assert diagnosed(with_states(campaign, tension=off)).decision.classes == (("load_cell_gain",),)


def test_sensors_lower_a_point_mass_and_do_not_turn_it():
    """Nothing holds its angles, and a weight at its origin asks nothing of them."""
    data = recorded(hung(robot_of("three", 0.0), 2))
    arrays = replace(data.arrays, sensor_mass=np.asarray(1.0))
    there = vibrating(rest(arrays, data.readings, data.known), data.known)
    np.testing.assert_array_equal(there.rotation, data.readings.rotation)
    assert (there.position[:, 2] < data.readings.position[:, 2]).all()


def test_what_to_measure_next_is_asked_about_the_poses_that_are_likeliest():
    """Without a measured pose proposals lie where the robot rested, and are read by the sensors that there are."""
    campaign = hung(robot_of("three"), 3)
    data = recorded(unplaced(campaign, True))
    home = home_of(placed(data))
    assert np.linalg.norm(campaign.states.position - home.position, axis=1).min() < 1e-4  # that of a state, as fitted
    again = read_alike(data.campaign, campaign).states
    np.testing.assert_array_equal(np.isfinite(again.angles), [[True, True, False]] * 3)
    assert not np.isfinite(again.position).any()


HEAD = f'robot = "{(ROBOTS / "two-cables.toml").as_posix()}"\n'
ENTRY = '[[measurement]]\nkind = "static_state"\nfile = "states.csv"\n'


def loaded(folder: Path, rows: str, head: str = "", more: str = "") -> Campaign:
    (folder / "states.csv").write_text(rows)
    (folder / "campaign.toml").write_text(head + HEAD + ENTRY + more)
    return load_campaign(folder / "campaign.toml")


def test_files_without_a_position_name_their_states(tmp_path):
    found = loaded(tmp_path, "case,rx_deg,tension_1_N,tension_2_N\na,1.5,150,160\nb,,151,\n").states
    assert found.names == ("a", "b")
    assert np.isnan(found.position).all()
    np.testing.assert_allclose(np.degrees(found.angles), [[1.5, np.nan, np.nan], [np.nan] * 3])
    with pytest.raises(InputError, match=r"column case is missing; .*x_m, y_m, z_m, or the name of each state"):
        loaded(tmp_path, "tension_1_N,tension_2_N\n150,160\n")
    with pytest.raises(InputError, match="column y_m is missing"):
        loaded(tmp_path, "case,x_m,z_m,tension_1_N,tension_2_N\na,1,2,150,160\n")


@pytest.mark.parametrize("first", [True, False])
def test_a_file_that_names_a_state_takes_its_pose_and_payload_from_another(tmp_path, first):
    (tmp_path / "pluck.csv").write_text("case,cable,mode,frequency_hz\na,1,1,9.5\n")
    (tmp_path / "states.csv").write_text("case,x_m,y_m,z_m,payload_kg,tension_1_N,tension_2_N\na,0,0.4,2,5,150,160\n")
    pluck = '[[measurement]]\nkind = "cable_frequency"\nfile = "pluck.csv"\n'
    (tmp_path / "campaign.toml").write_text(HEAD + (pluck + ENTRY if first else ENTRY + pluck))
    found = load_campaign(tmp_path / "campaign.toml")
    np.testing.assert_array_equal(found.states.position, [[0.0, 0.4, 2.0]])
    assert found.states.payload.tolist() == [5.0]


def test_frequencies_of_a_state_that_nothing_places_are_refused(tmp_path):
    (tmp_path / "pluck.csv").write_text("case,cable,mode,frequency_hz\nb,1,1,9.5\n")
    more = '[[measurement]]\nkind = "cable_frequency"\nfile = "pluck.csv"\n'
    with pytest.raises(InputError, match=r"case b: got 'no pose'; .*position"):
        loaded(tmp_path, "case,x_m,y_m,z_m,tension_1_N,tension_2_N\na,0,0.4,2,150,160\n", more=more)
    lengths = "case,length_1_m,length_2_m\nb,3.2,3.5\n"
    assert loaded(tmp_path, lengths, more=more).cable_frequencies.hertz.tolist() == [9.5]


def test_only_relative_encoders_may_read_below_zero(tmp_path):
    rows = "case,x_m,y_m,z_m,length_1_m,length_2_m\na,0,0.4,2,0,0\nb,0,0.4,2.2,-0.1,-0.12\n"
    found = loaded(tmp_path, rows, 'encoders = "relative"\n')
    assert found.relative_lengths
    assert found.states.lock.tolist() == [0, 1]
    with pytest.raises(InputError, match=r"column length_1_m: got '0'; a number above zero"):
        loaded(tmp_path, rows)
    with pytest.raises(InputError, match=r"tolerances.length_m: got 0.001; .*zeros"):
        loaded(tmp_path, rows, 'encoders = "relative"\n', "[tolerances]\nlength_m = 0.001\n")
    with pytest.raises(InputError, match="encoders"):
        loaded(tmp_path, rows, 'encoders = "incremental"\n')


def test_a_template_predicts_where_a_robot_hangs():
    """Its planned pose cannot be held; at the lengths that reach it the platform rests nearby, tilted."""
    robot = robot_of("two")
    plan = planned(robot, ["home"], [robot.home])
    rest = forward(robot, plan.point.cables.total_length[0], robot.home.position)
    np.testing.assert_allclose(plan.poses[0].position, rest.position, atol=1e-9)  # one equilibrium from both starts
    assert np.abs(plan.poses[0].position - robot.home.position).max() < 0.1
    assert np.abs(plan.poses[0].angles).max() > 0.01
