"""Files that fuzzing found (`python -m tests.fuzz`): each is refused in one short printable line, at once."""

import pickle
import time

import numpy as np
import pytest
import pyuff

from cdpr_struct.errors import ConvergenceError, InputError
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.campaign_rows import read_rows
from cdpr_struct.measurement.data_table import read_table
from cdpr_struct.measurement.separable_fit import separable_fit
from cdpr_struct.measurement.trajectory_file import read_trajectory
from cdpr_struct.measurement.universal_rows import universal_columns
from cdpr_struct.robot.caspr_xml import numbers, parse
from cdpr_struct.robot.robot_file import robot_of_text
from tests.robustness.test_bad_input import ANCHORS, ROBOT
from tests.robustness.test_campaign_files import CAMPAIGN, HEAD, ROWS

LONGEST = 2000  # characters; a screen of 80 columns shows as many at once
SLOWEST = 2.0  # s of processor time; each took minutes, or is read in some ms


def refusal(read, *given) -> str:
    begun = time.process_time()
    with pytest.raises(InputError) as error:
        read(*given)
    assert time.process_time() - begun < SLOWEST
    line = str(error.value)
    assert line.isprintable()
    assert len(line) <= LONGEST
    return line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a = " + "[" * 3000 + "]" * 3000, ["within each other"]),
        ("a = " + "9" * 5000, ["thousands of digits"]),
        ("a" + ".b" * 15000 + " = 1", ["line 1", "at most 64 deep"]),
        ("# " + "." * 300 + "\nx" + '."b"' * 15000 + " = 1", ["line 2", "at most 64 deep"]),
        (ROBOT + ANCHORS + "[extensions]\nadded_mass = 0x" + "f" * 5000, ["added_mass", "too long to be shown"]),
        (ROBOT + ANCHORS + '[extensions]\n"a\\nb" = 1', ["extensions.a\\nb"]),
        (ROBOT + ANCHORS + '[extensions]\n"\\u001b[31m" = 1', ["extensions.\\x1b[31m"]),
        (ROBOT + ANCHORS + "x" * 40_000 + " = 1", ["no such key", "characters)"]),
        ("x" * 40_000, ["line 1", "(40002 characters)"]),
    ],
    ids=range(9),
)
def test_robot_files(text, words):
    line = refusal(robot_of_text, text, "robot.toml")
    assert all(word in line for word in ["robot.toml", *words]), line


@pytest.mark.parametrize("row", ["# " + "." * 300, f'description = "{"a." * 300}"', "gravity = [0.0, 0.0, -9.81]"])
def test_dots_that_are_no_tables_are_read(row):
    assert len(robot_of_text(row + ROBOT + ANCHORS, "robot.toml").cables) == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (CAMPAIGN.replace("states.csv", "s" * 40_000), ["no such data file"]),
        (CAMPAIGN.replace("states.csv", "s\\u0000"), ["no such data file"]),
        (CAMPAIGN.replace("cogiro", "c" * 300), ["robot", "a robot file"]),
        (CAMPAIGN + 'sigma = { kind = "loaded" }\n', ["sigma.kind", "no such key"]),
        ('kind = "loaded"\n' + CAMPAIGN, ["kind", "no such key"]),
    ],
    ids=range(5),
)
def test_campaigns(text, words, tmp_path):
    (tmp_path / "states.csv").write_text(HEAD + ROWS)
    (tmp_path / "campaign.toml").write_text(text)
    line = refusal(load_campaign, tmp_path / "campaign.toml")
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    "text",
    [
        HEAD.replace("cable", "length_" + "9" * 5000 + "_m") + ROWS,
        HEAD.replace("cable", "F" + "9" * 5000) + ROWS,
        HEAD.replace("x_m", "M0x_m" * 8000) + ROWS,
        HEAD.replace("x_m", "x\r\0_m") + ROWS,
        HEAD + ROWS.replace("300", "3" * 100_000),
        HEAD + ROWS.replace("300", "3" * 140_000),
        HEAD + ROWS.replace("300", "3," * 50_000),
    ],
    ids=range(7),
)
def test_tables(text, tmp_path):
    (tmp_path / "states.csv").write_text(text)
    refusal(read_rows, "static_state", tmp_path / "states.csv", 8)


@pytest.mark.parametrize("name", ["M0x_m" * 8000, "9" * 5000, "time\0_s"])
def test_trajectories(name, tmp_path):
    (tmp_path / "motion.csv").write_text(f"{name},x_m,y_m,z_m\n0,0,0,1\n")
    refusal(read_trajectory, tmp_path / "motion.csv")


def test_a_cell_of_a_megabyte_is_cut_and_says_so(tmp_path):
    (tmp_path / "motion.csv").write_text(f"time_s,x_m,y_m,z_m\n0,{'1' * 131_072},0,1\n")
    assert "131074 characters" in refusal(read_trajectory, tmp_path / "motion.csv")
    (tmp_path / "motion.csv").write_text(f"time_s,x_m,y_m,z_m\n0,{'1' * 131_073},0,1\n")
    assert "field larger than field limit" in refusal(read_table, tmp_path / "motion.csv")


