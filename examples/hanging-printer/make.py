"""SIMULATED measurements: the ceiling beam of a hanging printer bends, which nobody entered.

    python examples/hanging-printer/make.py [DIR]

Writes the CSV files of this example (to its own folder, or DIR). The measured printer is the finite-element model of
`fem_reference`; nothing of the diagnosis is used. Hidden in it:

- The three upper lines hang from the middle of a ceiling beam of timber, 45 x 95 mm on edge, 10 GPa, 3.5 m between its
  walls. It bends down and up, and does not give way sideways.
- Every anchor, stiffness and mass is off by a draw from the tolerances of the robot file.

At home, where the nozzle touches the bed, the builder tightened the six lower lines to 40 N or a little more each and
set the counters to zero. After that each motor winds what straight lines of the entered robot ask for; lines of one
motor are wound alike. `points.csv` are fourteen points, `hung.csv` four of them with a weight of 1 kg on the effector,
motors held. `pulls.csv` are the tensions of all lines at the fourteen points, by a gauge that is hung into a line.
`beam.csv` is what a ruler beside the beam says while weights hang from its middle, without the printer. `later.csv` is
no part of a campaign: six more points, to see who predicts them.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

HERE = Path(__file__).parent
E_I, SPAN = 10e9 * 0.045 * 0.095**3 / 12.0, 3.5  # N m^2, m, of the beam along x
LOWER, UPPER = range(6), (6, 7, 8)  # lines from below, from the ceiling
PULL = 40.0  # N, of each lower line at home
ANCHOR, MASS, CENTER, STIFFNESS, DENSITY = 0.002, 0.05, 0.005, 0.15, 0.15  # tolerances: m, kg, m, relative
RULER, COUNTER, LEVEL, GAUGE = 0.0005, 0.0002, 0.2, 1.0  # m, m, degrees, N: sigmas
BEAM_LOADS, GRAVITY = (5.0, 10.0, 15.0), 9.81  # kg, m/s^2
DEAD_BAND = 3.0  # N, below which the gauge says nothing
POINTS = [
    *((x, y, 0.02) for x, y in ((0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5))),
    *((x, y, 0.4) for x, y in ((0.0, 0.0), (0.4, 0.3), (-0.4, 0.3), (0.4, -0.3), (-0.4, -0.3))),
    *((x, y, 0.8) for x, y in ((0.0, 0.0), (0.3, 0.0), (-0.3, 0.0), (0.0, 0.3), (0.0, -0.3))),
]  # fmt: skip
HUNG, WEIGHT = (0, 4, 6, 9), 1.0  # points with a weight, kg
LATER = [(0.25, 0.25, 0.1), (-0.25, 0.4, 0.1), (0.0, -0.4, 0.25), (0.2, 0.2, 0.6), (-0.2, -0.2, 0.6), (0.1, 0.0, 1.0)]
SEED, ELEMENTS = 1, 10


def ceiling(anchors: np.ndarray) -> fem.SurroundingsData:
    """The beam over the upper lines, exits where they are along x: deflection at one by 1 N at another."""
    place = anchors[list(UPPER), 0] + 0.5 * SPAN
    left, right = np.minimum.outer(place, place), SPAN - np.maximum.outer(place, place)
    flexibility = right * left * (SPAN**2 - right**2 - left**2) / (6.0 * E_I * SPAN)
    return fem.SurroundingsData(beams=(fem.carrying_beam(UPPER, np.array([0.0, 0.0, 1.0]), flexibility),))


def real_robot(entered: Robot, noise: np.random.Generator) -> Robot:
    """The printer as it was built: within tolerances of what was entered."""
    m = len(entered.cables)
    shares = 0.5**0.5 * (noise.normal(0.0, 1.0, 2) + noise.normal(0.0, 1.0, (m, 2)))
    cables = tuple(
        replace(
            c, axial_stiffness=c.axial_stiffness * np.exp(STIFFNESS * own[0]),
            linear_density=c.linear_density * np.exp(DENSITY * own[1]),
        )
        for c, own in zip(entered.cables, shares, strict=True)
    )  # fmt: skip
    body = replace(
        entered.platform, mass=entered.platform.mass + noise.normal(0.0, MASS),
        center_of_mass=entered.platform.center_of_mass + noise.normal(0.0, CENTER, 3),
    )  # fmt: skip
    off = noise.normal(0.0, ANCHOR, (2, m, 3))
    return replace(
        entered, platform=body, cables=cables, frame_anchors=entered.frame_anchors + off[0],
        platform_anchors=entered.platform_anchors + off[1],
    )  # fmt: skip


def straight(entered: Robot, place: np.ndarray) -> np.ndarray:
    """(m,) [m] straight lines of the entered, level effector at a place."""
    return np.asarray(np.linalg.norm(entered.frame_anchors - entered.platform_anchors - place, axis=1))


def at_rest(real: Robot, lengths: np.ndarray, payload: float, near: np.ndarray) -> fem.RobotEquilibrium:
    """Where the real printer rests with its motors held."""
    data = replace(to_fem(real.with_load(payload), lengths), surroundings=ceiling(real.frame_anchors))
    return fem.solve_robot(data, near, np.eye(3), ELEMENTS)


def at_home(real: Robot) -> np.ndarray:
    """(m,) [m] lengths with the nozzle on the bed, lower lines pulling with 40 N or a little more."""
    pulling = tuple(replace(c, force_min=PULL if i in LOWER else 0.0) for i, c in enumerate(real.cables))
    lengths = np.array(inverse(replace(real, cables=pulling), np.zeros(3), np.eye(3)).lengths)
    for _ in range(3):  # the upper motor lifts what the beam lets sink
        lengths[list(UPPER)] += at_rest(real, lengths, 0.0, np.zeros(3)).position[2]
    return lengths


def tables(noise: np.random.Generator) -> dict[str, pd.DataFrame]:
    """All readings, by file name."""
    entered = load_robot(HERE / "robot.toml")
    real = real_robot(entered, noise)
    home, motor = at_home(real), [0, 0, 1, 1, 2, 2, 3, 3, 3]
    jobs = [("home.csv", "home", np.zeros(3), 0.0)]
    jobs += [("points.csv", f"point {k + 1}", np.array(p), 0.0) for k, p in enumerate(POINTS)]
    jobs += [("hung.csv", f"point {k + 1} hung", np.array(POINTS[k]), WEIGHT) for k in HUNG]
    jobs += [("later.csv", f"later {k + 1}", np.array(p), 0.0) for k, p in enumerate(LATER)]
    rows: dict[str, list[list[object]]] = {}
    pulls, gauge = [], np.random.default_rng([SEED, 1])
    for name, case, place, payload in jobs:
        wound = straight(entered, place) - straight(entered, np.zeros(3))
        rest = at_rest(real, home + wound, payload, place)
        seen = rest.position + noise.normal(0.0, RULER, 3)
        angles: list[object] = [np.nan] * 3
        if name == "home.csv":
            turned = Rotation.from_matrix(rest.rotation).as_euler("ZYX", degrees=True)[::-1]
            angles = list(turned + noise.normal(0.0, LEVEL, 3))
        if name == "points.csv":
            held = np.linalg.norm([cable.end_force for cable in rest.cables], axis=1)
            said = held + gauge.normal(0.0, GAUGE, len(held))
            pulls.append([case, *seen, *[np.nan] * 3, *np.where(said > DEAD_BAND, said, np.nan)])
        read = wound + noise.normal(0.0, COUNTER, 4)[motor]
        rows.setdefault(name, []).append([case, *seen, *angles, payload, *read])
    pose, lines = ["case", "x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg"], range(1, len(entered.cables) + 1)
    columns = [*pose, "payload_kg", *(f"length_{i}_m" for i in lines)]
    found = {name: pd.DataFrame(own, columns=columns) for name, own in rows.items()}
    pushed = SPAN**3 / (48.0 * E_I) * GRAVITY * np.array(BEAM_LOADS)  # a point load in the middle
    sunk = pushed + gauge.normal(0.0, RULER, len(BEAM_LOADS))
    found["beam.csv"] = pd.DataFrame({"load_kg": BEAM_LOADS, "sunk_mm": 1e3 * sunk})
    return {**found, "pulls.csv": pd.DataFrame(pulls, columns=[*pose, *(f"tension_{i}_N" for i in lines)])}


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in tables(np.random.default_rng(SEED)).items():
        table.round(6).to_csv(folder / name, index=False, lineterminator="\n")
        print(f"wrote {folder / name}, {len(table)} rows")
