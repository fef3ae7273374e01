"""The linearised material that every method gets: whitened residuals, and signatures of all causes.

It is what `cdpr_struct.diagnosis` prepares before its first hypothesis, so no method has to invent the null. Preparing
takes seconds, so it is kept in a file beside the answers, under a fingerprint of the campaign and of the package.
"""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

import cdpr_struct
from cdpr_struct.diagnosis.evidence import Candidate
from cdpr_struct.diagnosis.null_model import NullModel, reading_count, tolerance_count
from cdpr_struct.diagnosis.prepared import BUDGETS, Prepared, prepare
from cdpr_struct.diagnosis.refit import Ground
from cdpr_struct.diagnosis.world import World
from cdpr_struct.measurement.campaign_file import load_campaign

ALIKE = "all alike"


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """A campaign, linear and white.

    z, candidates : (n,) residuals and signatures, whitened by sensor noise and tolerances
    hidden        : causes that at their typical size hide in noise and tolerances
    noise_z, noise_candidates : the same whitened by sensor noise alone
    """

    z: np.ndarray
    candidates: list[Candidate]
    hidden: frozenset[str]
    noise_z: np.ndarray
    noise_candidates: list[Candidate]

    @property
    def visible(self) -> list[Candidate]:
        """Candidates that a typical occurrence would show."""
        return [candidate for candidate in self.candidates if candidate.name not in self.hidden]


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """Single parameters in prior sigmas: signatures (n, p), and the cause (p,) of each."""

    signature: np.ndarray
    cause: np.ndarray


def single_parameters(found: list[Candidate]) -> Columns:
    """Every basic parameter, and those of all cables alike; what changes nothing is left out."""
    parts, names = [], []
    for candidate in found:
        own = [_basic_priors(candidate)]
        own += [p.basis * p.prior for p in candidate.patterns if p.label == ALIKE]
        part = candidate.signature @ np.hstack(own)
        part = part[:, np.linalg.norm(part, axis=0) > 1e-9]
        parts.append(part)
        names += [candidate.name] * part.shape[1]
    return Columns(np.hstack(parts), np.array(names))


def _basic_priors(candidate: Candidate) -> np.ndarray:
    """(d, d) diagonal, prior sigma of each basic parameter, from the patterns that single it out."""
    prior = np.zeros(candidate.signature.shape[1])
    for pattern in candidate.patterns:
        if pattern.label != ALIKE:
            prior[pattern.basis.argmax(axis=0)] = pattern.prior
    return np.diag(prior)


def material_of(campaign: Path) -> Material:
    """Prepare a campaign.

    campaign : the campaign file
    """
    return _linear(prepare(load_campaign(campaign), BUDGETS["small"]))


def _linear(prepared: Prepared) -> Material:
    ground = prepared.ground
    white = [_bare(candidate, candidate.signature) for candidate in ground.candidates]
    lower = _noise_alone(ground)
    turn = np.linalg.solve(lower, ground.null.lower)
    raw = [_bare(candidate, turn @ candidate.signature) for candidate in white]
    hidden = frozenset(c.name for c in white if c.name in prepared.not_testable)
    return Material(ground.z, white, hidden, turn @ ground.z, raw)


def _noise_alone(ground: Ground) -> np.ndarray:
    """(n, n) Cholesky factor of the covariance without tolerances, and without what their linearisation misses."""
    null: NullModel = ground.null
    noise = reading_count(ground.setting)
    columns = np.delete(null.columns[:, : -len(null.r)], slice(noise, noise + tolerance_count(ground.setting)), axis=1)
    return np.linalg.cholesky(columns @ columns.T)


def _bare(candidate: Candidate, signature: np.ndarray) -> Candidate:
    """A candidate that can be written to a file: its cause is a name only."""
    cause = replace(candidate.cause, apply=_linear_only, count=None, needs=str)
    return Candidate(cause, signature, candidate.patterns)


def _linear_only(world: World, theta: np.ndarray) -> World:
    raise NotImplementedError("linearised material knows nothing of worlds")


def kept_material(campaign: Path, file: Path) -> Material:
    """The material of a campaign from the file, or prepared and written there if that is missing or outdated."""
    mark = _fingerprint([*sorted(campaign.parent.iterdir())]) + _package()
    if file.exists():
        known, material = pickle.loads(file.read_bytes())
        if known == mark:
            return material
    material = material_of(campaign)
    file.parent.mkdir(parents=True, exist_ok=True)
    write_whole(file, pickle.dumps((mark, material)))
    return material


def write_whole(file: Path, data: bytes) -> None:
    """Write a file under another name first, so that a break leaves no half of it."""
    part = file.with_name(f"{file.name}.{os.getpid()}.part")
    part.write_bytes(data)
    part.replace(file)


@lru_cache
def _package() -> str:
    """Fingerprint of the code that prepares."""
    return _fingerprint(sorted(Path(cdpr_struct.__file__).parent.rglob("*.py")))


def _fingerprint(files: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{file.name}:{file.stat().st_size}:".encode() + file.read_bytes())
    return digest.hexdigest()
