"""A short name of everything that a result depends on."""

import hashlib
from dataclasses import fields
from importlib.metadata import version

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays


def fingerprint(label: str, *parts: Robot | np.ndarray | bytes) -> str:
    """Hexadecimal digest of version, label, robots, arrays and files; equal where all of them are."""
    digest = hashlib.sha256(f"{version('cdpr-struct')} {label}".encode())
    for part in parts:
        for array in _arrays(part):
            digest.update(f"{array.shape}".encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:16]


def _arrays(part: Robot | np.ndarray | bytes) -> list[np.ndarray]:
    if isinstance(part, bytes):
        return [np.frombuffer(part, dtype=np.uint8)]
    if isinstance(part, np.ndarray):
        return [part]
    arrays = RobotArrays.of(part)
    found = [np.asarray(getattr(arrays, f.name), dtype=float) for f in fields(arrays)]
    if part.shared_winches:
        found += [part.winches.share, part.winches.offset]
    return found
