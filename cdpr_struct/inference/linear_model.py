"""A campaign, linearised: blocks (states of the robot) that share parameters z only, and the scales of their noise."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from cdpr_struct.inference.scale_mixture import GroupedReadings, NoiseGroups
from cdpr_struct.inference.stack import Stack
from cdpr_struct.inference.white_rows import WhiteRows

__all__ = ["LinearModel", "Stack"]


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Blocks, stacked by size, and the scales of their readings' noise.

    stacks : all with the same t parameters; one of them may have soft rows
    groups : scales that the readings' `index` refers to

    Without slots, as white rows and grouped readings are kept once they were asked for.
    """

    stacks: tuple[Stack, ...]
    groups: NoiseGroups

    def __post_init__(self) -> None:
        object.__setattr__(self, "stacks", tuple(self.stacks))
        if not self.stacks or len({stack.X.shape[2] for stack in self.stacks}) > 1:
            shapes = [stack.X.shape for stack in self.stacks]
            raise ValueError(f"LinearModel needs stacks with the same number of parameters, got X of {shapes}")
        if sum(len(stack.soft) > 0 for stack in self.stacks) > 1:
            raise ValueError("one stack of a LinearModel at most may have soft rows")
        _ = self.readings

    @property
    def parameters(self) -> int:
        """Number t of parameters z."""
        return self.stacks[0].X.shape[2]

    @cached_property
    def readings(self) -> GroupedReadings:
        """Which readings have which scale."""
        return GroupedReadings(self.groups, tuple(stack.index for stack in self.stacks))

    @cached_property
    def white(self) -> WhiteRows:
        """The rows, made comparable; ValueError if hard rows of a block have no independent noise."""
        return WhiteRows.of(self.stacks)

    def with_columns(self, more: Sequence[np.ndarray]) -> "LinearModel":
        """The same data with more parameters, columns (K_i, n_i, d) per prior sigma, behind the present ones."""
        pairs = zip(self.stacks, more, strict=True)
        return replace(self, stacks=tuple(stack.with_columns(columns) for stack, columns in pairs))

    def with_noise(self, more: Sequence[np.ndarray]) -> "LinearModel":
        """The same data with more noise: columns (K_i, n_i, e), each times an own standard normal number per block.

        Their scale is not inferred and they are no part of stated sigmas, so states of the noise fit both models, and
        evidences compare. In a `Fit`, they follow the readings.
        """
        pairs = zip(self.stacks, more, strict=True)
        return replace(self, stacks=tuple(stack.with_noise(columns) for stack, columns in pairs))

    def with_residual(self, r: Sequence[np.ndarray]) -> "LinearModel":
        """The same model of other data, (K_i, n_i)."""
        pairs = zip(self.stacks, r, strict=True)
        return replace(self, stacks=tuple(replace(stack, r=value) for stack, value in pairs))
