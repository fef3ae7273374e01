"""Which cases a set holds, in which order, and from which seeds."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

import numpy as np

from tests.blind.case_drawing import CaseKind
from tests.blind.catalogue import (
    CONVENTION,
    EQUIVALENT,
    HANDLING,
    LAWS,
    LIBRARY,
    OUTSIDE,
    OUTSIDE_DEV,
    OUTSIDE_HELD,
    RARE,
    UNSEEN,
    UNSEEN_IN_STATICS,
)
from tests.blind.measuring_plan import PlanSize

FULL = {"null": 40, "single": 80, "pair": 24, "ambiguous": 20, "outside": 20, "handling": 16}
CI = {"null": 3, "single": 3, "pair": 1, "ambiguous": 2, "outside": 2, "handling": 1}
MULTIPLES = (0.5, 1.0, 2.0, 4.0)
SMALL = PlanSize(static_states=8, locks=1, loads_per_lock=3)
SMALL_SETS = ("conventions-small", "no-conventions")  # without frequencies, of few states
CLEAR = 4.0  # multiple of effects whose size is not the question
FINAL_RATES = {"null": 60, "just": 150, "pair": 56}  # beside a final set, which has few of each
NULLS = 0.6  # share of nulls in a set of rates; the rest is just detectable
SET_SEEDS = {"dev": 20_101, "ci": 20_102, "unseen": 20_103, "rates": 20_104}
SET_SEEDS |= {"laws": 20_105, "rare": 20_106}
SET_SEEDS |= {"messy": 31_201, "peaks": 31_202, "sizes": 31_203}
SET_SEEDS |= {"messy-dev": 31_301, "peaks-dev": 31_302, "sizes-dev": 31_303}
SET_SEEDS |= {"few": 31_204, "few-dev": 31_304, "causes": 31_214, "one-cable": 31_215}
SET_SEEDS |= {"unread": 31_206, "wheels": 31_207, "unread-dev": 31_306, "wheels-dev": 31_307}
SET_SEEDS |= {"outside-dev": 31_401, "outside-held": 31_402}
SET_SEEDS |= {"conventions": 31_205, "conventions-small": 31_209, "no-conventions": 31_210}
SET_SEEDS |= {"frfs": 31_211, "decays": 31_212, "motions": 31_213}
SET_SEEDS |= {"frfs-dev": 31_311, "decays-dev": 31_312, "motions-dev": 31_313}
SET_SEEDS |= {"delays": 31_208, "delays-dev": 31_308}
USES = Path(__file__).with_name("final_uses.json")


def set_seed(name: str, release: str = "") -> int:
    """Base seed of a set: with a release its own, unknown before the release has a name. A final set needs one."""
    if name in SET_SEEDS and not release:
        return SET_SEEDS[name]
    if not release:
        raise ValueError("the final set needs --release NAME: its seeds are that release's own")
    return int(hashlib.sha256(f"{name} set of {release}".encode()).hexdigest()[:12], 16)


def counts(total: int, full: Mapping[str, int] = FULL) -> dict[str, int]:
    """How many cases of each kind: the full suite scaled, largest remainders rounded up."""
    whole = sum(full.values())
    shares = {kind: number * total / whole for kind, number in full.items()}
    chosen = {kind: int(share) for kind, share in shares.items()}
    by_remainder = sorted(shares, key=lambda kind: shares[kind] - chosen[kind], reverse=True)
    for kind in by_remainder[: total - sum(chosen.values())]:
        chosen[kind] += 1
    return chosen


def composed(name: str, total: int, base: int) -> list[CaseKind]:
    """Kinds of all cases in the order in which they are numbered, which tells nothing about them."""
    rng = np.random.default_rng([base, 0])
    nulls = round(NULLS * total)
    special = {
        "ci": CI,
        "unseen": {"unseen": total},
        "laws": {"law": total},
        "rare": {"rare": total - total // 3, "timed": total // 3},
        "outside-dev": {"outside_dev": total},
        "outside-held": {"outside_held": total},
        "conventions": {"convention": total},
        "conventions-small": {"convention": total},
        "no-conventions": counts(total, {"null": 2, "single": 2}),
        "rates": {"null": nulls, "just": total - nulls},
        "final-rates": counts(total, FINAL_RATES),
    }
    numbers = special.get(name) or counts(total)
    makers = {
        "null": _nulls,
        "single": _singles,
        "just": _just_detectable,
        "pair": _pairs,
        "ambiguous": _ambiguous,
        "outside": _outside,
        "handling": _handling,
        "convention": _conventions,
        "unseen": _unseen,
        "law": _laws,
        "rare": _rare,
        "timed": _timed_nulls,
        "outside_dev": partial(_static_outside, [*OUTSIDE_DEV]),
        "outside_held": partial(_static_outside, [*OUTSIDE_HELD]),
    }
    kinds = [kind for key, maker in makers.items() if key in numbers for kind in maker(numbers[key], rng)]
    if name in SMALL_SETS:
        kinds = [replace(_seen_at_rest(kind), statics=True, size=SMALL, noise="white") for kind in kinds]
    return [kinds[index] for index in rng.permutation(len(kinds))]


def _seen_at_rest(kind: CaseKind) -> CaseKind:
    """The same, or a null where rests do not show the effect."""
    return CaseKind("null") if any(name in UNSEEN_IN_STATICS for name, _ in kind.effects) else kind


def _nulls(count: int, rng: np.random.Generator) -> list[CaseKind]:
    """A quarter with coloured noise or an outlier, a tenth without lengths."""
    odd = {3: "coloured", 7: "outlier"}
    return [CaseKind("null", noise=odd.get(n % 8, "white"), lengths=n % 10 != 9) for n in range(count)]


def _dealt(names: Sequence[str], count: int, rng: np.random.Generator) -> list[str]:
    """Names in random order, each used once before any is used again."""
    rounds = [rng.permutation(list(names)) for _ in range(count // len(names) + 1)]
    return [str(name) for name in np.concatenate(rounds)[:count]]


def _singles(count: int, rng: np.random.Generator) -> list[CaseKind]:
    multiples = [MULTIPLES[(3 - n) % 4] for n in range(count)]
    return [CaseKind("single", ((n, m),)) for n, m in zip(_dealt([*LIBRARY], count, rng), multiples, strict=True)]


def _just_detectable(count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("single", ((name, 1.0),)) for name in _dealt([*LIBRARY], count, rng)]


def _pairs(count: int, rng: np.random.Generator) -> list[CaseKind]:
    """Two different effects, each twice or four times what can be detected."""
    names = [name for name in LIBRARY if name not in ("internal_force", "pulley_radius")]
    pairs = [rng.choice(names, 2, replace=False) for _ in range(count)]
    return [CaseKind("pair", tuple((str(n), float(rng.choice(MULTIPLES[2:]))) for n in pair)) for pair in pairs]


def _ambiguous(count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("ambiguous", ((name, CLEAR),)) for name in _dealt([*EQUIVALENT], count, rng)]


def _outside(count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("outside", ((name, CLEAR),)) for name in _dealt([*OUTSIDE], count, rng)]


def _unseen(count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("outside", ((name, CLEAR),)) for name in _dealt([*UNSEEN], count, rng)]


def _rare(count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("law", ((name, 1.0),), timed=True) for name in _dealt([*RARE], count, rng)]


def _timed_nulls(count: int, rng: np.random.Generator) -> list[CaseKind]:
    del rng
    return [CaseKind("null", timed=True)] * count


def _laws(count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("law", ((name, 1.0),)) for name in _dealt([name for name in LAWS if name not in RARE], count, rng)]


def _static_outside(names: Sequence[str], count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("outside", ((name, CLEAR),), statics=True) for name in _dealt(names, count, rng)]


def _handling(count: int, rng: np.random.Generator) -> list[CaseKind]:
    return [CaseKind("handling", ((name, CLEAR),)) for name in _dealt(HANDLING, count, rng)]


def _conventions(count: int, rng: np.random.Generator) -> list[CaseKind]:
    del rng
    return [CaseKind("handling", ((CONVENTION, CLEAR),))] * count


def record_final_use(release: str, uses: Path = USES) -> None:
    """Write down that the final set of a release is being made; a second time is refused."""
    known = json.loads(uses.read_text("utf-8")) if uses.exists() else []
    if any(use["release"] == release for use in known):
        raise ValueError(f"the final set of release {release!r} was already used; see {uses.name}")
    known.append({"release": release, "date": datetime.now(UTC).date().isoformat()})
    uses.write_text(json.dumps(known, indent=1) + "\n", "utf-8")
