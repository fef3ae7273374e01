"""import-caspr: a small model of our own, its variants, and the public models where they are at hand."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.cli.main import run
from cdpr_struct.robot.robot_file import load_robot

DEFAULT = Path(__file__).parents[3] / "shared" / "external"
EXTERNAL = Path(os.environ.get("CDPR_EXTERNAL_DATA", DEFAULT)) / "caspr"

BODIES = """<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE bodies_system SYSTEM "../bodies.dtd">
<bodies_system><links>
  <link_rigid num="1" name="box">
    <joint type="SPATIAL_EULER_XYZ" q_initial="1 2 0.5 0.1 0.2 0.3"/>
    <physical>
      <mass>12.5</mass><com_location>0 0 0.1</com_location><end_location>0 0 0</end_location>
      <inertia ref="com"><Ixx>1.0</Ixx><Iyy>1.2</Iyy><Izz>0.9</Izz><Ixy>0.1</Ixy><Ixz>0.0</Ixz><Iyz>0.0</Iyz></inertia>
    </physical>
    <parent><num>0</num><location>0 0 1.5</location></parent>
  </link_rigid>
</links></bodies_system>
"""
CABLE = """<{kind} name="c{n}" attachment_reference="{reference}">
  <properties>{properties}</properties>
  <attachments>
    <attachment><link>0</link><location>{frame}</location></attachment>
    <attachment><link>1</link><location>{platform}</location></attachment>
  </attachments></{kind}>"""
LIMITS = "<force_min>{}</force_min><force_max>{}</force_max>"
CORNERS = [
    ("-4 -3 5", "-0.2 -0.2 0.1"),
    ("4 -3 5", "0.2 -0.2 0.1"),
    ("4 3 5", "0.2 0.2 0.1"),
    ("-4 3 5", "-0.2 0.2 0.1"),
]


def cables(kind="cable_ideal", reference="joint", properties="<force_min>10</force_min>") -> str:
    rows = [
        CABLE.format(kind=kind, reference=reference, properties=properties, n=n, frame=frame, platform=platform)
        for n, (frame, platform) in enumerate(CORNERS, start=1)
    ]
    return f'<cables default_cable_set="a"><cable_set id="a">{"".join(rows)}</cable_set></cables>'


def convert(tmp_path, capsys, bodies=BODIES, cable_text=None, extra=()):
    """Exit code, result or complaint, and the robot if there is one."""
    (tmp_path / "b.xml").write_text(bodies)
    (tmp_path / "c.xml").write_text(cables() if cable_text is None else cable_text)
    out = tmp_path / "robot.toml"
    code = run(["import-caspr", str(tmp_path / "b.xml"), str(tmp_path / "c.xml"), "--out", str(out), "--json", *extra])
    captured = capsys.readouterr()
    if code == 0:
        return json.loads(captured.out), load_robot(out)
    assert code == 2
    assert captured.out == ""
    assert len(captured.err.strip().splitlines()) == 1
    assert not out.exists()
    return captured.err, None


def test_every_number_arrives(tmp_path, capsys):
    result, robot = convert(tmp_path, capsys, extra=["--EA", "1e5", "--rho", "0.05"])
    assert (result["robot"], result["cables"]) == ("box", 4)
    assert robot.platform.mass == 12.5
    np.testing.assert_array_equal(robot.platform.center_of_mass, [0.0, 0.0, 0.1])
    np.testing.assert_array_equal(robot.platform.inertia, [[1.0, 0.1, 0.0], [0.1, 1.2, 0.0], [0.0, 0.0, 0.9]])
    np.testing.assert_array_equal(robot.frame_anchors[1], [4.0, -3.0, 5.0])
    np.testing.assert_array_equal(robot.platform_anchors[2], [0.2, 0.2, 0.1])
    np.testing.assert_array_equal(robot.axial_stiffness, 1e5)
    np.testing.assert_array_equal(robot.linear_density, 0.05)


def test_euler_angles_keep_the_rotation(tmp_path, capsys):
    """R = Rx(0.1) Ry(0.2) Rz(0.3), whatever the names of the angles; the parent's place is added."""
    _, robot = convert(tmp_path, capsys)
    a, b, c = 0.1, 0.2, 0.3
    rx = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    ry = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    rz = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    np.testing.assert_allclose(robot.home.rotation, rx @ ry @ rz, atol=1e-12)
    np.testing.assert_allclose(robot.home.position, [1.0, 2.0, 2.0])


