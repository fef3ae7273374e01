"""A predicted vibration after a stop, transient.csv as it is, identified by pyOMA-2 (stochastic subspaces).

Run: python examples/modal_software/transient_in_pyoma2.py   (pip install pyOMA-2)
"""

import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

import cdpr_struct as cs
from cdpr_struct.cli.main import run

ROBOT, POSE = "thesis-3-1", "0.5,-1,0.8"
CHANNELS = ["x_m_s2", "y_m_s2", "z_m_s2", "rx_rad_s2", "ry_rad_s2", "rz_rad_s2"]


def identified() -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] that `modes` predicts, and those that pyOMA-2 finds in transient.csv."""
    from pyoma2.algorithms import SSI
    from pyoma2.setup import SingleSetup

    predicted = cs.modes(ROBOT, POSE, model="static", count=6).modes.hertz
    with tempfile.TemporaryDirectory() as folder:
        words = [
            "transient",
            ROBOT,
            "--pose",
            POSE,
            "--initial-velocity",
            "0.3,0.2,0.1,0.3,0.2,0.4",
            "--model",
            "static",
        ]
        run([*words, "--duration", "20", "--highest", "25", "--damping", "modal:0.005", "--out", folder, "--quiet"])
        table = pd.read_csv(Path(folder) / "transient.csv")
    rate = 1.0 / (table["time_s"][1] - table["time_s"][0])
    setup = SingleSetup(table[CHANNELS].to_numpy(), rate)
    setup.add_algorithms(SSI(name="SSI", method="cov", br=20, ordmax=24))
    setup.run_all()
    setup.mpe("SSI", sel_freq=list(predicted), order_in=20)
    return predicted, np.asarray(setup["SSI"].result.Fn)


if __name__ == "__main__":
    expected, measured = identified()
    for one, other in zip(expected, measured, strict=True):
        print(f"{one:9.5f} Hz predicted, {other:9.5f} Hz identified, {100.0 * (other / one - 1.0):+.5f} %")
