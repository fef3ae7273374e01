"""The animated modes of a report page: the robot as data, and the script that moves it; nothing is loaded.

Shapes are sent as 16-bit numbers; the script computes every picture from them.
"""

import base64
import gzip
import json
from collections.abc import Mapping
from importlib import resources
from typing import Any

import jinja2
import numpy as np

from cdpr_struct.crosscheck.mode_motion import ModeMotion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.figures.robot_geometry import cable_curves, pulley_wheels, robot_geometry

FULL_SCALE = 32767
"""The whole number that stands for a component of 1."""
_DIGITS, _SHARE_DIGITS = 5, 4


def viewer_markup(point: OperatingPoint, result: Mapping[str, Any], motion: ModeMotion) -> str:
    """The viewer as HTML with style, data and script.

    result : as the command `modes` gives it
    """
    source = resources.files("cdpr_struct.reports.templates")
    style, script, page = (
        source.joinpath(f"mode_viewer.{kind}").read_text(encoding="utf-8") for kind in ("css", "js", "html.j2")
    )
    template = jinja2.Environment(autoescape=True, trim_blocks=True, undefined=jinja2.StrictUndefined).from_string(page)
    data = json.dumps(_robot(point, result, motion), allow_nan=False, separators=(",", ":"))
    return template.render(
        style=style, script=script, robot=data.replace("<", "\\u003c"), shapes=packed_shapes(point, motion),
        count=len(motion.platform),
    )  # fmt: skip


def packed_shapes(point: OperatingPoint, motion: ModeMotion) -> str:
    """Cables at rest (m, p, 3) as 32-bit floats [m], then every mode's points (m, p', 3) in 1 / `FULL_SCALE`; gzip,
    base64. A mode has every `stride`-th point."""
    rest = cable_curves(point, motion.fractions).astype("<f4").tobytes()
    whole = np.rint(motion.cables * FULL_SCALE).astype("<i2")
    modes = [shape[:, ::stride].tobytes() for shape, stride in zip(whole, motion.stride.tolist(), strict=True)]
    return base64.b64encode(gzip.compress(b"".join([rest, *modes]), compresslevel=6, mtime=0)).decode("ascii")


def _robot(point: OperatingPoint, result: Mapping[str, Any], motion: ModeMotion) -> dict[str, Any]:
    geometry = robot_geometry(point)
    return {
        "cables": len(geometry.frame),
        "points": len(motion.fractions),
        "anchors": _plain(point.entered.frame_anchors),
        "body": _plain(geometry.platform),
        "triangles": geometry.triangles.tolist(),
        "edges": _plain(geometry.edges),
        "wheels": _plain(pulley_wheels(point)),
        "origin": _plain(point.position),
        "rotation": _plain(point.rotation.T),
        "box": _plain(geometry.box()),
        "modes": _modes(result, motion),
    }


def _modes(result: Mapping[str, Any], motion: ModeMotion) -> list[dict[str, Any]]:
    energy = np.concatenate(
        [np.asarray(result["platform_energy"])[:, None], np.asarray(result["cable_energy"])], axis=1
    )
    columns = zip(
        np.asarray(result["frequencies_hz"]).tolist(), result["kinds"], result["motion_words"],
        np.round(energy, _SHARE_DIGITS).tolist(), _plain(motion.platform), motion.stride.tolist(),
        np.round(motion.reach, _DIGITS).tolist(), strict=True,
    )  # fmt: skip
    names = ("hertz", "kind", "words", "energy", "platform", "stride", "reach")
    return [dict(zip(names, row, strict=True)) for row in columns]


def _plain(values: np.ndarray) -> Any:
    return (np.round(np.asarray(values, dtype=float), _DIGITS) + 0.0).tolist()
