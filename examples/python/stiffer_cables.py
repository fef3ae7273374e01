"""What would cables of twice the stiffness gain? Changes a robot, writes it, and compares the pose errors.

Run: python examples/python/stiffer_cables.py
"""

from dataclasses import replace

import cdpr_struct as cs


def main() -> None:
    robot = cs.load_robot("thesis-3-1")
    cables = tuple(replace(cable, axial_stiffness=2.0 * cable.axial_stiffness) for cable in robot.cables)
    stiffer = replace(robot, name="thesis-3-1-stiff", cables=cables)
    path = cs.write_robot(stiffer, "stiff.toml", overwrite=True)
    for machine in (robot, cs.load_robot(path)):
        error = cs.pose_error(machine, "-3:3:7,-3:3:7,0.5", mass=30)
        print(f"{machine.name}: {error}")
    try:
        cs.inverse(stiffer, (50, 0, 0))
    except cs.UnholdablePoseError as reason:
        print("Far outside:", reason)


if __name__ == "__main__":
    main()