def test_what_the_model_leaves_open_is_said(tmp_path, capsys):
    warnings = " ".join(convert(tmp_path, capsys)[0]["warnings"])
    for words in (
        "centre of mass lies 0.1 m off",
        "Rx Ry Rz",
        "no linear density",
        "ASSUMED",
        "products of inertia",
    ):
        assert words in warnings, words
    assert "force" not in warnings
    assert "CHECK" in (tmp_path / "robot.toml").read_text()


def test_warnings_stop_when_the_user_answers(tmp_path, capsys):
    extra = ["--EA", "1e5", "--rho", "0.05", "--inertia", "1,1.2,0.9,0,0,0"]
    warnings = " ".join(convert(tmp_path, capsys, extra=extra)[0]["warnings"])
    assert "ASSUMED" not in warnings
    assert "products" not in warnings


def test_stiffness_of_spring_cables_is_taken(tmp_path, capsys):
    text = cables("cable_linear_spring", properties="<K>80000</K>")
    _, robot = convert(tmp_path, capsys, cable_text=text)
    np.testing.assert_array_equal(robot.axial_stiffness, 80000.0)


@pytest.mark.parametrize(
    ("properties", "low", "high"),
    [("", 0.0, np.inf), ("<force_min>10</force_min>", 10.0, np.inf), (LIMITS.format(0, 720), 0.0, 720.0)],
)
def test_force_limits_become_the_robots(properties, low, high, tmp_path, capsys):
    _, robot = convert(tmp_path, capsys, cable_text=cables(properties=properties))
    np.testing.assert_array_equal(robot.force_min, low)
    np.testing.assert_array_equal(robot.force_max, high)


def test_each_cable_keeps_its_own_force_limits(tmp_path, capsys):
    text = cables(properties=LIMITS.format(10, 720)).replace("<force_max>720", "<force_max>200", 1)
    _, robot = convert(tmp_path, capsys, cable_text=text)
    np.testing.assert_array_equal(robot.force_min, 10.0)
    np.testing.assert_array_equal(robot.force_max, [200.0, 720.0, 720.0, 720.0])
    assert "force" not in (tmp_path / "robot.toml").read_text().split("[[cables]]")[0]


def test_attachments_may_count_from_the_centre_of_mass(tmp_path, capsys):
    _, robot = convert(tmp_path, capsys, cable_text=cables(reference="com"))
    np.testing.assert_allclose(robot.platform_anchors[0], [-0.2, -0.2, 0.2])


def test_inertia_about_the_joint_is_moved(tmp_path, capsys):
    result, robot = convert(tmp_path, capsys, BODIES.replace('ref="com"', 'ref="joint"'))
    np.testing.assert_allclose(np.diag(robot.platform.inertia), [1.0 - 0.125, 1.2 - 0.125, 0.9])
    assert "moved to the centre of mass" in " ".join(result["warnings"])


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("<Izz>0.9</Izz>", "<Izz>3.0</Izz>", ["physical.inertia", "triangle", "--inertia"]),
        ("<Ixy>0.1</Ixy>", "<Ixy>5.0</Ixy>", ["physical.inertia", "products"]),
        ("<Ixx>1.0</Ixx>", "", ["inertia.Ixx", "required"]),
        ("<mass>12.5</mass>", "<mass>heavy</mass>", ["physical.mass", "heavy"]),
        ("<mass>12.5</mass>", "<mass>-1</mass>", ["physical.mass", "-1"]),
        ("<mass>12.5</mass>", "<mass>nan</mass>", ["physical.mass", "nan"]),
        ("0 0 0.1</com", "0 0</com", ["com_location", "0 0"]),
        ('ref="com"', 'ref="tip"', ["inertia.ref", "tip", "joint"]),
        ("1 2 0.5 0.1", "1 2 0.5 x", ["q_initial"]),
        ("</links>", "", ["well-formed"]),
        ("link_rigid", "link_soft", ["0 rigid links"]),
    ],
)
def test_bad_bodies(old, new, words, tmp_path, capsys):
    line, _ = convert(tmp_path, capsys, BODIES.replace(old, new))
    assert all(word in line for word in words), line


