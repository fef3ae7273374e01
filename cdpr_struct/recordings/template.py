"""A mapping file to fill in: what the names of a recording's channels suggest, and ? where they suggest nothing."""

import re
from collections.abc import Iterator, Sequence

from cdpr_struct.recordings.channel import Channel
from cdpr_struct.recordings.mapping import UNFILLED
from cdpr_struct.recordings.unit import kind_of, unit_in_name

_TIME = re.compile(r"(?:^|[/._ ])(time|t|timestamp|zeit)(?:_?\w{0,2}|\s*[\[(].*)$", re.IGNORECASE)
_NUMBER = re.compile(r"\d+")
_WORDS = {
    "lengths": ("length", "len", "encoder", "winch", "joint", "position[", "laenge", "länge"),
    "tensions": ("tension", "force", "load", "effort", "kraft", "ftens"),
}
_LONE = {
    "lengths": re.compile(r"(?:^|[/._ ])l\W*\d", re.IGNORECASE),
    "tensions": re.compile(r"(?:^|[/._ ])[ft]\W*\d", re.I),
}
_HEAD = """# cdpr-struct import-recording RECORDING MAPPING.toml --out campaign
robot = "?"                        # built-in name, or path of a robot file as seen from here
"""
_SAMPLING = """

[sampling]
mode = "still"                     # still: means where the robot stands still; motion: frames with time_s; free_motion
# span = [0.0, 60.0]               # s, of the recording
# rate_hz = 4.0                    # of a motion: evenly spaced frames, interpolated; every = 10: each tenth
# still_speed = 0.002              # m/s (and rad/s) below which the robot stands still, for least_s = 1.0
# faulty = "leave_out"             # samples that are no numbers, and frames in gaps above largest_gap_s
[sigma]                            # of your sensors, one sigma; in mode still what is not given comes from the scatter
# position_m = 0.0005
# rotation_deg = 0.02
# length_m = 0.0005
# tension_N = 2.0
"""
_UNITS = {"length": "m", "force": "N", "angle": "rad", "time": "s"}
_FEWEST, _MOST = 3, 16  # cables


def template(channels: Sequence[Channel], file: str, ros: bool) -> str:
    """Text of a mapping file.

    file : name of the recording;  ros : its messages have SI units, as the rules of ROS say
    """
    triple, turns = _position(channels), _quaternion(channels)
    taken = {*triple, *turns}
    lengths, tensions = (_cables(channels, name, taken) or [UNFILLED] for name in _WORDS)
    lines = [
        f"# Which channel of {_printable(file)} is what. Replace each {UNFILLED}, delete what you do not need, then:",
        _HEAD,
        *_time(channels),
        "[position]                         # of the platform's origin, in the frame of the robot file",
        *_entry(channels, triple or [UNFILLED] * 3, "length", ros),
        "# factor = [1, 1, -1]              # of all channels, or one each; offset in m, of all or one each",
        "[rotation]                         # platform to world; form: quaternion, angles or rotation_vector",
        'form = "quaternion"',
        f'order = "{_order(turns)}"                     # what the channels are; w is the real part',
        f"channels = {_list(turns or [UNFILLED] * 4)}",
        "# inverse = true                   # if they turn the world's axes to the platform's",
        "",
        '[lengths]                          # unstrained, paid out; cable by cable, "" for one without a sensor',
        *_entry(channels, lengths, "length", ros),
        '[tensions]                         # at the platform; cable by cable, "" for one without a load cell',
        *_entry(channels, tensions, "force", ros),
        "# factor = -1.0                    # where pulling reads negative",
    ]
    return "\n".join(lines) + _SAMPLING


def _time(channels: Sequence[Channel]) -> Iterator[str]:
    if all(channel.clock for channel in channels):
        if any(channel.clock == "stamp" for channel in channels):
            yield '[time]\nclock = "stamp"                    # of the messages; or received, that of the recorder\n'
        return
    found = next((channel for channel in channels if _TIME.search(channel.name)), None)
    unit = found.unit if found and kind_of(found.unit) == "time" else UNFILLED
    yield f"[time]\nchannel = {_text(found.name if found else UNFILLED)}\nunit = {_text(unit)}\n"


def _position(channels: Sequence[Channel]) -> list[str]:
    return next(iter(_tuples(channels, "xyz", ("pos", "trans"), "length")), [])


def _quaternion(channels: Sequence[Channel]) -> list[str]:
    return next(iter(_tuples(channels, "wxyz", ("orient", "rot", "q"), None)), [])


def _tuples(channels: Sequence[Channel], axes: str, words: Sequence[str], kind: str | None) -> list[list[str]]:
    """Channels whose names differ in the axis only; those first that one of the words is in."""
    found: dict[str, dict[str, str]] = {}
    for channel in channels:
        bare = re.sub(r"\s*[\[(][^\])]*[\])]$", "", channel.name)
        bare = bare.removesuffix(f"_{unit_in_name(bare)}") if unit_in_name(bare) else bare
        if bare and bare[-1].lower() in axes and kind_of(channel.unit) in (None, kind):
            found.setdefault(bare[:-1], {}).setdefault(bare[-1].lower(), channel.name)
    whole = {stem: named for stem, named in found.items() if set(named) == set(axes)}
    liked = sorted(whole, key=lambda stem: not any(word in stem.lower() for word in words))
    return [[channel.name for channel in channels if channel.name in whole[stem].values()] for stem in liked]


def _order(names: Sequence[str]) -> str:
    letters = "".join(re.sub(r"\s*[\[(][^\])]*[\])]$", "", name)[-1].lower() for name in names)
    return letters if sorted(letters) == sorted("wxyz") else "wxyz"


def _cables(channels: Sequence[Channel], what: str, taken: set[str]) -> list[str]:
    """Channels of one group that differ in a number, or in what stands in brackets, and are called like a quantity."""
    kind = "length" if what == "lengths" else "force"
    found: dict[tuple[str, str], list[str]] = {}
    for channel in channels:
        stem = _NUMBER.sub("#", re.sub(r"\[[^\]]*\]", "[#]", channel.name), count=0)
        if channel.name not in taken and stem != channel.name and kind_of(channel.unit) in (None, kind):
            found.setdefault((channel.group, stem), []).append(channel.name)
    for names in found.values():
        called = any(word in names[0].lower() for word in _WORDS[what]) or _LONE[what].search(names[0])
        if called and _FEWEST <= len(names) <= _MOST:
            taken.update(names)
            return names
    return []


def _entry(channels: Sequence[Channel], names: Sequence[str], kind: str, ros: bool) -> Iterator[str]:
    units = {channel.name: channel.unit for channel in channels}
    told = units.get(names[0], "")
    unit = told if kind_of(told) == kind else _UNITS[kind] if ros else UNFILLED
    yield f"channels = {_list(names)}"
    yield f"unit = {_text(unit)}"


def _list(names: Sequence[str]) -> str:
    return "[" + ", ".join(map(_text, names)) + "]"


def _text(text: str) -> str:
    """A TOML string."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped) + '"'


def _printable(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)
