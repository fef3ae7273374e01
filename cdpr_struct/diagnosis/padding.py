"""Interim: shelves of unequal blocks in the padded form."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.scale_mixture import NoiseGroups


@dataclass
class Stack:
    r: np.ndarray
    A: np.ndarray
    X: np.ndarray
    floor: np.ndarray
    index: np.ndarray
    soft: np.ndarray


def sizes(stacks):
    hard = max(s.r.shape[1] - len(s.soft) for s in stacks)
    soft = max(len(s.soft) for s in stacks)
    q = max(s.index.shape[1] for s in stacks)
    return hard, soft, q


def rows(parts, softs, hard, soft, fill=0.0):
    out = []
    for p, s in zip(parts, softs):
        h = p.shape[1] - s
        k = p.shape[0]
        extra = p.shape[2:]
        a = np.full((k, hard + soft, *extra), fill)
        a[:, :h] = p[:, :h]
        if s:
            a[:, hard : hard + s] = p[:, h:]
        out.append(a)
    return np.concatenate(out)


def model(stacks, kind, fixed):
    hard, soft, q = sizes(stacks)
    sf = [len(s.soft) for s in stacks]
    A = rows([np.pad(s.A, ((0, 0), (0, 0), (0, q - s.A.shape[2]))) for s in stacks], sf, hard, soft)
    index = np.concatenate([np.pad(s.index, ((0, 0), (0, q - s.index.shape[1])), constant_values=-1) for s in stacks])
    return LinearModel(
        rows([s.r for s in stacks], sf, hard, soft),
        A,
        rows([s.X for s in stacks], sf, hard, soft),
        rows([s.floor for s in stacks], sf, hard, soft, 1.0),
        NoiseGroups(index, kind, fixed),
        np.arange(hard, hard + soft),
    )
