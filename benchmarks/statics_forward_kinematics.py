"""How many poses a second does the forward kinematics solve, beside MoorPy's system equilibrium?

Fixed case: the eight-cable robot of Table 3.1, 4 mm cables, 60 kg, poses x, y in -3..3 m at z = 0.5 m, cable lengths
of the ideal model, every solver started at the reference pose. One core. Run:

    pip install moorpy && OMP_NUM_THREADS=1 python benchmarks/statics_forward_kinematics.py

asv-shaped: `setup`, `time_*`, `params`, `param_names`. Both answers are compared.
"""

import statistics
import time
import warnings

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.pose_error import pose_error, reference_lengths

SEA_LEVEL = 20.0  # MoorPy wants everything below the water line; the water has no density here
MOORPY_TOLERANCE = 1e-6  # [m]
REPEATS = 5


def grid(count: int) -> np.ndarray:
    """(count^2, 3) poses."""
    x, y = np.meshgrid(*[np.linspace(-3.0, 3.0, count)] * 2, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.5)], axis=-1)


class ForwardKinematics:
    """Poses a second; the parameter is the number of poses along each side of the map."""

    params = (5, 61)
    param_names = ("poses_a_side",)

    def setup(self, poses_a_side: int) -> None:
        self.robot = load_robot("thesis-3-1")
        self.poses = grid(poses_a_side)
        self.lengths = reference_lengths(self.robot, self.poses, np.eye(3))

    def time_batched(self, poses_a_side: int) -> None:
        """Sagging model, all poses at once."""
        forward(self.robot, self.lengths, self.poses)

    def time_pose_error_map(self, poses_a_side: int) -> None:
        """Sagging and spring model with continuation: the map of figs 3.4-3.7."""
        pose_error(self.robot, self.poses, np.eye(3))


class MoorPyEquilibrium:
    """The peer on the same robot, pose by pose."""

    params = (5,)
    param_names = ("poses_a_side",)

    def setup(self, poses_a_side: int) -> None:
        self.robot = load_robot("thesis-3-1")
        self.poses = grid(poses_a_side)
        self.lengths = reference_lengths(self.robot, self.poses, np.eye(3))
        self.systems = [moorpy_system(self.robot, *case) for case in zip(self.poses, self.lengths, strict=True)]

    def time_one_by_one(self, poses_a_side: int) -> None:
        """Analytic stiffness, as MoorPy solves by default."""
        self.positions = np.array([moorpy_position(s, p) for s, p in zip(self.systems, self.poses, strict=True)])


def moorpy_system(robot: Robot, pose: np.ndarray, lengths: np.ndarray):
    """MoorPy model of a robot: a body on lines, in water without density."""
    import moorpy

    shift = np.array([0.0, 0.0, -SEA_LEVEL])
    system = moorpy.System(depth=100.0, rho=0.0, g=robot.gravity)
    for i, cable in enumerate(robot.cables):
        weight = cable.linear_density * robot.gravity
        kind = dict.fromkeys(("d_vol", "input_d"), 0.004) | dict.fromkeys(("BA", "EAd", "EAd_Lm", "Cd", "CdAx"), 0.0)
        kind |= {"name": f"cable {i}", "m": cable.linear_density, "w": weight, "EA": cable.axial_stiffness}
        system.lineTypes[f"cable {i}"] = kind | {
            "input_type": "x",
            "material": "x",
            "MBL": 1e9,
            "cost": 0.0,
            "Ca": 1.0,
            "CaAx": 0.0,
        }
    system.addBody(0, np.r_[pose + shift, 0, 0, 0], m=robot.platform.mass, v=0.0, rCG=robot.platform.center_of_mass)
    for i, anchor in enumerate(robot.platform_anchors):
        system.addPoint(1, robot.frame_anchors[i] + shift)
        system.addPoint(1, pose + shift + anchor)
        system.bodyList[0].attachPoint(2 * i + 2, anchor)
        system.addLine(lengths[i], f"cable {i}", pointA=2 * i + 1, pointB=2 * i + 2)
    system.initialize()
    return system


def moorpy_position(system, pose: np.ndarray) -> np.ndarray:
    """Equilibrium position started at a pose [m]."""
    body = system.bodyList[0]
    body.setPosition(np.r_[pose - [0.0, 0.0, SEA_LEVEL], 0, 0, 0])
    system.solveEquilibrium(tol=MOORPY_TOLERANCE, maxIter=500, no_fail=False, finite_difference=False)
    return np.array([0.0, 0.0, SEA_LEVEL]) + body.r6[:3]


def median_seconds(function, *arguments) -> float:
    """Median of `REPEATS` runs [s]."""
    seconds = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        function(*arguments)
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds)


def main() -> None:
    """Print both, side by side."""
    warnings.simplefilter("ignore")
    ours, peer = ForwardKinematics(), MoorPyEquilibrium()
    peer.setup(5)
    peer_rate = len(peer.poses) / median_seconds(peer.time_one_by_one, 5)
    print(f"MoorPy equilibrium, one by one   {peer_rate:10.1f} poses/s")
    for count in ours.params:
        ours.setup(count)
        rate = len(ours.poses) / median_seconds(ours.time_batched, count)
        print(
            f"batched forward, {count:2d} x {count:2d} poses  {rate:10.1f} poses/s, {rate / peer_rate:.0f} times MoorPy"
        )
    print(f"pose-error map, 61 x 61 poses    {median_seconds(ours.time_pose_error_map, 61):10.2f} s")
    ours.setup(5)
    difference = np.abs(forward(ours.robot, ours.lengths, ours.poses).position - peer.positions).max()
    print(f"largest difference of position   {difference:10.1e} m")


if __name__ == "__main__":
    main()
