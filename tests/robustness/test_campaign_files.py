"""Unusable campaigns: one line naming file, row, value and what would be right; exit code 2."""

from importlib.resources import files

import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.misspelt_cases import misspelt_notes
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml
from tests.robustness.test_plausible_robots import in_mm

HEAD = "case,x_m,y_m,z_m,cable,tension_N\n"
ROWS = "".join(f"a,0,0,1,{i},300\n" for i in range(1, 9))
CAMPAIGN = 'robot = "cogiro"\n[[measurement]]\nkind = "static_state"\nfile = "states.csv"\n'


def complaint(tmp_path, capsys, campaign=CAMPAIGN, rows=HEAD + ROWS) -> str:
    (tmp_path / "states.csv").write_text(rows)
    path = tmp_path / "campaign.toml"
    path.write_text(campaign)
    assert run(["diagnose", str(path)]) == 2
    captured = capsys.readouterr()
    lines = captured.err.strip().splitlines()
    assert captured.out == ""
    assert len(lines) == 1, captured.err
    return lines[0]


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("", ["states.csv", "an empty file", "a header line"]),
        (HEAD, ["states.csv", "no rows"]),
        (HEAD.replace("cable,", ""), ["column cable is missing"]),
        (HEAD.replace("tension_N", "tension_kN") + ROWS, ["tension_kN", "unknown"]),
        (HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,1,3,much"), ["row 3", "tension_N", "much", "a number"]),
        (HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,1,3,-5"), ["row 3", "-5", "above zero"]),
        (HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,1,3,nan"), ["row 3", "nan", "finite"]),
        (HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,1,9,300"), ["row 3", "cable", "9", "1 to 8"]),
        (HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,1,2,300"), ["row 3", "cable", "one row a cable"]),
        (HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,2,3,300"), ["row 3", "case a", "pose and payload"]),
        (HEAD + ROWS.replace("a,0,0,1,3,300", ",0,0,1,3,300"), ["row 3", "case", "a name"]),
    ],
    ids=range(11),
)
def test_bad_rows(rows, words, tmp_path, capsys):
    line = complaint(tmp_path, capsys, rows=rows)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (HEAD + ROWS.replace("0,0,1,", "0,0,1000,"), ["case a: x_m, y_m, z_m", "1000.0", "mm"]),
        (HEAD + ROWS.replace(",300", ",0.3"), ["case a: tension_N", "2.4", "kN"]),
        (
            HEAD.strip() + ",length_m\n" + ROWS.replace(",300", ",300,9500"),
            ["case a, every cable: length_m", "9500", "mm"],
        ),
        (
            HEAD.strip()
            + ",length_m\n"
            + ROWS.replace(",300", ",300,9.5").replace("9.5", "9500", 2).replace("9500", "9.5", 1),
            ["case a, cable 2: length_m", "9500", "mm"],
        ),
    ],
    ids=["position", "tension", "length", "one length"],
)
def test_readings_a_thousand_times_off_are_asked_for_their_unit(rows, words, tmp_path, capsys):
    line = complaint(tmp_path, capsys, rows=rows)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("campaign", "words"),
    [
        (CAMPAIGN.replace("cogiro", "no-robot"), ["no-robot"]),
        (CAMPAIGN.replace("static_state", "mood"), ["measurement[1].kind", "mood"]),
        (CAMPAIGN.replace("states.csv", "missing.csv"), ["missing.csv"]),
        (CAMPAIGN.replace("[[measurement]]", "[measurement]"), ["[[measurement]]", "one for each file"]),
        ('robot = "cogiro"\n', ["measurement", "required"]),
        (CAMPAIGN + "sigma = { tension_N = -1.0 }\n", ["sigma.tension_N", "-1"]),
        (CAMPAIGN + "[tolerances]\nanchors = 1\n", ["tolerances.anchors"]),
        (CAMPAIGN.replace('"cogiro"', '"cogiro"\nmodel = "jelly"'), ["model", "jelly"]),
    ],
    ids=range(8),
)
def test_bad_campaigns(campaign, words, tmp_path, capsys):
    line = complaint(tmp_path, capsys, campaign=campaign)
    assert all(word in line for word in words), line


def test_locked_lengths_in_feet_are_refused(tmp_path, capsys):
    """Poses are found from them: with cables three times as long that took minutes and ended without a word."""
    head = "case,x_m,y_m,z_m,payload_kg," + ",".join(f"length_{i}_m" for i in range(1, 9)) + "\n"
    campaign = CAMPAIGN.replace("static_state", "loaded_pose")
    line = complaint(tmp_path, capsys, campaign, head + "a,0,0,1,20," + ",".join(8 * ["33"]) + "\n")
    assert all(word in line for word in ["case a, every cable", "length_m", "33", "is it in ft?"]), line


def test_a_payload_in_grams_is_refused(tmp_path, capsys):
    """It used to end in a law of the tracker, or in tensions that were asked for their unit."""
    rows = HEAD.replace("cable,", "payload_kg,cable,") + ROWS.replace("a,0,0,1,", "a,0,0,1,20000,")
    line = complaint(tmp_path, capsys, rows=rows)
    assert all(word in line for word in ["case a", "payload_kg", "20000", "118.5 kg", "is it in g,"]), line


@pytest.mark.parametrize(
    ("nominal", "words"),
    [
        ("axial_stiffness = 231.87", ["axial_stiffness", "231.87", "129 %", "is it in kN"]),
        ("linear_density = 120.0", ["linear_density", "120", "times the tensions measured", "is it in g/m"]),
        ("platform_mass = 118500.0", ["tension_N", "2400", "mass of 1.185e+05 kg in g?"]),
        (
            "platform_mass = 0.1185\nplatform_inertia = [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]",
            ["platform mass", "0.1185", "is it in t,"],
        ),
        ("center_of_mass = [0, 0, 30]", ["center_of_mass", "30", "is it in mm?"]),
        ("platform_inertia = [[7e9, 0, 0], [0, 7e9, 0], [0, 0, 7e9]]", ["platform inertia", "7000000000", "kg mm^2"]),
    ],
)
def test_cables_and_platforms_in_another_unit_are_refused(nominal, words, tmp_path, capsys):
    """They took minutes and ended as unknown, or the tensions were asked for their unit."""
    line = complaint(
        tmp_path, capsys, campaign=f'robot = "cogiro"\n[nominal]\n{nominal}\n' + CAMPAIGN.split("\n", 1)[1]
    )
    assert all(word in line for word in words), line


def test_masts_that_would_give_way_by_metres_are_refused(tmp_path, capsys):
    """mm/N for m/N: the diagnosis of it did not end."""
    robot = (files("cdpr_struct.robot.builtin") / "cogiro.toml").read_text("utf-8")
    (tmp_path / "masts.toml").write_text(robot + "\n[extensions]\nframe_compliance = 0.01\n")
    line = complaint(tmp_path, capsys, campaign=CAMPAIGN.replace("cogiro", "masts.toml"))
    assert all(word in line for word in ["frame_compliance", "0.01", "give way by 3 m", "is it in mm/N?"]), line


def test_a_campaign_file_in_another_encoding_is_told(tmp_path, capsys):
    (tmp_path / "campaign.toml").write_bytes("# Seilroboter f\u00fcr Messungen\n".encode("latin-1") + CAMPAIGN.encode())
    assert run(["diagnose", str(tmp_path / "campaign.toml")]) == 2
    assert "got 'byte 0xfc'; a text file in UTF-8" in capsys.readouterr().err


def test_one_reading_far_too_large_is_no_cable_in_another_unit(tmp_path):
    """It is for the diagnosis to find, also in a campaign of one state, as long as a cable can bear it."""
    (tmp_path / "states.csv").write_text(HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,1,3,30000"))
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    assert load_campaign(tmp_path / "campaign.toml").states.tension.max() == 30000.0


def test_a_reading_above_the_stiffness_of_its_cable_is_refused_with_its_file(tmp_path, capsys):
    """EA is 251 kN: no fit of masts or cables can be asked about such a number."""
    line = complaint(tmp_path, capsys, CAMPAIGN, HEAD + ROWS.replace("a,0,0,1,3,300", "a,0,0,1,3,300000"))
    words = ["states.csv: case a, cable 3: tension_N", "300000", "EA = 251327 N", "is a decimal point missing?"]
    assert all(word in line for word in words), line


def test_lengths_of_one_file_in_feet_are_refused(tmp_path, capsys):
    lengths = ",".join(8 * ["10.0"])
    head = "case,x_m,y_m,z_m," + ",".join(f"length_{i}_m" for i in range(1, 9)) + "\n"
    (tmp_path / "locked.csv").write_text(f"{head}b,0,0,1,{lengths}\n")
    rows = HEAD.replace("cable,", "length_m,cable,") + ROWS.replace("a,0,0,1,", "a,0,0,1,33.0,")
    second = CAMPAIGN.split("\n", 1)[1].replace("static_state", "loaded_pose").replace("states.csv", "locked.csv")
    line = complaint(tmp_path, capsys, CAMPAIGN + second, rows)
    assert all(word in line for word in ["case a: length_m", "33.0", "3.3 times", "are they in ft?"]), line


@pytest.mark.parametrize(("word", "kind"), [("loaded", "loaded_pose"), ("tensions", "static_state")])
def test_words_of_new_campaign_are_translated(word, kind, tmp_path, capsys):
    line = complaint(tmp_path, capsys, CAMPAIGN.replace('"static_state"', f'"{word}"'))
    assert all(said in line for said in ["measurement[1].kind", f"'{word}'", "new-campaign", kind]), line


LOCKED = "case,x_m,y_m,z_m," + ",".join(f"length_{i}_m" for i in range(1, 9)) + "\n"
TWO_FILES = CAMPAIGN + '[[measurement]]\nkind = "loaded_pose"\nfile = "locked.csv"\n'


def test_two_lengths_of_a_case_are_told_with_both_files_and_the_remedy(tmp_path, capsys):
    (tmp_path / "locked.csv").write_text(f"{LOCKED}a,0,0,1,{','.join(7 * ['10.0'])},10.001\n")
    rows = HEAD.replace("cable,", "length_m,cable,") + ROWS.replace("a,0,0,1,", "a,0,0,1,10.0,")
    line = complaint(tmp_path, capsys, TWO_FILES, rows)
    words = ["locked.csv: row 1, case a, column length_8_m: got 10.001", "in states.csv", "10;", "another name"]
    assert all(word in line for word in words), line


def test_a_case_that_is_perhaps_misspelt_is_a_warning(tmp_path):
    """Names alike but for a space; the same names, and names of other poses, are no slip."""
    (tmp_path / "states.csv").write_text(HEAD + ROWS.replace("a,", "pose1,") + ROWS.replace("a,", "pose 2,"))
    (tmp_path / "campaign.toml").write_text(TWO_FILES)
    locked = "".join(f"{name},0,0,1,{','.join(8 * ['10.0'])}\n" for name in ("pose 1", "pose 2", "pose 3"))
    (tmp_path / "locked.csv").write_text(LOCKED + locked)
    slips = [note for note in load_campaign(tmp_path / "campaign.toml").notes if "one name" in note]
    assert len(slips) == 1
    assert slips[0].startswith("Case pose 1 of locked.csv has no row in states.csv, which has pose1")


@pytest.mark.parametrize(
    ("one", "other", "slips"),
    [
        (["left 1", "b"], ["lfet 1", "b"], 1),
        (["left 1", "b"], ["left 2", "b"], 0),
        (["left 1", "b"], ["lfet 1", "c"], 0),
        (["Pose_1"], ["pose 1"], 1),
    ],
    ids=["a slip", "another number", "files without common cases", "signs and capitals"],
)
def test_slips_are_few_letters_and_no_numbers(one, other, slips):
    assert len(misspelt_notes({"one.csv": one, "other.csv": other})) == slips


@pytest.mark.parametrize(
    ("columns", "value"), [("tension_N,length_m", "300,9.5"), ("length_m", "9.5"), ("tension_N", "300")]
)
def test_a_robot_in_mm_is_named_not_the_data_in_m(columns, value, tmp_path, capsys):
    """The robot's masses decide which of the two files is in mm."""
    (tmp_path / "large.toml").write_text(robot_toml(in_mm(load_robot("cogiro")), "large"))
    rows = f"case,x_m,y_m,z_m,cable,{columns}\n" + "".join(f"a,0,0,1,{i},{value}\n" for i in range(1, 9))
    line = complaint(tmp_path, capsys, CAMPAIGN.replace("cogiro", "large.toml"), rows)
    assert "the lengths in mm?" in line or "the robot's lengths are in mm?" in line, line
    assert "is it in g/m" not in line
