"""The page of all causes in pictures, and whether the pictures are still right."""

import json
from pathlib import Path

import numpy as np
from typical import Effect

PICTURES = Path(__file__).parents[1] / "causes" / "pictures"
NUMBERS = PICTURES / "effects.json"
_KINDS = {
    "tension": "tensions [N]", "balance": "balance [N]", "length": "lengths [mm]", "cable": "cable frequencies [%]",
    "robot": "robot frequencies [%]", "response": "FRF [decades]",
}  # fmt: skip
_TOLERANCE = 2e-2  # of the largest number of a kind: far below what a picture shows, far above rounding
_LEAST = 5e-3  # N, mm, % or decades: pictures show no less

_HEAD = """\
# Gallery of causes

What each cause of the [library](index.md) looks like in every kind of reading, at a typical size, one cause a picture.

- **Robot**: the box robot of [my robot, from drawings](../tutorial_own_robot.md) at x = 0.4 m, y = 0.3 m, z = 1.3 m,
  turned by 1, -1 and 2 degrees; eight preloaded cables. Approach +1, one hour after the first reading.
- **Real robot**: the same with one cause, its winches locked at the encoder lengths that the simulation commands.
  For `missing_pulleys` the simulation has no pulleys, for all others those of the robot file.
- **Size**: one sigma of the cause's prior (accelerometer gain: four), halved until no tension changes by 60 N. A
  preloaded robot with locked winches is so stiff that a millimetre of cable is worth tens of newtons.
- **Tensions, frequencies**: real less simulated. Of cable frequencies the bar is the first mode in the plane, the dot
  the third. Of the robot's modes those are shown that have 10 % or more of their kinetic energy in the platform.
- **Wrench balance, lengths**: what does not fit when the readings are put into the simulation: force and moment (over
  0.3 m), and encoder length less computed length. These are the residuals of the [diagnosis](../diagnosis.md).
- **FRF, decay**: the platform's height under a vertical force, and after a blow; blue is the simulation.

No axis is shorter than 2 N, 0.5 mm or 0.5 % to each side: what looks like nothing is hard to measure. Drawn by
`python docs/pictures` with the forward model of the diagnosis.

## Largest change of each kind

"""


def page(numbers: dict[str, dict]) -> str:
    """The gallery as Markdown."""
    head = ["cause", "size", *_KINDS.values()]
    rows = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for name, own in numbers.items():
        cells = [_shown(max(map(abs, own[kind]), default=0.0)) for kind in _KINDS]
        rows.append(f"| [{name}]({name}.md) | {own['size']} | " + " | ".join(cells) + " |")
    pictures = [_picture(name, own["size"]) for name, own in numbers.items()]
    return _HEAD + "\n".join([*rows, "", *pictures])


def _picture(name: str, size: str) -> str:
    return f"## {name}\n\n![{name}: {size}](pictures/{name}.svg)\n\n[Its page]({name}.md)\n"


def _shown(value: float) -> str:
    return "-" if value < _LEAST else f"{value:.2g}" if value < 100.0 else f"{value:.0f}"


def stale(found: dict[str, Effect]) -> list[str]:
    """Causes whose effect is not the committed one, or that have none."""
    committed = json.loads(NUMBERS.read_text("utf-8"))
    return [name for name in found if name not in committed or not _same(found[name], committed[name])]


def _same(effect: Effect, committed: dict) -> bool:
    for kind, values in effect.numbers().items():
        now, then = np.array(values), np.array(committed[kind])
        if now.shape != then.shape:
            return False
        if np.abs(now - then).max(initial=0.0) > _LEAST + _TOLERANCE * np.abs(then).max(initial=0.0):
            return False
    return effect.size == committed["size"]
