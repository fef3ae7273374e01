"""Any single reading of a pose or a cable may be missing: it is nan, the rest of its state stays, a note says so."""

import numpy as np
import pytest

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.campaign_file import load_campaign

POSE = "x_m,y_m,z_m,rx_deg,ry_deg,rz_deg"
LENGTHS = ",".join(f"length_{i}_m" for i in range(1, 9))
LONG = f"case,{POSE},cable,tension_N,length_m\n"


def loaded(tmp_path, **files: str) -> Campaign:
    entries = "".join(f'[[measurement]]\nkind = "{kind}"\nfile = "{kind}.csv"\n' for kind in files)
    for kind, text in files.items():
        (tmp_path / f"{kind}.csv").write_text(text)
    (tmp_path / "campaign.toml").write_text('robot = "cogiro"\n' + entries)
    return load_campaign(tmp_path / "campaign.toml")


def state(name: str, pose: str = "0,0,1,0,0,0", without: tuple[int, ...] = ()) -> str:
    """Rows of all cables, 300 N and 8 m; no tension of some, no length of the first."""
    cells = [("" if i in without else "300", "" if i == 1 else "8") for i in range(1, 9)]
    return "".join(f"{name},{pose},{i},{t},{length}\n" for i, (t, length) in enumerate(cells, start=1))


def test_single_tensions_and_lengths_may_be_missing(tmp_path):
    found = loaded(tmp_path, static_state=LONG + state("a", without=(3,)) + state("b", without=(3, 5)))
    np.testing.assert_array_equal(np.argwhere(np.isnan(found.states.tension)), [[0, 2], [1, 2], [1, 4]])
    np.testing.assert_array_equal(np.isnan(found.states.length[:, 0]), [True, True])
    assert np.nansum(found.states.tension) == 13 * 300.0
    assert "3 of 16 tension readings are missing; cable 3 has none." in found.notes
    assert "2 of 16 length readings are missing; cable 1 has none." in found.notes


def test_a_cable_without_rows_has_no_readings(tmp_path):
    rows = "".join(line for line in state("a").splitlines(True) if ",4,300," not in line)
    np.testing.assert_array_equal(np.isnan(loaded(tmp_path, static_state=LONG + rows).states.tension[0]), np.eye(8)[3])


def test_both_forms_miss_alike(tmp_path):
    head = f"case,{POSE}," + ",".join(f"tension_{i}_N" for i in range(1, 9)) + "\n"
    wide = loaded(tmp_path, static_state=head + "a,0,0,1,0,0,0,300,300,,300,300,300,300,300\n")
    long = loaded(tmp_path, static_state=LONG + state("a", without=(3,)))
    np.testing.assert_array_equal(wide.states.tension, long.states.tension)


def test_a_pose_without_rotation_is_unknown_and_not_level(tmp_path):
    found = loaded(tmp_path, static_state=LONG + state("a", "0.1,0,1,,,") + state("b"))
    np.testing.assert_array_equal(np.isnan(found.states.angles), [[True] * 3, [False] * 3])
    assert found.states.position[0].tolist() == [0.1, 0.0, 1.0]
    assert "The rotation of a was not measured in full: taken as unknown." in found.notes


def test_what_one_file_leaves_empty_another_gives(tmp_path):
    peaks = f"case,{POSE},frequency_hz\na,0,0,1,0,0,2,7.5\n"
    found = loaded(tmp_path, static_state=LONG + state("a", "0,,1,0,0,2"), robot_frequency=peaks)
    np.testing.assert_array_equal(found.states.position, [[0.0, 0.0, 1.0]])
    with pytest.raises(InputError, match="the pose and payload given before"):
        loaded(tmp_path, static_state=LONG + state("a", "0,,1.1,0,0,2"), robot_frequency=peaks)


def test_a_length_missing_at_a_lock_is_missing_in_all_its_rows(tmp_path):
    """Twin: the same length read in one row only is another lock."""
    row = "{},0,0,1,0,0,0,{},8,8,8,,8,8,8,8\n"
    head = f"case,{POSE},payload_kg,{LENGTHS}\n"
    one = loaded(tmp_path, loaded_pose=head + row.format("a", 0) + row.format("b", 5))
    assert one.states.lock.tolist() == [0, 0]
    other = loaded(tmp_path, loaded_pose=head + row.format("a", 0) + row.format("b", 5).replace(",,", ",8,"))
    assert other.states.lock.tolist() == [0, 1]


def test_signals_need_the_whole_pose(tmp_path):
    response = "case,frequency_hz,real,imag,respond,excite\na,1,1,0,x,fx\na,2,1,0,x,fx\n"
    with pytest.raises(InputError, match="a pose with empty cells"):
        loaded(tmp_path, static_state=LONG + state("a", "0,,1,0,0,0"), frf=response)
