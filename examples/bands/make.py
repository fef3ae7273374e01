"""Readings of a robot whose cables are stiffer than entered, by finite elements: `python examples/bands/make.py`."""

from dataclasses import replace
from pathlib import Path

import numpy as np

import cdpr_struct as cs

STIFFER = 1.12
HERE = Path(__file__).parent


def main() -> None:
    """Write measured.csv beside this file."""
    entered = cs.load_robot(HERE / "robot.toml")
    lengths = cs.inverse(entered).answer["lengths_m"]
    cables = tuple(replace(cable, axial_stiffness=STIFFER * cable.axial_stiffness) for cable in entered.cables)
    true = cs.modes(replace(entered, cables=cables), lengths=lengths, start=entered.home, model="fem", count=24)
    noise = np.random.default_rng(35)
    seen = np.flatnonzero(true.answer["platform_energy"] > 0.5)[:4]
    rows = ["frequency_hz,cable,tension_N,z_m,sigma"]
    rows += [f"{true.answer['frequencies_hz'][i] * (1 + 0.002 * noise.standard_normal()):.4f},,,," for i in seen]
    rows += [
        f",{number},{tension + noise.standard_normal():.1f},,1.0"
        for number, tension in enumerate(true.answer["tensions_N"], start=1)
    ]
    rows.append(f",,,{true.answer['pose'][2] + 3e-4 * noise.standard_normal():.4f},0.0003")
    (HERE / "measured.csv").write_text("\n".join(rows) + "\n", "utf-8")


if __name__ == "__main__":
    main()
