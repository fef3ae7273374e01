"""`[[bodies]]` of a robot file: read, check, write."""

from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from cdpr_struct.errors import InputError
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.body import CARRIERS, SHAPES, Body
from cdpr_struct.robot.pose import angles_from_rotation

_MOST, _LEAST = 1e6, 1e-9  # of any length of a body [m]
_Length = Annotated[float, Field(strict=True, gt=_LEAST, le=_MOST)]
_Number = Annotated[float, Field(strict=True, ge=-_MOST, le=_MOST)]
_KEYS = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}
_WORDS = {"size": "three edges in m in square brackets", "radius": "a radius in m", "length": "a length in m"}


class BodyTable(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=False, allow_inf_nan=False)

    name: str = ""
    fixed_to: str
    shape: str
    center: Annotated[list[_Number], Field(min_length=3, max_length=3)]
    angles_deg: Annotated[list[_Number], Field(min_length=3, max_length=3)] = [0.0, 0.0, 0.0]
    size: Annotated[list[_Length], Field(min_length=3, max_length=3)] | None = None
    radius: _Length | None = None
    length: _Length | None = None


def body_of(table: BodyTable, source: str, number: int) -> Body:
    """The body of an entry, `number` from 1.

    Raises
    ------
    InputError : an unknown shape or carrier, or a measure that its shape lacks or does not have.
    """
    place = f"bodies[{number}]"
    for name, known in (("fixed_to", CARRIERS), ("shape", SHAPES)):
        if (value := getattr(table, name)) not in known:
            raise InputError(source, f"{place}.{name}", value, f"one of: {', '.join(known)}")
    needed = _KEYS[table.shape]
    for key, words in _WORDS.items():
        value = getattr(table, key)
        if (value is None) == (key in needed):
            right = f"a {table.shape} has {' and '.join(needed)}"
            given = "nothing" if value is None else value
            raise InputError(source, f"{place}.{key}", given, f"give {words}" if key in needed else right)
    rotation = rotation_from_angles(*np.radians(table.angles_deg))
    name = table.name or f"body {number}"
    return Body(name, table.fixed_to, table.shape, _size(table), np.array(table.center), rotation)


def _size(table: BodyTable) -> np.ndarray:
    if table.size is not None:
        return np.array(table.size)
    wide = 2.0 * (table.radius or 0.0)
    return np.array([wide, wide, wide if table.length is None else table.length])


def body_lines(body: Body, quoted: Any) -> list[str]:
    """Lines of an entry; `quoted` makes a name fit for TOML."""
    measures = {
        "box": [f"size = {body.size.tolist()}"],
        "cylinder": [f"radius = {float(0.5 * body.size[0])!r}", f"length = {float(body.size[2])!r}"],
        "sphere": [f"radius = {float(0.5 * body.size[0])!r}"],
    }
    angles = np.degrees(angles_from_rotation(body.rotation))
    return [
        "[[bodies]]",
        f'name = "{quoted(body.name)}"',
        f'fixed_to = "{body.fixed_to}"',
        f'shape = "{body.shape}"',
        *measures[body.shape],
        f"center = {body.center.tolist()}",
        *([f"angles_deg = {angles.tolist()}"] if angles.any() else []),
    ]
