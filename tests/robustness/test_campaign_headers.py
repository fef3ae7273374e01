"""Headers as people write them: the answer says which column becomes which, in which unit, and guesses none."""

import pytest

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign_rows import read_rows
from tests.robustness.test_campaign_files import CAMPAIGN, HEAD, ROWS, complaint

PLACE = "x_m,y_m,z_m"
TENSIONS = ["name them tension_1_N ... tension_8_N (N, at the platform"]
LENGTHS = ["name them length_1_m ... length_8_m (m, unstrained, paid out"]


def table(*forms: str, first: int = 1, last: int = 8) -> str:
    """Header and one row with a column per cable of each form."""
    names = [PLACE, *(form.format(i) for form in forms for i in range(first, last + 1))]
    header = ",".join(names)
    return f"{header}\n{','.join(['1'] * len(header.split(',')))}\n"


def refusal(tmp_path, text: str, kind: str = "static_state") -> str:
    (tmp_path / "states.csv").write_text(text)
    with pytest.raises(InputError) as error:
        read_rows(kind, tmp_path / "states.csv", 8)
    assert "\n" not in str(error.value)
    return str(error.value)


@pytest.mark.parametrize(
    ("form", "words"),
    [
        ("T{}", ["columns T1 ... T8 look like one tension per cable", *TENSIONS, "T1 becomes tension_1_N"]),
        ("F_{}", ["columns F_1 ... F_8", *TENSIONS]),
        ("cable {} [N]", ["columns cable 1 [N] ... cable 8 [N]", *TENSIONS]),
        ("cable #{} [N]", ["columns cable #1 [N] ... cable #8 [N]", *TENSIONS]),
        ("tension{}", ["columns tension1 ... tension8", *TENSIONS]),
        ("f{}_N", ["columns f1_N ... f8_N", *TENSIONS]),
        ("{}_tension", ["columns 1_tension ... 8_tension", *TENSIONS]),
        ("tension_0{}_N", ["tension_01_N becomes tension_1_N", *TENSIONS]),
        ("TENSION_{}_N", ["TENSION_1_N becomes tension_1_N", *TENSIONS]),
        ("T{} [kN]", ["convert the values from kN", *TENSIONS]),
        ("L{}", ["columns L1 ... L8 look like one length per cable", *LENGTHS]),
        ("length{} (mm)", ["convert the values from mm", *LENGTHS]),
        ("cable {}", ["one reading per cable: tensions are named tension_1_N", "or lengths are named length_1_m"]),
        ("{}", ["one reading per cable: tensions are named tension_1_N", "or lengths are named length_1_m"]),
        ("S{}", ["column cable is missing", "with one row a pose, tension_1_N ... tension_8_N"]),
    ],
)  # fmt: skip
def test_one_column_a_cable(form, words, tmp_path):
    line = refusal(tmp_path, table(form))
    assert all(word in line for word in words), line


