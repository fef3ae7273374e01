"""Frequencies found in the signals of a campaign become robot frequencies of its states."""

import numpy as np
from joblib import Parallel, delayed

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_cases import Gathering
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.signal_records import SignalRecord
from cdpr_struct.measurement.signal_states import held_against, own_modes, placed_records, platform_shape
from cdpr_struct.robot.robot import Robot

_SAME_POSE = 1e-6
_FEW = 3  # records that are identified sooner than other processes have started


def join_signals(gathering: Gathering, robot: Robot, model: str) -> tuple[Identified, ...]:
    """Identify the modes of all signals; those that are clear join the gathered frequencies.

    Raises
    ------
    InputError : rows that do not make records, or a pose that contradicts another file's for the same case.
    """
    poses = {
        name: np.concatenate([s.pose[:3], np.radians(s.pose[3:]), [s.payload]]) for name, s in gathering.known.items()
    }
    _check_known(gathering, poses)
    placed = [
        (record, sigmas) for series, sigmas in gathering.series for record in placed_records(series, robot, poses)
    ]
    for record, _ in placed:
        _check_pose(record, poses)

    cores = -1 if len(placed) > _FEW else 1
    alone = Parallel(n_jobs=cores)(delayed(own_modes)(*one) for one in placed)
    found = [held_against(item, robot, model) for item in alone]
    for number, (item, (record, sigmas)) in enumerate(zip(found, placed, strict=True)):
        rows = [
            (float(item.modes.hertz[i]), float(item.sigma[i]), platform_shape(record, shape), (number, i))
            for i, shape in enumerate(item.modes.shape)
            if item.used[i]
        ]
        if rows:
            pose = np.concatenate([record.position, np.degrees(record.angles)])
            gathering.add_frequencies(record.case, pose, record.payload, record.lengths, sigmas, rows)
    return tuple(found)


def _check_known(gathering: Gathering, poses: dict[str, np.ndarray]) -> None:
    """Modes in signals are held against those of the model at the pose, which has to be known there."""
    for series, _ in gathering.series:
        for case in dict.fromkeys(series.case):
            if case in poses and not np.isfinite(poses[case]).all():
                expected = "a pose that was measured in full: position and angles"
                raise InputError(series.file, f"case {case}", "a pose with empty cells in another file", expected)


def _check_pose(record: SignalRecord, poses: dict[str, np.ndarray]) -> None:
    known = poses.get(record.case)
    if known is None or record.kind == "platform_motion":
        return
    own = np.concatenate([record.position, record.angles, [record.payload]])
    if np.isfinite(own).all() and np.abs(own - known).max() > _SAME_POSE:
        raise InputError(
            record.file, f"case {record.case}", own.round(6).tolist(),
            f"the pose and payload that another file gives for this case, {known.round(6).tolist()} (m, rad, kg)",
        )  # fmt: skip
