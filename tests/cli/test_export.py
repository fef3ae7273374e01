"""What other programs make of exported robots: MoorPy, MoorDyn, a reader of glTF."""

import json
import struct
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.cli.main import run
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.reports.moordyn_file import water_shift

TILTED = [("thesis-3-1", (0.5, -1.0, 0.8, 4.0, -7.0, 12.0)), ("cogiro", (0.5, -1.0, 1.8, 4.0, -3.0, 12.0))]


@pytest.mark.parametrize(("robot", "pose"), TILTED)
def test_moorpy_finds_the_same_equilibrium(robot, pose, tmp_path):
    moorpy = pytest.importorskip("moorpy", reason="the extra formats is not installed")
    point = rest(cs.load_robot(robot), pose, None).point
    path = cs.export(robot, pose, to="moorpy").write(tmp_path / "robot.txt")
    system = moorpy.System(file=str(path), depth=water_shift(point) + 100.0, rho=0.0, g=9.81)
    system.initialize()
    body = system.bodyList[0]
    body.setPosition(body.r6 + np.array([0.01, -0.01, 0.01, 0.0, 0.01, 0.0]))
    system.solveEquilibrium(tol=1e-7, maxIter=500)
    asked = np.r_[point.position - [0.0, 0.0, water_shift(point)], np.radians(pose[3:])]
    np.testing.assert_allclose(body.r6, asked, atol=1e-5)  # measured 2e-8
    tensions = [line.TB for line in system.lineList]
    np.testing.assert_allclose(tensions, point.cables.tension_at_platform, rtol=1e-5)  # measured 1e-8


_STEPS = """
import sys, moordyn
system = moordyn.Create(sys.argv[1])
moordyn.Init(system, [], [])
for k in range(20):
    moordyn.Step(system, [], [], 0.02 * k, 0.02)
lines = [moordyn.GetLine(system, i + 1) for i in range(int(sys.argv[2]))]
body = moordyn.GetBodyState(moordyn.GetBody(system, 1))[0]
print("\\nfound", *(moordyn.GetLineFairTen(line) for line in lines), *body[:3])
"""


@pytest.mark.parametrize(("robot", "pose"), TILTED)
def test_moordyn_stays_at_rest(robot, pose, tmp_path):
    """Lumped masses on 40 segments a cable."""
    pytest.importorskip("moordyn", reason="the extra formats is not installed")
    point = rest(cs.load_robot(robot), pose, None).point
    path = cs.export(robot, pose, to="moordyn").write(tmp_path / "robot.txt")
    words = [sys.executable, "-c", _STEPS, str(path), str(len(point.cables.length))]
    told = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=True).stdout.splitlines()
    found = np.array([float(v) for v in next(line for line in told if line.startswith("found")).split()[1:]])
    np.testing.assert_allclose(found[:-3], point.cables.tension_at_platform, rtol=5e-4)  # measured 1.5e-4
    np.testing.assert_allclose(found[-3:], point.position - [0.0, 0.0, water_shift(point)], atol=1e-5)  # 1e-6


def test_gltf_is_read_with_its_sag(tmp_path):
    trimesh = pytest.importorskip("trimesh", reason="the extra formats is not installed")
    pytest.importorskip("networkx", reason="trimesh needs it to read lines")
    point = rest(cs.load_robot("cogiro"), None, None).point
    path = cs.export("cogiro", to="gltf").write(tmp_path / "robot.glb")
    scene = trimesh.load(str(path))
    assert set(scene.geometry) == {"platform", "frame anchors", *(f"cable {i}" for i in range(1, 9))}
    hull = trimesh.convex.convex_hull(cs.load_robot("cogiro").platform_anchors)
    assert scene.geometry["platform"].is_watertight
    assert scene.geometry["platform"].volume == pytest.approx(hull.volume, rel=1e-5)
    stretched = point.cables.length * (1.0 + point.cables.tension_at_platform / point.cables.axial_stiffness)
    for i, length in enumerate(stretched, start=1):
        assert scene.geometry[f"cable {i}"].length == pytest.approx(length, rel=1e-4)
        assert scene.geometry[f"cable {i}"].length > point.cables.chord[i - 1] * (1.0 + 1e-6)  # it sags
    assert scene.bounds[1][1] == pytest.approx(point.entered.frame_anchors[:, 2].max(), abs=1e-5)  # y points up


def test_gltf_has_the_form_of_the_standard():
    content = cs.export("thesis-3-1", to="gltf").content
    magic, version, total, length, kind = struct.unpack("<IIIII", content[:20])
    assert (magic, version, total, kind) == (0x46546C67, 2, len(content), 0x4E4F534A)
    scene = json.loads(content[20 : 20 + length])
    (size, kind), data = struct.unpack("<II", content[20 + length : 28 + length]), content[28 + length :]
    assert (size, kind) == (len(data), 0x004E4942)
    for view in scene["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= scene["buffers"][0]["byteLength"] <= len(data)


def test_what_the_format_leaves_out_is_said(tmp_path, capsys):
    made = cs.new_robot("mine", pulleys=0.05)
    path = made.write(tmp_path / "mine.toml")
    assert run(["export", str(path), "--to", "moorpy", "--out", str(tmp_path / "m.txt"), "--json"]) == 0
    assert "Pulleys" in json.loads(capsys.readouterr().out)["warnings"][0]
    assert cs.export("thesis-3-1", to="moorpy").warnings == ()
    skewed = replace(made.robot.platform, inertia=made.robot.platform.inertia + 0.1 * np.eye(3)[[1, 0, 2]])
    assert "Products of inertia" in " ".join(cs.export(replace(made.robot, platform=skewed), to="moordyn").warnings)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--to", "stl"], ["--to", "stl", "gltf"]),
        (["--to", "gltf", "--pose", "1,2"], ["--pose", "1,2"]),
    ],
)
def test_unusable_options_are_named(words, said, tmp_path, capsys):
    assert run(["export", "cogiro", *words, "--out", str(tmp_path / "x")]) == 2
    line = capsys.readouterr().err.strip()
    assert len(line.splitlines()) == 1
    assert all(word in line for word in said), line
    assert run(["export", "cogiro", "--to", "gltf"]) == 2
    assert "--out" in capsys.readouterr().err


def test_nothing_is_overwritten_unasked(tmp_path):
    out = tmp_path / "x.glb"
    out.write_text("my own")
    words = ["export", "cogiro", "--to", "gltf", "--out", str(out), "--quiet"]
    assert run(words) == 2
    assert out.read_text() == "my own"
    assert run([*words, "--overwrite"]) == 0
