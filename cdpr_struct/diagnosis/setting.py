"""From a campaign to the fixed part of its residuals: which states, which rows, which modes."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis import robot_pitch
from cdpr_struct.diagnosis.cable_pitch import cable_log_frequencies, exact_log_frequencies
from cdpr_struct.diagnosis.commanded import commanded
from cdpr_struct.diagnosis.conditioned_state import Circumstances, Conditioned
from cdpr_struct.diagnosis.extended_robot import robot_of
from cdpr_struct.diagnosis.locked_pose import reference
from cdpr_struct.diagnosis.modal_constants import measured_constants
from cdpr_struct.diagnosis.readings import Readings, cell_reading, exit_turns
from cdpr_struct.diagnosis.residuals import (
    Labels,
    Setting,
    as_sent,
    at_states,
    readings_of_states,
    resting_and_vibrating,
    world_of_states,
)  # fmt: skip
from cdpr_struct.diagnosis.robot_rows import ModelModes, model_modes, rough_strays, with_robot_rows
from cdpr_struct.diagnosis.world import World
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.energy_descent import arm_scale
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse


def make_setting(campaign: Campaign) -> tuple[Setting, Setting]:
    """The fixed part of a campaign's residuals: twice, for a world that may be far from the truth, and for one near it.

    They differ in how freely measured robot frequencies are given to modes.

    Raises
    ------
    InputError : a state with neither tensions nor lengths, or more robot frequencies than the model has.
    """
    states = campaign.states
    if not len(states.names):
        raise InputError(campaign.source, "measurement", "no states", "static states, loaded poses or frequencies")
    campaign = _with_tensions(campaign)
    states = campaign.states
    held = np.flatnonzero(states.has_tension)
    locked = np.flatnonzero(~states.has_tension & states.has_length)
    radius = arm_scale(RobotArrays.of(campaign.robot))
    blank, constants = np.zeros(0), measured_constants(campaign)
    setting = Setting(
        campaign, circumstances(campaign), held, locked, states.has_length[held], commanded(campaign, held), radius,
        Labels(blank, blank, blank), campaign.cable_frequencies, np.zeros(campaign.cable_frequencies.hertz.size),
        robot_pitch.Rows(np.zeros(0, dtype=int), blank, np.zeros((0, 6))),
        blank, blank, blank, blank, blank, blank, blank,
        constants, np.zeros(len(constants)), np.zeros(len(constants)),
        campaign.model == "static", campaign.assembly == "consistent",
    )  # fmt: skip
    setting = replace(setting, labels=_labels(setting))
    world = World.of(campaign.robot, len(states.names))
    setting = with_equilibria(setting, world)
    if campaign.cable_frequencies.hertz.size and setting.known.sagging:
        setting = replace(setting, cable_gap=_cable_gap(setting, world))
    if not campaign.robot_frequencies.hertz.size:
        return setting, setting
    model = model_modes(setting, world, _points(setting, world, campaign.robot_frequencies.state))
    return with_robot_rows(setting, model, wary=True), with_robot_rows(setting, model, wary=False)


def circumstances(campaign: Campaign) -> Circumstances:
    """What is known of each state without error."""
    states = campaign.states
    tension = states.tension[np.isfinite(states.tension)]
    weight = campaign.robot.platform.mass * campaign.robot.gravity
    mean = float(tension.mean()) if tension.size else weight / len(campaign.robot.cables)
    more = campaign.robot.extensions
    if more.nonlinearity:
        mean = more.reference_tension
    hours = (states.time - np.nanmin(states.time)) / 3600.0 if np.isfinite(states.time).any() else 0.0 * states.time
    return Circumstances(
        payload=states.payload,
        wrap=exit_turns(campaign.robot, states.position, Readings.of(states).rotation),
        approach=np.where(np.isfinite(states.approach), states.approach, 0.0),
        hours=np.where(np.isfinite(hours), hours, 0.0),
        center=more.hose_center if more.hose else states.position.mean(axis=0),
        mean_tension=mean,
        sagging=campaign.model != "spring",
    )


def _with_tensions(campaign: Campaign) -> Campaign:
    """States known by their pose only get the simulation's tensions, with a sigma of a tenth."""
    states = campaign.states
    blind = np.flatnonzero(~states.has_tension & ~states.has_length)
    if not blind.size:
        return campaign
    tension, sigma = states.tension.copy(), states.tension_sigma.copy()
    for i in blind:
        turn = Readings.of(states).rotation[i]
        robot = campaign.robot.with_load(float(states.payload[i]))
        held = _held(campaign, robot, int(i), turn)
        turns = exit_turns(robot, states.position[i], turn)
        computed = cell_reading(robot, held.tensions, states.approach[i], turns)
        known = np.isfinite(tension[i])
        tension[i] = np.where(known, tension[i], computed)
        sigma[i] = np.where(known, sigma[i], 0.1 * computed.mean())
    return replace(campaign, states=replace(states, tension=tension, tension_sigma=sigma))


