"""Packages that read recordings: loaded when a file needs them, and their errors as sentences."""

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from cdpr_struct.errors import CdprError, InputError

_LOUD = ("asammdf", "nptdms", "rosbags")  # they log what becomes a sentence here
_LONGEST = 200  # characters of a package's own reason


def library(name: str, form: str, path: Path) -> Any:
    """The module that reads a form of recording.

    Raises
    ------
    InputError : it is not installed; which extra to install.
    """
    for logger in _LOUD:
        logging.getLogger(logger).setLevel(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return import_module(name)
    except ImportError as error:
        expected = f"pip install 'cdpr-struct[recordings]', which brings {name.partition('.')[0]} to read it"
        raise InputError(str(path), "", form, expected) from error


@contextmanager
def reading(path: Path, form: str) -> Iterator[None]:
    """Around calls of such a package: what it raises of a damaged file becomes one sentence, its warnings are silent.

    Raises
    ------
    InputError : the file is damaged, or of a kind that the package does not know.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except CdprError:
        raise
    except Exception as error:  # these packages raise whatever their parsing runs into
        raise damaged(path, form, error) from error


def damaged(path: Path, form: str, error: Exception) -> InputError:
    """The sentence on a file that cannot be read."""
    reason = " ".join(str(error).split())[:_LONGEST]
    said = f"{type(error).__name__}: {reason}" if reason else type(error).__name__
    return InputError(str(path), "", f"{form} that cannot be read", f"a whole file of that kind ({said})")