def test_files_in_the_wrong_order_are_told(tmp_path, capsys):
    line, _ = convert(tmp_path, capsys, cables())
    assert all(word in line for word in ["a file of cables", "bodies first"]), line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (cables().replace("<link>1</link>", "<link>2</link>", 1), ["cable 1", "links [0, 2]"]),
        (cables().replace("4 -3 5", "4 -3"), ["location", "4 -3"]),
        (cables().replace('attachment_reference="joint"', ""), ["attachment_reference", "joint, com"]),
        (cables(properties="<K>-5</K>"), ["cable 1.K", "-5"]),
        (cables(properties="<force_min>-5</force_min>"), ["cable 1.force_min", "-5", "zero or more"]),
        (cables(properties=LIMITS.format(5, 5)), ["cable 1.force_max", "5", "above force_min, 5 N"]),
        (cables(properties=LIMITS.format(0, 0)), ["cable 1.force_max", "0.0", "above force_min, 0 N"]),
        (cables(properties="<force_max>much</force_max>"), ["properties.force_max", "much"]),
        ('<cables default_cable_set="b"><cable_set id="a"></cable_set></cables>', ["cable set", "a"]),
        ('<cables default_cable_set="a"><cable_set id="a"></cable_set></cables>', ["no cables"]),
        ("not xml", ["well-formed"]),
        ('<!DOCTYPE x [<!ENTITY a "b">]><cables/>', ["ENTITY"]),
    ],
    ids=range(12),
)
def test_bad_cables(text, words, tmp_path, capsys):
    line, _ = convert(tmp_path, capsys, cable_text=text)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("extra", "words"),
    [
        (["--EA", "-1"], ["--EA", "-1"]),
        (["--rho", "thick"], ["--rho", "thick"]),
        (["--inertia", "1,2"], ["--inertia", "1,2"]),
        (["--inertia", "1,1,9,0,0,0"], ["--inertia", "triangle"]),
        (["--cable-set", "z"], ["--cable-set", "z", "a"]),
    ],
)
def test_bad_options(extra, words, tmp_path, capsys):
    line, _ = convert(tmp_path, capsys, extra=extra)
    assert all(word in line for word in words), line


ONE_SET = cables().partition('<cables default_cable_set="a">')[2].removesuffix("</cables>")
SEVERAL = "<cables>{}{}</cables>".format(
    ONE_SET.replace('id="a"', 'id="short"'), ONE_SET.replace('id="a"', 'id="long"').replace("-4 -3 5", "-9 -3 5")
)
PULLEY = (
    "<base_rotating_pulley><fixed_location>-4 -3 5</fixed_location><pulley_radius>0.05</pulley_radius>"
    "<cable_entry_vector>0 0 2</cable_entry_vector></base_rotating_pulley>"
)


def test_of_several_cable_sets_one_is_chosen_by_name(tmp_path, capsys):
    for name, x in (("short", -4.0), ("long", -9.0)):
        result, robot = convert(tmp_path, capsys, cable_text=SEVERAL, extra=["--cable-set", name, "--overwrite"])
        assert robot.frame_anchors[0, 0] == x
        assert f"cable set '{name}' of short, long" in " ".join(result["warnings"])
        (tmp_path / "robot.toml").unlink()


def test_without_a_default_several_cable_sets_are_listed(tmp_path, capsys):
    line, _ = convert(tmp_path, capsys, cable_text=SEVERAL)
    assert "--cable-set is missing; a cable set of the file: short, long" in line
    line, _ = convert(tmp_path, capsys, cable_text=SEVERAL.replace('id="long"', 'id="short"'))
    assert "a name of its own" in line


