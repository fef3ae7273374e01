"""SIMULATED measurements: the beam that carries the motors of a router on two chains bends, which nobody entered.

    python examples/two-chain-router/make.py [DIR]

Writes the CSV files of this example (to its own folder, or DIR). The measured machine is the finite-element model of
`fem_reference`; nothing of the diagnosis is used. Hidden in it:

- Both motors sit on the ends of a beam of timber, 38 x 89 mm laid flat, 10 GPa, which lies on two posts 2.1 m apart and
  sticks out by 0.45 m on either side. The ends sink; they do not give way sideways.
- The chains sag and stretch. The firmware takes them for straight lines.
- Every anchor, length, stiffness and mass is off by a draw from the tolerances of the robot file.

The motors were measured without the sled. Friction of the sled on the sheet is left out. `holes.csv` are twelve holes,
`weighted.csv` six of the same commands with 5 kg more on the sled. `motors.csv` are the heights of the motors while the
sled hangs in the middle, read with a level. `later.csv` is no part of a campaign: six more holes, to see who predicts
them.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

import cdpr_struct as cs
import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot

HERE = Path(__file__).parent
E_I = 10e9 * 0.089 * 0.038**3 / 12.0  # N m^2, of the beam
SPAN, OVERHANG = 2.1, 0.45  # m
ANCHOR, ZERO, MASS, CENTER = 0.0015, 0.001, 0.1, 0.005  # tolerances: m, m, kg, m
STIFFNESS, DENSITY = 0.1, 0.03  # relative
TAPE, ENCODER, LEVEL = 0.001, 0.0001, 0.0005  # m, sigmas
HOLES = [(x, 1.11 + z) for z in (0.45, 0.0, -0.45) for x in (-1.05, -0.35, 0.35, 1.05)]
WEIGHTED, WEIGHT = (0, 2, 3, 5, 8, 11), 5.0  # holes drilled again, kg on the sled
LATER = [(-0.7, 1.335), (0.0, 1.335), (0.7, 1.335), (-0.7, 0.885), (0.0, 0.885), (0.7, 0.885)]
SEED, ELEMENTS = 1, 40


def beam() -> tuple[float, float]:
    """Sinking of an end under 1 N on it, and under 1 N on the other end [m]: a beam on two posts that sticks out."""
    own = OVERHANG**2 * (SPAN + OVERHANG) / (3.0 * E_I)
    return own, OVERHANG**2 * SPAN / (6.0 * E_I)


def real_robot(entered: Robot, noise: np.random.Generator) -> Robot:
    """The machine as it was built: within tolerances of what was entered."""
    reel = noise.normal(0.0, 1.0, 2)
    shares = 0.5**0.5 * (reel + noise.normal(0.0, 1.0, (2, 2)))
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
    off = noise.normal(0.0, ANCHOR, (2, 2, 3))
    return replace(
        entered, platform=body, cables=cables, frame_anchors=entered.frame_anchors + off[0],
        platform_anchors=entered.platform_anchors + off[1],
    )  # fmt: skip


def commanded(entered: Robot, hole: tuple[float, float]) -> np.ndarray:
    """Lengths (2,) [m] that the firmware sends for a hole: straight chains."""
    return np.array(cs.inverse(entered, [hole[0], 0.0, hole[1]], free="ry", model="spring").answer["lengths_m"])


def drilled(real: Robot, lengths: np.ndarray, payload: float, near: tuple[float, float]) -> fem.RobotEquilibrium:
    """Where the real machine holds the cutter with these lengths paid out."""
    own, other = beam()
    top = fem.carrying_beam((0, 1), np.array([0.0, 0.0, 1.0]), np.array([[own, other], [other, own]]))
    data = replace(to_fem(real.with_load(payload), lengths), surroundings=fem.SurroundingsData(beams=(top,)))
    return fem.solve_robot(data, np.array([near[0], 0.0, near[1]]), np.eye(3), ELEMENTS)


def tables(noise: np.random.Generator) -> dict[str, pd.DataFrame]:
    """All readings, by file name."""
    entered = load_robot(HERE / "robot.toml")
    real, zero = real_robot(entered, noise), noise.normal(0.0, ZERO, 2)
    rows: dict[str, list[list[object]]] = {"holes.csv": [], "weighted.csv": [], "later.csv": []}
    jobs = [("holes.csv", k, hole, 0.0) for k, hole in enumerate(HOLES)]
    jobs += [("weighted.csv", k, HOLES[k], WEIGHT) for k in WEIGHTED]
    jobs += [("later.csv", len(HOLES) + k, hole, 0.0) for k, hole in enumerate(LATER)]
    for name, k, hole, payload in jobs:
        lengths = commanded(entered, hole)
        rest = drilled(real, lengths + zero, payload, hole)
        x, _, z = rest.position + noise.normal(0.0, TAPE, 3)
        said = lengths + noise.normal(0.0, ENCODER, 2)
        case = f"hole {k + 1}" + (f", {payload:g} kg more" if payload else "")
        rows[name].append([case, x, 0.0, z, np.nan, *said, payload])
    columns = ["case", "x_m", "y_m", "z_m", "ry_deg", "length_1_m", "length_2_m", "payload_kg"]
    found = {name: pd.DataFrame(own, columns=columns) for name, own in rows.items()}
    middle = (0.0, 1.11)
    rest = drilled(real, commanded(entered, middle) + zero, 0.0, middle)
    heights = np.array([cable.nodes[0, 2] for cable in rest.cables]) + noise.normal(0.0, LEVEL, 2)
    return {**found, "motors.csv": pd.DataFrame({"motor": ["left", "right"], "z_m": heights})}


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in tables(np.random.default_rng(SEED)).items():
        table.round(6).to_csv(folder / name, index=False, lineterminator="\n")
        print(f"wrote {folder / name}, {len(table)} rows")
