"""Inputs that a run starts from, and words that are spliced into them."""

import tempfile
from importlib.resources import files
from pathlib import Path

import numpy as np
import pyuff

EXAMPLES = Path(__file__).parents[2] / "examples"
BETWEEN = b"\n<!-- cables -->\n"  # between the two files of a CASPR model
KINDS = (
    "static_state", "loaded_pose", "cable_frequency", "robot_frequency", "frf", "free_decay", "platform_motion",
    "accelerations",
)  # fmt: skip
POSE = "case,x_m,y_m,z_m,rx_deg,ry_deg,rz_deg"
_AT = "a,0,0,1.2,0,0,0"
STATES = {
    "states.csv": f"{POSE},cable,tension_N,length_m\n".encode()
    + b"".join(f"{_AT},{i},{280 + 5 * i},\n".encode() for i in range(1, 9)),
    "pitches.csv": f"{POSE},frequency_hz\n{_AT},5.1\n{_AT},5.6\n".encode(),
}
"""Data files beside a campaign."""

CAMPAIGN = 'robot = "cogiro"\n[[measurement]]\nkind = "static_state"\nfile = "states.csv"\n'
_CAMPAIGN = """robot = "mine.toml"
model = "exact"
tension_distribution = "minimum_norm"
lower_bound_N = 50.0
checked = { platform_mass = 0.5 }
[nominal]
platform_mass = 118.5
center_of_mass = [0, 0, 0.01]
platform_inertia = [[20, 0, 0], [0, 20, 0], [0, 0, 20]]
axial_stiffness = 2.5e5
linear_density = 0.067
gravity = 9.81
assembly = "consistent"
[tolerances]
anchor_m = 0.002
load_cell_gain = 0.01
[loss]
wrong_name = 10.0
too_wide = 1.0
unknown = 3.0
[[measurement]]
kind = "static_state"
file = "states.csv"
sigma = { tension_N = 5.0, position_m = 0.005, rotation_deg = 0.3, length_m = 5e-4 }
[[measurement]]
kind = "robot_frequency"
file = "pitches.csv"
sigma = { frequency_hz = 0.05, acceleration = 0.1 }
"""
_ROBOT = """name = "r"
gravity = [0.0, 1.7, -9.66]
home_pose = [0, 0, 1, 0, 0, 5]
[platform]
mass = 10.0
center_of_mass = [0, 0, 0.1]
inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
guided = ["rz"]
[cable]
axial_stiffness = 1e5
linear_density = 0.05
force_min = 10.0
force_max = inf
thermal_expansion = 1.2e-5
[[cables]]
platform_anchor = [0.1, 0, 0]
frame_anchor = [3, 0, 4]
pulley = { radius = 0.05, axis = [0, 0, 1] }
winch = "left"
home_length = 4.2
[[cables]]
platform_anchor = [-0.1, 0, 0]
frame_anchor = [-3, 0, 4]
damping_ratio = 0.01
winch_tension = 80.0
[extensions]
causes = ["pulleys"]
joint_mass = 0.1
added_mass = [0.1, 0.0]
frame_compliance = 1e-6
mast_bending = [1e-6, 2e-6]
cell_gain = 1.01
tracker = [0, 0, 0, 0, 0, 0]
internal_mass = 1.0
internal_frequency = 9.0
internal_direction = [0, 0, 1]
stiffening_exponent = 0.1
incremental_ratio = 1.1
bearing_friction = 0.02
pulley_drag = 1.0
backlash = 0.001
swinging_mass = 0.5
swinging_frequency = 0.8
swinging_place = [0, 0, -0.1]
drag_width = 0.01
wind = [1, 2, 0]
[[lumps]]
cable = 1
from_platform = 1.5
mass = 0.8
[[bodies]]
name = "table"
fixed_to = "frame"
shape = "box"
center = [0, 0, 0.4]
angles_deg = [0, 0, 10]
size = [2, 1, 0.8]
[[bodies]]
fixed_to = "platform"
shape = "cylinder"
center = [0, 0, 0.4]
radius = 0.2
length = 0.3
"""


