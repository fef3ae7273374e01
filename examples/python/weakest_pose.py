"""Where in the workspace is the platform softest, and which forces hold it there?

Run: python examples/python/weakest_pose.py
"""

import cdpr_struct as cs


def main() -> None:
    robot = cs.load_robot("thesis-3-1")
    found = cs.map(robot, "-3:3:13,-3:3:13,0.5", "stiffness-min")
    table = found.frame()
    worst = table.loc[table["stiffness_min_N_mm"].idxmin()]
    print(found)
    held = cs.inverse(robot, worst[["x_m", "y_m", "z_m"]])
    print(held)
    found.plot().plot(worst["x_m"], worst["y_m"], "r+", markersize=12)
    held.plot().figure.savefig("held.svg")


if __name__ == "__main__":
    main()
