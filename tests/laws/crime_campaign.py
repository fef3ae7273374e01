"""Campaigns made by the diagnosing model itself (crime=True): for unit tests of causes only, never for claims.

Readings are those that a world would give, without noise or with the campaign's own.
"""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.conditioned_state import condition, unbalanced
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import make_setting, modes_in
from cdpr_struct.diagnosis.world import World
from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies, States, Tolerances
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

CRIME = True
NO_CABLES = CableFrequencies(*(np.zeros(0, dtype=t) for t in (int, int, int, bool, float, float)))
NO_ROBOT = RobotFrequencies(*(np.zeros(0, dtype=t) for t in (int, float, float)))


def clean_campaign(count: int = 6, seed: int = 1) -> Campaign:
    """Static states of the robot as entered, with one in-plane frequency of each cable at two of them."""
    robot, generator = load_robot("cogiro"), np.random.default_rng(seed)
    m = len(robot.cables)
    position = robot.home.position + generator.uniform(-1.0, 1.0, (count, 3)) * [2.0, 1.5, 0.8]
    angles = np.radians(generator.uniform(-10.0, 10.0, (count, 3)))
    turn = np.array([rotation(*a) for a in angles])
    payload = np.resize([0.0, 20.0, 40.0], count)
    held = [inverse(robot.with_load(w), p, r) for w, p, r in zip(payload, position, turn, strict=True)]
    states = States(
        names=tuple(f"s{i}" for i in range(count)), position=position, angles=angles,
        sigma_position=np.full(count, 5e-4), sigma_rotation=np.full(count, 3.5e-4), payload=payload,
        tension=np.array([h.tensions for h in held]), tension_sigma=np.full((count, m), 2.0),
        length=np.array([h.lengths for h in held]), length_sigma=np.full((count, m), 5e-4), lock=np.arange(count),
        loaded=np.zeros(count, dtype=bool), static=np.ones(count, dtype=bool), temperature=np.full(count, np.nan),
        approach=np.full((count, m), np.nan), time=np.full(count, np.nan),
    )  # fmt: skip
    bare = Campaign("crime", robot, "cogiro", "dsm", Tolerances(), frozenset(), states, NO_CABLES, NO_ROBOT)
    return with_cable_frequencies(bare, (0, 1))


def with_cable_frequencies(campaign: Campaign, states: tuple[int, ...]) -> Campaign:
    """The first two in-plane modes of every cable at some states, as the model has them."""
    m = len(campaign.robot.cables)
    state, cable, mode = (a.ravel() for a in np.meshgrid(states, np.arange(m), [1, 2], indexing="ij"))
    guess = 4.0 * mode  # near enough to say how many modes must be resolved
    rows = CableFrequencies(state, cable, mode, np.ones(state.size, dtype=bool), guess, 0.003 * guess)
    return measured_in(replace(campaign, cable_frequencies=rows), World.of(campaign.robot, len(campaign.states.names)))


def with_robot_frequencies(campaign: Campaign, states: tuple[int, ...], truth: World) -> Campaign:
    """Frequencies of a world at some states: those of modes in which the platform moves."""
    state = np.array(states)
    guess = RobotFrequencies(state, np.full(state.size, 6.5), np.full(state.size, 0.02))
    setting, _ = make_setting(replace(campaign, robot_frequencies=guess))
    own = modes_in(setting, truth).modes
    own = own.some(np.flatnonzero(own.energy > 0.4))
    return replace(campaign, robot_frequencies=RobotFrequencies(own.state, own.hertz, 0.003 * own.hertz))


def measured_in(campaign: Campaign, world: World) -> Campaign:
    """The campaign whose cable frequencies are those of a world, everything else unchanged."""
    setting, _ = make_setting(campaign)
    r = residuals(setting, world, Readings.of(campaign.states))[setting.labels.block == "CF"]
    rows = campaign.cable_frequencies
    hertz = rows.hertz * np.exp(-r / 100.0)
    return replace(campaign, cable_frequencies=replace(rows, hertz=hertz, sigma=0.003 * hertz))


def hidden(world_of) -> Campaign:
    """Readings of a world in which `world_of(world)` is true: pose kept, tensions rebalanced, lengths compatible."""
    campaign = clean_campaign()
    truth = world_of(World.of(campaign.robot, len(campaign.states.names)))
    setting, _ = make_setting(campaign)
    tension, known, wide = campaign.states.tension.copy(), setting.known, truth.per_state()
    for _ in range(4):
        readings = replace(Readings.of(campaign.states), tension=tension)
        state = condition(wide, readings, known)
        left = unbalanced(wide, state, known)
        unit = state.cables.force_on_platform / state.tension[..., None]
        matrix = np.swapaxes(np.concatenate([unit, np.cross(state.arms, unit)], axis=-1), -1, -2)
        step = -(np.linalg.pinv(matrix) @ left[..., None])[..., 0]
        tension = (state.tension + step) * (1.0 + truth.friction * known.approach) * truth.cell_gain + truth.cell_bias
    state = condition(wide, replace(Readings.of(campaign.states), tension=tension), known)
    length = (state.cables.total_length - truth.length_offset) / truth.length_scale
    states = replace(campaign.states, tension=tension, length=length)
    return measured_in(replace(campaign, states=states), truth)