def _held(campaign: Campaign, robot: Robot, i: int, turn: np.ndarray) -> InverseSolution:
    states = campaign.states
    try:
        return inverse(robot, states.position[i], turn, campaign.cable_model, lower_bound=campaign.lower_bound)
    except CdprError as error:
        expected = f"a pose in m and degrees that the robot can hold, or tensions: {error}"
        raise InputError(
            campaign.source, f"case {states.names[i]}: pose", states.position[i].tolist(), expected
        ) from error


def _cable_gap(setting: Setting, world: World) -> np.ndarray:
    """ln(exact / closed form) of each measured cable frequency."""
    rows, everywhere = setting.cable_rows, np.arange(len(setting.campaign.states.names))
    world = replace(world, bending_stiffness=0.0 * world.bending_stiffness, added_mass=0.0 * world.added_mass)
    closed = cable_log_frequencies(world.per_state(), _conditioned(setting, world, everywhere).cables, rows)
    exact = exact_log_frequencies(_points(setting, world, rows.state), rows, closed)
    return np.where(np.isfinite(exact), exact - closed, 0.0)


def anchored(setting: Setting, world: World) -> Setting:
    """The same residuals about a given world: its locked poses, and robot frequencies paired with its exact modes."""
    return paired_with(with_equilibria(setting, world), world)


def paired_with(setting: Setting, world: World, wary: bool = False) -> Setting:
    """The same residuals with robot frequencies paired with the exact modes of a world, which may be far from true."""
    if not setting.campaign.robot_frequencies.state.size:
        return setting
    return with_robot_rows(setting, modes_in(setting, world), wary)


def modes_in(setting: Setting, world: World) -> ModelModes:
    """The exact modes of a world at the states where peaks were measured."""
    return model_modes(setting, world, _points(setting, world, setting.campaign.robot_frequencies.state))


def strays_in(setting: Setting, world: World) -> float:
    """Expected number of peaks that are no mode of a world, roughly."""
    return rough_strays(setting, _points(setting, world, setting.campaign.robot_frequencies.state))


def with_equilibria(setting: Setting, world: World) -> Setting:
    """First-order changes of locked poses and of those that commands mean start from equilibria in this world."""
    if np.any(world.nonlinearity):
        return replace(setting, locked_at=None, sent_at=None)
    locked_at = sent_at = None
    wide, readings = world.per_state(), Readings.of(setting.campaign.states)
    if setting.locked.size:
        own, part = world_of_states(wide, setting.locked), readings_of_states(readings, setting.locked)
        locked_at = reference(own, part, at_states(setting, setting.locked))
    if setting.sent.null_space.any():
        sent_at = reference(*as_sent(setting, wide, readings))
    return replace(setting, locked_at=locked_at, sent_at=sent_at)


def _conditioned(setting: Setting, world: World, some: np.ndarray) -> Conditioned:
    """Some states, in ascending order, while vibration is measured."""
    return resting_and_vibrating(setting, world.per_state(), Readings.of(setting.campaign.states), some)[1]


def _points(setting: Setting, world: World, states: np.ndarray) -> dict[int, OperatingPoint]:
    """Operating point of each state."""
    some = np.unique(states)
    campaign, state = setting.campaign, _conditioned(setting, world, some)
    robot = robot_of(campaign.robot, world)
    given = {"frame_compliance": np.maximum(world.frame_compliance, 0.0), "hose": np.maximum(world.hose, 0.0)}
    if any(np.any(value) for value in given.values()):
        more = Extensions.of(world.cables, {**given, "hose_center": setting.known.center})
        robot = replace(robot, extensions=more)
    payload = campaign.states.payload + np.maximum(world.sensor_mass, 0.0)
    return {int(i): _point(robot, state, k, payload[i]) for k, i in enumerate(some)}


def _point(robot: Robot, state: Conditioned, i: int, payload: float) -> OperatingPoint:
    cables = state.cables.at(i)
    return OperatingPoint(robot.with_load(float(payload)), state.position[i], state.rotation[i], cables)


def _labels(setting: Setting) -> Labels:
    m = setting.campaign.robot.platform_anchors.shape[0]
    block: list[str] = []
    state: list[int] = []
    cable: list[int] = []

    def add(name: str, states: np.ndarray, cables: list[int]) -> None:
        for i in states:
            block.extend([name] * len(cables))
            state.extend([int(i)] * len(cables))
            cable.extend(cables)

    add("EQ", setting.held, [-1] * 6)
    add("CO", setting.held[setting.with_length], list(range(m)))
    if setting.sent.null_space.any():
        add("NS", setting.held[~setting.with_length], [-1] * setting.sent.null_space.shape[-1])
    add("LP", setting.locked, [-1] * 6)
    for i, c in zip(setting.cable_rows.state, setting.cable_rows.cable, strict=True):
        add("CF", np.array([i]), [int(c)])
    for i in setting.campaign.robot_frequencies.state:
        add("RF", np.array([i]), [-1])
    add("FA", setting.campaign.robot_frequencies.state[setting.constants.peak], [-1])
    return Labels(np.array(block, dtype=object), np.array(state, dtype=int), np.array(cable, dtype=int))
