"""A predicted frequency response, read as a universal file by pyuff and identified by sdyPy EMA.

Run: python examples/modal_software/frf_in_sdypy_ema.py   (pip install sdypy-EMA)
"""

import tempfile
from pathlib import Path

import numpy as np
import pyuff

import cdpr_struct as cs

ROBOT, POSE, BAND = "thesis-3-1", (0.5, -1.0, 0.8), "0:20:0.01"
_ORDER = 30  # of the polynomial whose poles are taken; the nearest to each predicted frequency is shown


def identified() -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] that `modes` predicts, and those that sdyPy EMA finds in the universal file."""
    from sdypy import EMA

    predicted = cs.modes(ROBOT, POSE, model="static", count=6).modes.hertz
    found = cs.frf(
        ROBOT, pose=POSE, excite="fz", at=(0.3, 0.2, 0.1), respond="x,y,z,rx,ry,rz", band=BAND, model="static",
        damping="modal:0.005", quantity="acceleration",
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "frf.uff"
        path.write_bytes(found.universal_file())
        sets = pyuff.UFF(str(path)).read_sets()
    lines = np.array([one["data"] for one in sets])
    model = EMA.Model(frf=lines, freq=sets[0]["x"], lower=1.0, upper=19.0, pol_order_high=40, frf_form="accelerance")
    model.get_poles(method="lscf", show_progress=False)
    poles = np.asarray(model.pole_freq[_ORDER])
    return predicted, np.array([poles[np.abs(poles - hertz).argmin()] for hertz in predicted])


if __name__ == "__main__":
    expected, measured = identified()
    for one, other in zip(expected, measured, strict=True):
        print(f"{one:9.5f} Hz predicted, {other:9.5f} Hz identified, {100.0 * (other / one - 1.0):+.5f} %")
