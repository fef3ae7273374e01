"""A robot at rest as binary glTF 2.0: platform as a mesh, cables with their sag as lines, frame anchors as points."""

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.figures.robot_geometry import robot_geometry

_POINTS, _LINES, _TRIANGLES = 0, 1, 4  # modes of a primitive
_FLOAT, _UNSIGNED = 5126, 5125  # component types
_VERTICES, _INDICES = 34962, 34963  # targets of buffer views
_MAGIC, _JSON, _BIN = 0x46546C67, 0x4E4F534A, 0x004E4942
_COLORS = {"platform": [0.35, 0.45, 0.6, 1.0], "cable": [0.1, 0.1, 0.1, 1.0], "frame": [0.75, 0.2, 0.15, 1.0]}


def gltf_bytes(point: OperatingPoint) -> bytes:
    """A .glb file [m]; its y axis points up, as the format wants: x, y, z of the robot become x, z, -y."""
    shape, robot = robot_geometry(point), point.entered
    made = _Buffers()
    if len(shape.triangles):
        made.add("platform", "platform", _TRIANGLES, shape.platform, _outward(shape.platform, shape.triangles).ravel())
    else:
        made.add("platform", "platform", _LINES, shape.edges.reshape(-1, 3))
    for i, curve in enumerate(shape.curves, start=1):
        made.add(f"cable {i}", "cable", _LINES, np.stack([curve[:-1], curve[1:]], axis=1).reshape(-1, 3))
    made.add("frame anchors", "frame", _POINTS, robot.frame_anchors)
    return made.packed(robot.name)


def _outward(places: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Triangles (t, 3) of a convex body, corners anticlockwise as seen from outside."""
    first, second, third = (places[triangles[:, k]] for k in range(3))
    normal, away = np.cross(second - first, third - first), first - places.mean(axis=0)
    inward = np.einsum("ti,ti->t", normal, away) < 0.0
    return np.asarray(np.where(inward[:, None], triangles[:, ::-1], triangles))


class _Buffers:
    """Meshes as they are collected into one buffer."""

    def __init__(self) -> None:
        self.data = b""
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []

    def add(self, name: str, material: str, mode: int, places: np.ndarray, indices: np.ndarray | None = None) -> None:
        """A mesh of one primitive, from places (n, 3) in the robot's world."""
        turned = np.stack([places[:, 0], places[:, 2], -places[:, 1]], axis=1).astype("<f4")
        primitive: dict[str, Any] = {"mode": mode, "material": list(_COLORS).index(material)}
        bounds = {"min": turned.min(axis=0).tolist(), "max": turned.max(axis=0).tolist()}
        primitive["attributes"] = {"POSITION": self._accessor(turned, _FLOAT, "VEC3", _VERTICES, bounds)}
        if indices is not None:
            primitive["indices"] = self._accessor(indices.astype("<u4"), _UNSIGNED, "SCALAR", _INDICES, {})
        self.meshes.append({"name": name, "primitives": [primitive]})

    def _accessor(self, values: np.ndarray, component: int, kind: str, target: int, more: dict[str, Any]) -> int:
        raw = values.tobytes()
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw), "target": target}
        self.views.append(view)
        self.data += raw
        self.accessors.append(
            {"bufferView": len(self.views) - 1, "componentType": component, "count": len(values), "type": kind, **more}
        )
        return len(self.accessors) - 1

    def packed(self, robot: str) -> bytes:
        """The file."""
        nodes = [{"name": mesh["name"], "mesh": i} for i, mesh in enumerate(self.meshes)]
        materials = [
            {"name": name, "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": color}}
            for name, color in _COLORS.items()
        ]
        scene = {
            "asset": {"version": "2.0", "generator": "cdpr-struct"}, "scene": 0,
            "scenes": [{"name": robot, "nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": self.meshes,
            "materials": materials, "accessors": self.accessors, "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.data)}],
        }  # fmt: skip
        return _container([(_JSON, json.dumps(scene).encode("utf-8"), b" "), (_BIN, self.data, b"\0")])


def _container(chunks: Sequence[tuple[int, bytes, bytes]]) -> bytes:
    """Chunks (type, content, what fills it up to four bytes) behind the head of a .glb file."""
    body = b""
    for kind, content, filling in chunks:
        whole = content + filling * (-len(content) % 4)
        body += struct.pack("<II", len(whole), kind) + whole
    return struct.pack("<III", _MAGIC, 2, 12 + len(body)) + body