def test_points_on_the_frame_are_in_the_world_whatever_counts_on_the_platform(tmp_path, capsys):
    """CASPR's link 0 has neither joint nor centre of mass of its own."""
    for reference in ("joint", "com"):
        _, robot = convert(tmp_path, capsys, cable_text=cables(reference=reference), extra=["--overwrite"])
        np.testing.assert_array_equal(robot.frame_anchors[1], [4.0, -3.0, 5.0])
        (tmp_path / "robot.toml").unlink()


def test_a_pulley_at_the_frame_is_one(tmp_path, capsys):
    plain = "<attachment><link>0</link><location>-4 -3 5</location></attachment>"
    _, robot = convert(tmp_path, capsys, cable_text=cables().replace(plain, PULLEY))
    assert robot.pulleys[0].radius == 0.05
    np.testing.assert_array_equal(robot.pulleys[0].axis, [0.0, 0.0, 1.0])
    np.testing.assert_array_equal(robot.frame_anchors[0], [-4.0, -3.0, 5.0])
    assert robot.pulleys[1:] == (None, None, None)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("0.05", "0", ["cable 1.pulley_radius", "above zero"]),
        ("0 0 2", "0 0 0", ["cable_entry_vector"]),
        ("fixed_location", "somewhere", ["fixed_location", "required"]),
        ("base_rotating_pulley", "screw_base_rotating_pulley", ["screw_base_rotating_pulley", "plain attachment"]),
    ],
)
def test_bad_pulleys(old, new, words, tmp_path, capsys):
    plain = "<attachment><link>0</link><location>-4 -3 5</location></attachment>"
    line, _ = convert(tmp_path, capsys, cable_text=cables().replace(plain, PULLEY.replace(old, new)))
    assert all(word in line for word in words), line


def test_a_name_with_quotes_cannot_break_the_file(tmp_path, capsys):
    _, robot = convert(tmp_path, capsys, BODIES.replace('name="box"', 'name="a&quot;&#10;mass = 1 \\ b"'))
    assert robot.platform.mass == 12.5


def test_missing_file_and_missing_out(tmp_path, capsys):
    assert (
        run(["import-caspr", str(tmp_path / "no.xml"), str(tmp_path / "no.xml"), "--out", str(tmp_path / "r.toml")])
        == 2
    )
    assert run(["import-caspr", "b.xml", "c.xml"]) == 2
    assert "--out" in capsys.readouterr().err


LIMITS_OF = {"CoGiRo": (100.0, 5000.0), "IPAnema_1": (0.0, 720.0)}


@pytest.mark.parametrize(("name", "count"), [("CoGiRo", 8), ("IPAnema_1", 8)])
def test_public_models(name, count, tmp_path, capsys):
    """They convert, and every other command takes the file."""
    pair = [EXTERNAL / f"{name}_{part}.xml" for part in ("bodies", "cables")]
    if not all(path.exists() for path in pair):
        pytest.skip("the public CASPR models are not here")
    out = tmp_path / "robot.toml"
    assert run(["import-caspr", *map(str, pair), "--out", str(out), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["cables"] == count
    robot, low, high = load_robot(out), *LIMITS_OF[name]
    np.testing.assert_array_equal(robot.force_min, low)
    np.testing.assert_array_equal(robot.force_max, high)
    assert run(["inverse", str(out), "--json"]) == 0
    assert min(json.loads(capsys.readouterr().out)["tensions_N"]) > 0.0


@pytest.mark.parametrize(
    ("joint", "held"),
    [("PLANAR_XZ", ("y", "rx", "rz")), ("PLANAR_XY", ("z", "rx", "ry")), ("PLANAR_YZ", ("x", "ry", "rz"))],
)
def test_a_planar_joint_is_a_guide(joint, held, tmp_path, capsys):
    result, robot = convert(tmp_path, capsys, BODIES.replace("SPATIAL_EULER_XYZ", joint))
    assert robot.guided == held
    assert any(f"a guide holds {', '.join(held)}" in warning for warning in result["warnings"])
