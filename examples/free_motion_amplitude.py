"""Do recorded free motions change their frequencies as large motion without friction does?

    python examples/free_motion_amplitude.py CAMPAIGN.toml

For every `platform_motion` recording whose frequencies were read in windows of its decay, the independent FEM
integrates the large, undamped motion of the platform at the amplitudes of the first and of the last window, cables
locked. Its frequencies are read from it as they are from the recording, and compared with those of the FEM's small
motion in the same steps.
What the recording changes beyond that is not the motion's size: friction, creep, or something that moved.

Cables leave the frame where they leave their pulleys at rest: large motion in the FEM knows no pulleys. Small motion
without and with them differs by 0.4 % at most in the recordings of `free_motion_campaign.py`; the shift by a motion's
size is a small share of the frequency, so that this matters little.
"""

import argparse
from pathlib import Path

import numpy as np

import fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.decay_modes import refine
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.signal_states import channel_weight

DURATION = 10.0  # s of motion
STEPS, SAMPLES = 160, 40  # integrated and read per period of the highest mode
BARS, BARS_ON_PULLEY = 2, 20  # per cable; heavy cables want more of the former
START = 0.002  # damping ratio at which the search for poles begins


def without_pulleys(point: OperatingPoint) -> fem.RobotEquilibrium:
    """The robot at rest as the FEM finds it, each cable held where it leaves its pulley."""
    whole = solve_in_fem(point, BARS_ON_PULLEY)
    data = whole.robot
    exits = np.array([cable.nodes[0] for cable in whole.cables])
    cables = tuple(
        fem.CableData(found.cable.unstrained_length, cable.axial_stiffness, cable.linear_density)
        for found, cable in zip(whole.cables, data.cables, strict=True)
    )
    held = fem.RobotData(exits, data.platform_anchors, cables, data.platform, data.gravity)
    return fem.solve_robot(held, whole.position, whole.rotation, BARS)


def large_motion_shifts(rest: fem.RobotEquilibrium, amplitudes: np.ndarray, reach: float) -> np.ndarray:
    """(k,) by which share the lowest k modes change their frequency when they swing together at amplitudes (k,) [m].

    reach : [m], at which turns count as displacements. All modes pass the rest at time zero.
    """
    modes = fem.robot_modes(rest, len(amplitudes))
    omega, shapes = 2.0 * np.pi * modes.frequencies_hz, modes.platform_shapes
    weight = np.array([1.0] * 3 + [reach] * 3)
    scale = omega * amplitudes / np.linalg.norm(shapes * weight, axis=1)
    small = np.where(amplitudes > 0.0, scale, omega * 1e-3 * amplitudes.max())
    step = 1.0 / (STEPS * modes.frequencies_hz[-1])
    found = []
    for twist, linear in ((small @ shapes, True), (scale @ shapes, False)):
        history = fem.integrate(rest, DURATION, step, initial_velocity=twist, linear=linear)
        motion = (history.platform - history.platform.mean(axis=0)) * weight
        every = STEPS // SAMPLES
        read = refine(history.time[::every], motion[::every], omega * (1j - START))
        found.append(read.hertz[[np.abs(np.log(read.hertz / f)).argmin() for f in modes.frequencies_hz]])
    share: np.ndarray = found[1] / found[0] - 1.0
    return share


def changes(item: Identified) -> list[tuple[int, float, float, float, float]]:
    """Per mode clear in the first and last window: its number, amplitudes [m] there, and by which share the
    frequency rises between them, as recorded and as the FEM has it."""
    if item.state is None or item.windows is None or len(item.windows.middle) < 2:
        return []
    weight = channel_weight(item.state, item.record)
    size = np.linalg.norm(item.windows.amplitude * weight, axis=2)[[0, -1]]
    hertz = item.windows.hertz[[0, -1]]
    clear = [i for i in np.flatnonzero(item.used) if item.partner[i] >= 0 and np.isfinite(hertz[:, i]).all()]
    if not clear:
        return []
    number = item.partner[clear]
    amplitudes = np.zeros((2, number.max() + 1))
    amplitudes[:, number] = size[:, clear]
    rest = without_pulleys(item.state.point)
    first, last = (large_motion_shifts(rest, each, float(weight[-1])) for each in amplitudes)
    return [
        (int(p), *size[:, i].tolist(), float(hertz[1, i] / hertz[0, i] - 1.0), float(last[p] - first[p]))
        for i, p in zip(clear, number, strict=True)
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("campaign", type=Path)
    try:
        campaign = load_campaign(parser.parse_args().campaign)
    except CdprError as error:
        parser.error(str(error))
    items = [item for item in campaign.identified if item.record.kind == "platform_motion"]
    if not items:
        parser.error(f"{campaign.source}: no measurement of kind platform_motion")
    print("From the first to the last window of the decay")
    print(f"{'case':12}{'mode':>6}{'from [mm]':>11}{'to [mm]':>9}{'recorded [%]':>14}{'large motion [%]':>18}")
    rows = []
    for item in items:
        for row in changes(item):
            rows.append(row)
            case, values = item.record.case, (row[0] + 1, *(1e3 * np.array(row[1:3])), *(100.0 * np.array(row[3:])))
            print(f"{case:12}{values[0]:6d}{values[1]:11.1f}{values[2]:9.1f}{values[3]:+14.2f}{values[4]:+18.2f}")
    if rows:
        recorded, expected = 100.0 * np.array(rows)[:, 3:].T
        rest = recorded - expected
        print(f"median {np.median(recorded):+.2f} % recorded, {np.median(expected):+.2f} % by the motion's size;")
        print(f"what is left: {np.median(rest):+.2f} %, upwards in {(rest > 0.0).sum()} of {len(rest)} modes")


if __name__ == "__main__":
    main()