def seeds() -> dict[str, list[bytes]]:
    """Seeds of every target."""
    built_in = [f.read_bytes() for f in files("cdpr_struct.robot.builtin").iterdir() if f.name.endswith(".toml")]
    bodies, cables = ((EXAMPLES / "caspr" / f"{name}.xml").read_bytes() for name in ("bodies", "cables"))
    return {
        "robot": [_ROBOT.encode(), *built_in, *(p.read_bytes() for p in sorted(EXAMPLES.glob("*/*/robot.toml")))],
        "campaign": [_CAMPAIGN.encode(), CAMPAIGN.encode(), (EXAMPLES / "table-4-4/campaign.toml").read_bytes()],
        "table": _tables(),
        "caspr": [bodies + BETWEEN + cables],
        "universal": [_universal(binary, kind) for binary in (0, 1) for kind in (1, 4)],
        "trajectory": [
            b"time_s,x_m,y_m,z_m,rx_deg,ry_deg,rz_deg\n" + b"".join(b"%d,0,0,%d,0,0,5\n" % (t, t) for t in range(5)),
            b"\xef\xbb\xbf# remark\ntime_s,x_m,y_m,z_m\n0,1,2,3\n.5,1,2,3\n1,1,2,3 # here\n1.5,1,2,4,,\n",
        ],
    }


def _tables() -> list[bytes]:
    """A table of each kind of data, behind the byte that chooses the kind."""
    time = [0.01 * i for i in range(70)]
    cells = [f"{t:.2f},{np.cos(20 * t):.3f},{np.sin(20 * t):.3f},0" for t in time]
    wide = ",".join(f"tension_{i}_N,length_{i}_m" for i in range(1, 9))
    texts = (
        STATES["states.csv"].decode(),
        f"{POSE},payload_kg,sigma,temperature_K\na1,0,0,1.1,0,0,0,10,0.01,293\na2,0,0,1.0,,,,20,,\n",
        f"{POSE},cable,mode,frequency_hz,plane,tension_N\n{_AT},1,1,3.8,in,300\n{_AT},1,2,7.3,out,300\n",
        STATES["pitches.csv"].decode(),
        f"{POSE},frequency_hz,real,imag,respond,excite\n" + "".join(f"{_AT},{f},{1 / f},0.1,z,z\n" for f in (1, 2, 3)),
        f"{POSE},time_s,ax,ay,az\n" + "".join(f"{_AT},{cell}\n" for cell in cells),
        "time_s,x_m,y_m,z_m,rx_deg,ry_deg,rz_deg\n" + "".join(f"{t:.2f},0,0,1.2,0,0,{t:.2f}\n" for t in time),
        "time_s,ax,ay,az\n" + "\n".join(cells),
    )
    seeds = [bytes([number]) + text.encode() for number, text in enumerate(texts)]
    return [*seeds, f"\0{POSE},{wide},approach_1\n{_AT},{','.join(['300,10'] * 8)},1\n".encode()]


def _universal(binary: int, kind: int) -> bytes:
    """Two datasets 58, an FRF or a signal in time."""
    hertz = np.linspace(0.0, 5.0, 12)
    one = pyuff.prepare_58(
        binary=binary, func_type=kind, id1="a", id2="b", id3="c", id4="d", id5="e", rsp_ent_name="A", rsp_node=1,
        rsp_dir=3, ref_ent_name="A", ref_node=1, ref_dir=-3, abscissa_spacing=1, abscissa_spec_data_type=18,
        ordinate_spec_data_type=8, orddenom_spec_data_type=13, x=hertz,
        data=hertz / (9.0 - hertz + 0.1j) if kind == 4 else hertz,
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "one.uff"
        pyuff.UFF(str(path)).write_sets([one, one], mode="add")
        return path.read_bytes()


WORDS = (
    b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e-320", b"0", b"-0.0", b"-1", b"1e12", b"1.0000001e12",
    b"1e-13", b"999999999999999999999", b"0x7fffffffffffffff", b"1_000", b"2026-11-25", b"07:32:00", b"true",
    b'""', b"[]", b"{}", b"[[]]", b"[nan, inf, 0]", b"'''", b'"""', b"\\u0000", b"\\ud800", b"\xff\xfe",
    b"\xc3\x28", b"\0", b"\r", b"\x1b[31m", b"\xe2\x80\xae", b"a.b.c", b'"a\\nb"', b"=cmd|'/C calc'!A0",
    b"../../etc/passwd", b"<script>", b"$\\foo$", b"%s{0}", b"[[cables]]", b"[[bodies]]", b"[[lumps]]",
    b"[[measurement]]", b"[platform]", b"[extensions]", b"[nominal]", b"[loss]", b"case", b"x_m", b"tension_N",
    b"tension_1_N", b"length_1_m", b"frequency_hz", b"payload_kg", b"sigma", b"approach", b"time_s",
    b"temperature_K", b"cable", b"mode", b"plane", b"respond", b"excite", b"predicted_x_m", b"?", b"kN", b"#",
    b"<!ENTITY", b"<!DOCTYPE a>", b"<![CDATA[", b"&#0;", b"&lt;", b"    -1\n", b"    58\n", b"    58b\n",
    b"   151\n", b";",
)  # fmt: skip
"""Words that are spliced in: edges of numbers, of texts and of the formats."""
