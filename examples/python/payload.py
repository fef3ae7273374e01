"""How do payloads change the first frequencies of the platform? Run: python examples/python/payload.py"""

import pandas as pd

import cdpr_struct as cs


def main() -> None:
    robot = cs.load_robot("six-cable-4mm")
    tables = []
    for payload in (0.0, 10.0, 20.0):
        modes = cs.modes(robot, payload=payload, model="static").frame()
        tables.append(modes.set_index("mode")["frequency_hz"].rename(f"{payload:g} kg"))
    print(pd.concat(tables, axis=1).round(3))


if __name__ == "__main__":
    main()
