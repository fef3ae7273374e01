"""Sets of spoilt campaigns: one drawn reality, read in several ways, and one drawn cause in several sizes.

messy : static campaigns, clean and spoilt in six ways
peaks : campaigns with frequencies, clean, spoilt in six ways, and in all of them at once
sizes : the same cause at 2, 4, 8 and 16 times what can be detected, with and without frequencies
few   : static campaigns, clean, of robots with two to five cables, and of others whose position nobody reads
unread : static campaigns, clean, of robots with eight cables of whose pose nobody reads anything
frfs, decays, motions : static campaigns with frequency responses, decays or tracked free motions, clean and spoilt
wheels : static campaigns, clean, of robots without pulleys, with half of them, and with all but in their file
one-cable : EA of one of six cables over pulleys, 8 to 40 % too low in the robot file, modes nearly double
causes : every cause alone, clear, in static campaigns and with frequencies, a third of them spoilt
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product

import numpy as np

from cdpr_struct.fem_reference import FemError
from tests.blind.case_drawing import (
    ATTEMPTS,
    ROBOTS,
    SUSPENDED,
    Case,
    CaseKind,
    Reality,
    RejectedDrawError,
    drawn_reality,
    sized,
    truth_record,
)
from tests.blind.catalogue import EQUIVALENT, HANDLING, LAWS, LIBRARY, RARE, UNSEEN_IN_STATICS
from tests.blind.detectability import FEW, UNREAD
from tests.blind.entered_robot import BARE_PART, HALF_SUFFIX
from tests.blind.measuring_plan import PlanSize
from tests.blind.note_errors import mistaken
from tests.blind.observation import SlackStateError
from tests.blind.sensors import INCLINATION_READ, NOTHING_READ, Noise, filed, picked, unplaced
from tests.blind.spoiled_peaks import PeakSpoiler, spoil_peak_tables
from tests.blind.spoiled_readings import spoil_readings
from tests.blind.spoiled_signals import DECAY, FRF, MOTION, SIGNALS, TOO_SMALL, SignalSpoiler, may_be_said

DEVELOPMENT = "-dev"
MESSY = ("clean", "student", "outliers", "poses", "missing", "drift", "rounded", "tracker", "encoders")
PEAKS = ("clean", "missing", "spurious", "merged", "line", "exchanged", "student", "all", "all")
SIZES = (2.0, 4.0, 8.0, 16.0)
CLEAR = 4.0  # multiple of effects whose size is not the question
NULLS = 3  # every third reality holds no effect
FREQUENCY_STATES = 6  # of `peaks`: two of them are exchanged
IN_SERIES = ("joint_compliance", "dead_length")
RECORDED = {"frfs": FRF, "decays": DECAY, "motions": MOTION}
MULTIPLES = (0.0, 2.0, 4.0)  # of what is hidden beside signals, in turn
SIGNAL_SIZE = PlanSize(static_states=12, locks=2, loads_per_lock=3, frequency_states=4)
WHEELS = ("points", "half", "bare")
BARE_RADII = (20, 61)  # mm
MOTIONLESS = "static"
VIBRATING = "with frequencies"
ONE_CABLE = "six-cables-pulleys"
STIFFER = (1.08, 1.15, 1.25, 1.40)  # true EA of one cable, in that of the robot file
PATTERNS_TRIED = 10  # of an effect for each robot, to see whether it can be that large


@dataclass(frozen=True)
class SpoiltKind:
    """What a case is to hold.

    group   : cases of one group share their reality, up to the size of its effect
    reality : null or single
    way     : how its readings are spoilt
    largest : largest multiple in the group; all have to be possible
    signal  : kind of the vibration records; "" for frequencies that somebody read
    by_cause : its row of the table is that of what it hides
    """

    group: int
    reality: CaseKind
    way: str
    largest: float = CLEAR
    signal: str = ""
    by_cause: bool = False


def spoilt_kinds(name: str, total: int, base: int) -> list[SpoiltKind]:
    """Kinds of all cases in the order in which they are numbered, which tells nothing about them."""
    rng = np.random.default_rng([base, 0])
    kind = name.removesuffix(DEVELOPMENT)
    makers = {"messy": _messy, "peaks": _peaks, "sizes": _sizes, "causes": _causes, "few": _few, "unread": _unread}
    makers |= {"wheels": _wheels, "one-cable": _one_cable}
    kinds = list(_signals(total, rng, RECORDED[kind]) if kind in RECORDED else makers[kind](total, rng))
    return [kinds[index] for index in rng.permutation(len(kinds))]


def _realities(count: int, names: list[str], rng: np.random.Generator) -> list[CaseKind]:
    """A third of nulls, the rest single effects, each name once before any is used again."""
    dealt = np.concatenate([rng.permutation(names) for _ in range(count // len(names) + 1)])
    singles = (CaseKind("single", ((str(name), CLEAR),)) for name in dealt)
    return [CaseKind("null") if number % NULLS == 0 else next(singles) for number in range(count)]


def _names(statics: bool) -> list[str]:
    names = [*LIBRARY, *IN_SERIES]
    return [name for name in names if not (statics and name in UNSEEN_IN_STATICS)]


def _messy(total: int, rng: np.random.Generator) -> Iterator[SpoiltKind]:
    for group, kind in enumerate(_realities(total // len(MESSY), _names(True), rng)):
        yield from (SpoiltKind(group, replace(kind, statics=True), way) for way in MESSY)


def _peaks(total: int, rng: np.random.Generator) -> Iterator[SpoiltKind]:
    size = PlanSize(frequency_states=FREQUENCY_STATES)
    for group, kind in enumerate(_realities(total // len(PEAKS), _names(False), rng)):
        yield from (SpoiltKind(group, replace(kind, size=size), way) for way in PEAKS)


def _signals(total: int, rng: np.random.Generator, signal: str) -> Iterator[SpoiltKind]:
    """A third each of nulls, and of effects of 2 and 4 times the smallest size that statics can detect."""
    names = iter(rng.permutation(_names(True)).tolist() * total)
    for group in range(total // len(SIGNALS)):
        multiple = MULTIPLES[group % len(MULTIPLES)]
        effects = ((next(names), multiple),) if multiple else ()
        kind = CaseKind("single" if effects else "null", effects, size=SIGNAL_SIZE, statics=True, signals=True)
        yield from (SpoiltKind(group, kind, way, multiple, signal) for way in SIGNALS)


def _sizes(total: int, rng: np.random.Generator) -> Iterator[SpoiltKind]:
    """Causes whose largest size is still plausible, see `Effect.largest`; a group is one cause in four sizes."""
    draws = total // (2 * len(SIZES))
    for number, statics in enumerate((True, False)):
        names = [name for name in _names(statics) if _reaches(name, SIZES[-1], statics)]
        dealt = np.concatenate([rng.permutation(names) for _ in range(draws // len(names) + 1)])
        for group, name in enumerate(dealt[:draws], start=draws * number):
            for size in SIZES:
                kind = CaseKind("single", ((str(name), size),), statics=statics)
                yield SpoiltKind(group, kind, MOTIONLESS if statics else VIBRATING, SIZES[-1])


def _few(total: int, rng: np.random.Generator, robots: Sequence[str] = FEW) -> Iterator[SpoiltKind]:
    """As many cases of each robot, a third of them nulls; of causes that can plausibly be that large there."""
    each, group = total // len(robots), 0
    for robot in robots:
        names = [name for name in _names(True) if _reaches(name, CLEAR, True, (robot,))]
        for kind in _realities(each, names, rng):
            yield SpoiltKind(group, replace(kind, statics=True, robot=robot), robot)
            group += 1


def _unread(total: int, rng: np.random.Generator) -> Iterator[SpoiltKind]:
    return _few(total, rng, UNREAD)


def _wheels(total: int, rng: np.random.Generator) -> Iterator[SpoiltKind]:
    """A third each of robots with points, with half of the pulleys, and with pulleys that nobody entered.

    Of the first two a third are nulls. The last hide nothing else; axes and radii are drawn.
    """
    each, group = total // len(WHEELS), 0
    for way in WHEELS[:2]:
        robots = [robot + (HALF_SUFFIX if way == "half" else "") for robot in SUSPENDED]
        names = [name for name in _names(True) if all(_reaches(name, CLEAR, True, (robot,)) for robot in robots)]
        for number, kind in enumerate(_realities(each, names, rng)):
            robot = robots[number // NULLS % 2]
            yield SpoiltKind(group, replace(kind, statics=True, robot=robot), way)
            group += 1
    for number in range(each):
        millimetres = int(rng.integers(*BARE_RADII))
        robot = f"{SUSPENDED[number % 2]}{BARE_PART}{('up', 'outwards')[number // 2 % 2]}-{millimetres}"
        yield SpoiltKind(group, CaseKind("null", statics=True, robot=robot), "bare")
        group += 1


def _one_cable(total: int, rng: np.random.Generator) -> Iterator[SpoiltKind]:
    """As many of each factor, without frequencies of single cables."""
    del rng
    size = PlanSize(static_states=12, locks=0, frequency_states=4)
    for group in range(total):
        factor = STIFFER[group % len(STIFFER)]
        effect = ("axial_stiffness", float(np.log(factor)))
        kind = CaseKind("single", (effect,), size=size, robot=ONE_CABLE, alone=True)
        yield SpoiltKind(group, kind, f"EA {factor:.2f}", effect[1])


def _causes(total: int, rng: np.random.Generator) -> Iterator[SpoiltKind]:
    """As many cases of each cause, all clear: half without frequencies where rests show it, every third spoilt.

    Laws have their typical size; a note-taker's mistake comes after whatever else spoils the readings.
    """
    laws = [name for name in LAWS if name not in RARE]
    names = [*_names(False), *laws, *HANDLING]
    for group, (number, name) in enumerate(product(range(total // len(names)), names)):
        kind = "handling" if name in HANDLING else "law" if name in laws else "single"
        statics = number % 2 == 0 and kind == "single" and name not in UNSEEN_IN_STATICS
        robot = str(rng.choice(_able(name))) if statics else ""
        multiple = 1.0 if kind == "law" else CLEAR
        reality = CaseKind(kind, ((name, multiple),), statics=statics, robot=robot)
        clean, spoiling = (MOTIONLESS, MESSY[1:]) if statics else (VIBRATING, PEAKS[1:])
        way = str(rng.choice(spoiling)) if group % NULLS == 0 else clean
        yield SpoiltKind(group, reality, way, multiple, by_cause=True)


@cache
def _able(name: str) -> list[str]:
    """Robots at rest that can have four times the smallest detectable size of an effect."""
    return [robot for robot in (*ROBOTS, *FEW) if _reaches(name, CLEAR, True, (robot,))]


def _reaches(name: str, multiple: float, statics: bool, robots: Sequence[str] = ROBOTS) -> bool:
    """Whether some robot can have an effect of so many times its detectable size that is not absurd."""
    effect, rng = {**EQUIVALENT, **LIBRARY}[name], np.random.default_rng(0)
    for robot in robots:
        for _ in range(PATTERNS_TRIED):
            try:
                sized(effect, robot, multiple, rng, name, statics)
            except RejectedDrawError:
                continue
            return True
    return False


def spoilt_cases(kinds: list[tuple[str, SpoiltKind]], base: int) -> Iterator[tuple[str, Case, tuple[int, ...]]]:
    """Name, case and seed of the numbered cases of one group, whose reality is drawn once for every size in it."""
    group = kinds[0][1].group
    realities = group_realities([kind for _, kind in kinds], (base, 1, group))
    for number, (name, kind) in enumerate(kinds):
        seed = (base, 2, group, number)
        yield name, read_case(kind, realities[kind.reality], seed), seed


def group_realities(kinds: list[SpoiltKind], seed: tuple[int, ...]) -> dict[CaseKind, Reality]:
    """The reality of every kind of a group: same robot, tolerances, pattern and plan, from one seed.

    What fails for one of them, or at the largest size, is drawn again for all.
    """
    largest = max(kind.largest for kind in kinds)
    wanted = dict.fromkeys(kind.reality for kind in kinds)
    first = next(iter(wanted))
    widest = replace(first, effects=tuple((name, largest) for name, _ in first.effects))
    for attempt in range(ATTEMPTS):
        try:
            return {kind: _drawn(kind, seed, attempt) for kind in dict.fromkeys([widest, *wanted])}
        except (RejectedDrawError, SlackStateError, FemError):
            continue
    raise RuntimeError(f"no campaign for {widest} with seed {seed} in {ATTEMPTS} attempts")


def _drawn(kind: CaseKind, seed: tuple[int, ...], attempt: int) -> Reality:
    streams = np.random.SeedSequence([*seed, attempt]).spawn(4)
    return drawn_reality(kind, streams, np.random.default_rng(streams[2]))


def read_case(kind: SpoiltKind, real: Reality, seed: tuple[int, ...]) -> Case:
    """The reality as sensors and note-taker of this seed leave it."""
    sensor, spoiler = (np.random.default_rng(stream) for stream in np.random.SeedSequence(seed).spawn(2))
    ways = frozenset(PEAKS) - {"all", "clean"} if kind.way == "all" else frozenset([kind.way])
    noise = Noise(sensor, "student" if "student" in ways else "white")
    if kind.signal:
        said, noise.scale = "", TOO_SMALL if kind.way == "sigma" else 1.0
        tables = filed(real.plan, replace(real.seen, cable_hz=np.zeros(0)), real.deviations, noise)
        tables[kind.signal] = SignalSpoiler(kind.signal, kind.way, spoiler).table(real.seen, tables["static_state"])
    elif kind.reality.statics:
        tables = filed(real.plan, real.seen, real.deviations, noise)
        said = "" if kind.way in (real.robot.name, MOTIONLESS, *WHEELS) else spoil_readings(kind.way, tables, spoiler)
        if not real.robot.tracked:
            tables = unplaced(tables, INCLINATION_READ if real.robot.inclined else NOTHING_READ)
    elif kind.reality.alone:
        said = ""
        tables = filed(real.plan, real.seen, real.deviations, noise)
        del tables["cable_frequency"], tables["loaded_pose"]
    else:
        peaks = PeakSpoiler(ways)
        picker = picked if kind.way == VIBRATING else peaks.picker()
        tables = filed(real.plan, real.seen, real.deviations, noise, picker=picker)
        said = f"{peaks.said} {spoil_peak_tables(ways, tables, spoiler)}"
    effects = real.effects
    if kind.way == "bare":
        radius, shape = real.robot.pulley_radius, real.robot.name.partition(BARE_PART)[2]
        effects = [{"cause": "missing_pulleys", "multiple": None, "size": radius, "unit": "m", "shape": shape}]
    if kind.reality.kind == "handling":
        effects = [mistaken(kind.reality.effects[0][0], tables, spoiler)]
    truth = truth_record(kind.reality, real.robot, effects, real.deviations)
    truth |= {"kind": "single"} if kind.way == "bare" or kind.by_cause else {}
    truth |= {"may_be_said": may_be_said(kind.signal, kind.way)} if kind.signal else {}
    asked = max((multiple for _, multiple in kind.reality.effects), default=0.0)
    truth |= {"way": kind.way, "group": kind.group, "spoilt": said, "asked": asked}
    by_size = kind.way in (MOTIONLESS, VIBRATING) and not kind.by_cause
    return Case(real.robot, tables, truth | {"by_size": by_size, "by_cause": kind.by_cause})
