"""What programs add to a CSV file without a person's doing: marks, commas, line ends and spaces change no number."""

import numpy as np
import pytest

from cdpr_struct.measurement.campaign_rows import read_rows
from cdpr_struct.measurement.time_series import read_accelerations
from cdpr_struct.measurement.trajectory_file import read_trajectory
from tests.robustness.test_campaign_files import HEAD, ROWS

FORMS = {
    "byte order mark": lambda t: b"\xef\xbb\xbf" + t.encode(),
    "byte order mark and comment": lambda t: b"\xef\xbb\xbf# from the lab\n" + t.encode(),
    "Windows": lambda t: t.replace("\n", "\r\n").encode(),
    "old Macintosh": lambda t: t.replace("\n", "\r").encode(),
    "trailing commas": lambda t: t.replace("\n", ",,\n").encode(),
    "trailing commas in rows": lambda t: t.replace("\n", ",\n").replace(",\n", "\n", 1).encode(),
    "empty rows": lambda t: (t + ",,,,\n\n,,\n").replace("\n", "\n\n", 2).encode(),
    "empty line first": lambda t: ("\n" + t).encode(),
    "spaces": lambda t: t.replace(",", " , ").encode(),
    "quotes": lambda t: "\n".join(",".join(f'"{c}"' for c in line.split(",")) for line in t.split("\n")[:-1]).encode(),
    "sep line": lambda t: ("sep=,\n" + t).encode(),
    "comments": lambda t: ("# one\n" + t.replace("\n", "\n# two\n", 1).replace("300\n", "300 # calm, dry\n")).encode(),
    "no last line end": lambda t: t.rstrip("\n").encode(),
}


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
def test_static_states(form, tmp_path):
    (tmp_path / "a.csv").write_bytes(form(HEAD + ROWS))
    (tmp_path / "b.csv").write_text(HEAD + ROWS)
    found, wanted = (read_rows("static_state", tmp_path / name, 8) for name in ("a.csv", "b.csv"))
    assert found.words == wanted.words
    assert found.numbers.keys() == wanted.numbers.keys()
    assert all(np.array_equal(found.numbers[c], wanted.numbers[c]) for c in wanted.numbers)


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
def test_trajectories_and_accelerations(form, tmp_path):
    motion = "time_s,x_m,y_m,z_m,rz_deg\n" + "".join(f"{0.01 * i},{i * i},0,1,{i}\n" for i in range(100))
    (tmp_path / "a.csv").write_bytes(form(motion))
    found = read_trajectory(tmp_path / "a.csv").trajectory
    np.testing.assert_array_equal(found.position[:, 0], np.arange(100.0) ** 2)
    (tmp_path / "a.csv").write_bytes(form(motion.replace("x_m,y_m,z_m", "ax,ay,az")))
    time, signal = read_accelerations(tmp_path / "a.csv")
    np.testing.assert_array_equal(signal[:, 0], np.arange(100.0) ** 2)
    assert time[-1] == pytest.approx(0.99)
