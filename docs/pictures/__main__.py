"""Draw the pictures of the documentation that the code computes, and the page of the gallery.

    python docs/pictures            # about a minute
    python docs/pictures --check    # the effects of all causes are those that were drawn; exit code 1 if not

Writes docs/anatomy_*.svg, docs/recorded_motion.*, docs/causes/pictures/*.svg, docs/causes/pictures/effects.json and
docs/causes/gallery.md.
"""

import json
import sys
from pathlib import Path

import anatomy
import flow
import gallery
import recorded_motion
from compact import compact
from small_multiples import picture
from typical import effects

from cdpr_struct.reports.figures.style import svg

DOCS = Path(__file__).parents[1]
DRAWN = {
    "anatomy_robot": (anatomy.ROBOT_SIZE, anatomy.draw_robot),
    "anatomy_cable": (anatomy.CABLE_SIZE, anatomy.draw_cable),
    "anatomy_modes": (anatomy.MODES_SIZE, anatomy.draw_modes),
    "diagnosis_flow": (flow.SIZE, flow.draw_flow),
}


def main() -> int:
    """Write everything, or check the numbers behind the gallery."""
    found = effects()
    if "--check" in sys.argv:
        stale = gallery.stale(found)
        print("\n".join(f"{name}: not what was drawn; run: python docs/pictures" for name in stale))
        return bool(stale)
    for name, (size, draw) in DRAWN.items():
        (DOCS / f"{name}.svg").write_text(compact(svg(name.replace("_", "-"), size, draw)), encoding="utf-8")
    recording = recorded_motion.found()
    recorded_motion.written(recording)
    drawn = svg("recorded-motion", recorded_motion.SIZE, lambda figure: recorded_motion.draw(figure, recording))
    (DOCS / "recorded_motion.svg").write_text(compact(drawn), encoding="utf-8")
    for name, effect in found.items():
        (gallery.PICTURES / f"{name}.svg").write_text(picture(name, effect), encoding="utf-8")
    numbers = {name: {"size": effect.size, **effect.numbers()} for name, effect in found.items()}
    lines = ",\n".join(f'"{name}": {json.dumps(own)}' for name, own in numbers.items())
    gallery.NUMBERS.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")
    (DOCS / "causes" / "gallery.md").write_text(gallery.page(numbers), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