def test_tensions_and_lengths_at_once(tmp_path):
    line = refusal(tmp_path, table("T{}", "L{}"))
    assert all(word in line for word in [*TENSIONS, *LENGTHS]), line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (table("T{}", first=0, last=7), ["T0 ... T7", "T0 becomes tension_1_N", *TENSIONS]),
        (table("T{}", last=6), ["T1 ... T6", "this robot has 8 cables"]),
        (table("tension_{}_N", last=6), ["tension_7_N", "this robot has 8 cables", "tension_1_N ... tension_8_N"]),
        (table("tension_{}_N", last=9), ["tension_9_N", "this robot has 8 cables"]),
        (table("tension_{}_N", first=0, last=7), ["numbered from 1", "tension_0_N becomes tension_1_N"]),
    ],
    ids=["from 0", "too few", "one lacks", "too many", "from 0, named right"],
)
def test_cables_that_the_robot_does_not_have(text, words, tmp_path):
    line = refusal(tmp_path, text)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ("cable", ["cable and tension_1_N", "either one row a cable", "or one row a pose"]),
        ("length_m", ["length_m", "length_1_m ... length_8_m"]),
        ("approach,approach_1", ["approach", "approach_1 ... approach_8"]),
        ("approach_1", ["approach_2", "approach_1 ... approach_8"]),
        ("aproach", ["approach is perhaps meant", "tension_1_N ... tension_8_N", "column comment"]),
        ("x_m", ["x_m twice"]),
    ],
)
def test_two_forms_in_one_file(columns, words, tmp_path):
    header, row = table("tension_{}_N").splitlines()
    line = refusal(tmp_path, f"{header},{columns}\n{row},{','.join(['1'] * len(columns.split(',')))}\n")
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("header", "words"),
    [
        (HEAD.upper(), ["rename CASE to case, X_M to x_m, Y_M to y_m, Z_M to z_m, CABLE to cable, TENSION_N to"]),
        (HEAD.replace("x_m,y_m,z_m", "x,y,z"), ["rename x to x_m (m), y to y_m (m), z to z_m (m)"]),
        (HEAD.replace("x_m", "x [mm]"), ["rename x [mm] to x_m (m; convert the values from mm)"]),
        (HEAD.replace("tension_N", "Tension [N]"), ["rename Tension [N] to tension_N"]),
        (HEAD.replace("tension_N", "tension"), ["rename tension to tension_N (N)"]),
        (HEAD.replace("tension_N", "tension_kN"), ["rename tension_kN to tension_N (N; convert the values from kN)"]),
        ("," + HEAD, ["no name for column 1", "index=False"]),
    ],
)
def test_single_columns(header, words, tmp_path):
    rows = ROWS if not header.startswith(",") else ROWS.replace("a,0", "1,a,0")
    line = refusal(tmp_path, header + rows)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("kind", "form", "words"),
    [
        ("cable_frequency", "f{}", ["name them frequency_1_hz ... frequency_8_hz (Hz"]),
        ("cable_frequency", "cable {} [Hz]", ["name them frequency_1_hz ... frequency_8_hz (Hz"]),
        ("loaded_pose", "L{}", LENGTHS),
        ("free_decay", "l_{}", LENGTHS),
        ("robot_frequency", "f{}", ["column frequency_hz is missing"]),
    ],
)
def test_other_kinds(kind, form, words, tmp_path):
    line = refusal(tmp_path, table(form), kind)
    assert all(word in line for word in words), line


def test_a_file_without_a_header(tmp_path):
    assert "a first line that names the columns" in refusal(tmp_path, "0,0,1,1,300\n0,0,1,2,300\n")
    assert "a line that begins with # is a comment" in refusal(tmp_path, "# x_m,y_m\n0,0\n")


POSE_ROW = "a,0,0,1" + 8 * ",300" + "\n"
WIDE = "case," + table("tension_{}_N")


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("a,0,0,1,300,300,much,300,300,300,300,300\n", ["row 1, column tension_3_N", "much", "a number"]),
        (POSE_ROW + POSE_ROW, ["row 2, case a", "a second row", "a case of its own"]),
        (POSE_ROW + POSE_ROW.replace("a,0,0,1", "a,0,0,2"),
         ["row 2, case a", "the pose and payload given before", "has no columns rx_deg, ry_deg, rz_deg"]),
    ],
    ids=["no number", "twice", "moved"],
)  # fmt: skip
def test_rows_of_poses(rows, words, tmp_path, capsys):
    line = complaint(tmp_path, capsys, CAMPAIGN, WIDE.splitlines()[0] + "\n" + rows)
    assert all(word in line for word in words), line


def test_no_frequency_at_all(tmp_path):
    empty = table("frequency_{}_hz").splitlines()[0] + "\n0,0,1" + 8 * "," + "\n"
    assert "no readings" in refusal(tmp_path, empty, "cable_frequency")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("tension_3_N", "tension3", ["'tension3'", "rename tension3 to tension_3_N (N)"]),
        ("tension_3_N", "tension_kN_3_N", ["rename tension_kN_3_N to tension_3_N", "convert the values from kN"]),
        ("tension_", "tension_kN_", ["name them tension_1_N ... tension_8_N", "convert the values from kN"]),
    ],
    ids=["no unit", "another unit too", "another unit too, in all"],
)
def test_one_name_that_differs_is_named(old, new, words, tmp_path):
    line = refusal(tmp_path, table("tension_{}_N").replace(old, new))
    assert all(word in line for word in words), line


def test_decimal_commas_between_commas_are_counted_and_not_repeated(tmp_path):
    header = table("tension_{}_N").splitlines()[0]
    line = refusal(tmp_path, f"{header}\n{','.join(11 * ['1,5'])}\n")
    assert "got '22 values'; 11 values as in the header, decimals with a point (are they commas?)" in line
