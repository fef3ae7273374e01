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
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import cdpr_struct.fem_reference as fem
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


@dataclass(frozen=True, slots=True)
class Change:
    """A mode in the first and in the last window of a decay, and how it changes between them.

    amplitude : [m], turns at the anchors' mean radius;  model : measured over modelled frequency less one
    large : by which share large motion of that amplitude shifts the frequency;  damping : ratio of the two ratios
    """

    mode: int
    amplitude: np.ndarray
    model: np.ndarray
    large: np.ndarray
    damping: float

    @property
    def recorded(self) -> float:
        """By which share the recorded frequency rises."""
        return float((1.0 + self.model[1]) / (1.0 + self.model[0]) - 1.0)

    @property
    def expected(self) -> float:
        """By which share it would rise without friction."""
        return float(self.large[1] - self.large[0])


def changes(item: Identified) -> list[Change]:
    """Every mode that is clear in the first and in the last window."""
    if item.state is None or item.windows is None or len(item.windows.middle) < 2:
        return []
    weight = channel_weight(item.state, item.record)
    size = np.linalg.norm(item.windows.amplitude * weight, axis=2)[[0, -1]]
    hertz, damping = item.windows.hertz[[0, -1]], item.windows.damping[[0, -1]]
    clear = [i for i in np.flatnonzero(item.used) if item.partner[i] >= 0 and np.isfinite(hertz[:, i]).all()]
    if not clear:
        return []
    number = item.partner[clear]
    amplitudes = np.zeros((2, number.max() + 1))
    amplitudes[:, number] = size[:, clear]
    rest = without_pulleys(item.state.point)
    large = np.array([large_motion_shifts(rest, each, float(weight[-1])) for each in amplitudes])
    model = item.state.hertz
    return [
        Change(int(p), size[:, i], hertz[:, i] / model[p] - 1.0, large[:, p], float(damping[1, i] / damping[0, i]))
        for i, p in zip(clear, number, strict=True)
    ]


def _middle(values: np.ndarray) -> str:
    return f"median {np.median(values):+.2f} %, of the size {np.median(np.abs(values)):.2f} %"


def print_summary(rows: list[Change]) -> None:
    """Medians over all modes, in per cent."""
    recorded, expected = (100.0 * np.array([getattr(r, name) for r in rows]) for name in ("recorded", "expected"))
    model, large = (100.0 * np.array([getattr(r, name) for r in rows]) for name in ("model", "large"))
    damping, rest = np.array([r.damping for r in rows]), recorded - expected
    print(f"median {np.median(recorded):+.2f} % recorded, {np.median(expected):+.2f} % by the motion's size;")
    print(f"what is left: {np.median(rest):+.2f} %, upwards in {(rest > 0.0).sum()} of {len(rows)} modes")
    for k, when in enumerate(("first", "last")):
        off, left = _middle(model[:, k]), _middle((model - large)[:, k])
        print(f"{when} window against the model: {off}; with large motion taken off {left}")
    print(f"damping ratio: {np.median(damping):.2f} times, larger in {(damping > 1.0).sum()} of {len(rows)} modes")


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
            first, last = 1e3 * row.amplitude
            moved = f"{100.0 * row.recorded:+14.2f}{100.0 * row.expected:+18.2f}"
            print(f"{item.record.case:12}{row.mode + 1:6d}{first:11.1f}{last:9.1f}{moved}")
    if rows:
        print_summary(rows)


if __name__ == "__main__":
    main()