@pytest.mark.parametrize("text", ["1e200", "-1e13", "nan", "1" * 40_000])
def test_numbers_of_caspr_models(text):
    """Their squares left what a float can hold, with a warning of numpy on the screen."""
    refusal(numbers, parse(f"<a><b>{text}</b></a>", "bodies.xml"), "b", "bodies.xml", 1)


def universal(path, values):
    one = pyuff.prepare_58(
        binary=0, func_type=4, id1="a", id2="b", id3="c", id4="d", id5="e", rsp_ent_name="A", rsp_node=1, rsp_dir=3,
        ref_ent_name="A", ref_node=1, ref_dir=-3, abscissa_spacing=1, abscissa_spec_data_type=18,
        ordinate_spec_data_type=8, orddenom_spec_data_type=13, x=np.arange(12.0), data=values,
    )  # fmt: skip
    pyuff.UFF(str(path)).write_sets([one], mode="overwrite")
    return path.read_text()


@pytest.mark.parametrize("declared", ["11", "13", "99999"])
def test_a_universal_file_with_fewer_or_more_values_than_declared(declared, tmp_path):
    path = tmp_path / "one.uff"
    text = universal(path, np.ones(12) + 1j)
    head = "         6        12         1"
    assert head in text
    path.write_text(text.replace(head, head.replace("12".rjust(10), declared.rjust(10))))
    refusal(universal_columns, path)


def test_a_universal_file_with_values_beyond_all_bounds(tmp_path):
    universal(tmp_path / "one.uff", np.full(12, 1e300 + 0j))
    assert "at most 1e+12" in refusal(universal_columns, tmp_path / "one.uff")


def test_a_universal_file_that_ends_behind_its_header(tmp_path):
    path = tmp_path / "one.uff"
    text = universal(path, np.ones(12) + 1j)
    path.write_text("\n".join([*text.splitlines()[:13], "    -1", ""]))
    refusal(universal_columns, path)


def test_a_complaint_reaches_the_parent_of_a_worker():
    """An exception that cannot be pickled breaks the pool, and the sentence is lost."""
    error = InputError("robot.toml", "mass", -1.0, "above zero")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_readings_far_off_are_no_words_of_lapack(tmp_path, capfd):
    """A trial of growing poles overflowed; LAPACK printed its complaint where JSON goes, and the record was refused."""
    rows = np.zeros((70, 7))
    rows[:, 0], rows[:, 3] = 0.01 * np.arange(70), 1.2
    rows[:, 6] = rows[:, 0]
    rows[[1, 21, 23, 31, 35, 37, 43], [6, 1, 5, 3, 3, 3, 3]] = [0.02, 3.0, 2.0, 1.6, 0.0, -1.2, -1.2]
    lines = [",".join(f"{value:.2f}" for value in row) for row in rows]
    (tmp_path / "motion.csv").write_text("\n".join(["time_s,x_m,y_m,z_m,rx_deg,ry_deg,rz_deg", *lines]))
    (tmp_path / "states.csv").write_text(HEAD + ROWS)
    (tmp_path / "campaign.toml").write_text(
        CAMPAIGN + '[[measurement]]\nkind = "platform_motion"\nfile = "motion.csv"\n'
    )
    load_campaign(tmp_path / "campaign.toml")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("finite", [True, False])
def test_a_search_for_poles_turns_back_where_they_grow_beyond_all_numbers(finite):
    time, calls, start = np.arange(40.0), [], np.array([-0.01 + 1.1j])

    def basis(poles):
        calls.append(poles)
        wave = np.exp(poles[0] * time) if finite and np.allclose(poles, start) else np.full(40, np.inf + 0j)
        columns = np.stack([wave.real, -wave.imag], axis=1)
        return columns, np.stack([columns * time[:, None], columns[:, ::-1] * time[:, None]])

    signal = np.cos(time)[:, None]
    if not finite:
        with pytest.raises(ConvergenceError, match="far off all others"):
            separable_fit(basis, signal, np.ones((1, 1)), start)
        return
    np.testing.assert_array_equal(separable_fit(basis, signal, np.ones((1, 1)), start).poles, start)
    assert len(calls) > 1, "the search took a step, and came back"


def test_a_tension_next_to_nothing_is_no_overflow(tmp_path):
    """NumPy warned where a cable's weight was divided by it."""
    rows = "".join(f"a,0,0,1.2,{i},{'1e-310' if i == 3 else 300}\n" for i in range(1, 9))
    (tmp_path / "states.csv").write_text(HEAD + rows)
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    assert load_campaign(tmp_path / "campaign.toml").states.tension[0, 2] == 1e-310
