"""What does each model miss? Prints the table of docs/choosing_a_model.md. Run: python examples/models/compare.py"""

import numpy as np

import cdpr_struct as cs

ROBOTS = ("thesis-3-1", "thesis-3-1-8mm", "cogiro", "six-cable-4mm", "examples/box-robot/robot.toml")
COUNT = 40


def row(name: str) -> list[str]:
    """Cells of one robot at its home pose."""
    exact = cs.modes(name, count=COUNT).frame()["frequency_hz"].to_numpy()
    closed = cs.modes(name, count=COUNT, model="dsm", force=True).frame()["frequency_hz"].to_numpy()
    printed = cs.modes(name, count=COUNT, assembly="thesis").frame()["frequency_hz"].to_numpy()
    static = cs.modes(name, model="static").frame()["frequency_hz"].to_numpy()
    hanging, straight = cs.inverse(name).frame(), cs.inverse(name, model="spring").frame()
    length = 1e3 * np.abs(hanging["length_m"] - straight["length_m"]).max()
    tension = np.abs(hanging["tension_N"] - straight["tension_N"]).max()
    return [
        name.split("/")[-2] if "/" in name else name,
        f"{exact[0]:.3f}",
        f"{static[0]:.3f}",
        f"{100.0 * np.abs(closed / exact - 1.0).max():.2f}",
        f"{100.0 * np.abs(printed / exact - 1.0).max():.2f}",
        f"{length:.2f}",
        f"{tension:.1f}",
    ]


def main() -> None:
    for name in ROBOTS:
        print("| " + " | ".join(row(name)) + " |")


if __name__ == "__main__":
    main()
