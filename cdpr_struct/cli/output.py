"""Where a command's results go: files first, then the screen, or JSON on stdout."""

import os
import re
import shlex
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

from cdpr_struct.cli.progress import Begin, silent, steps
from cdpr_struct.cli.run_record import RUN, run_record
from cdpr_struct.cli.written_files import RESULT, Content, refuse_foreign, replace_files
from cdpr_struct.errors import InputError
from cdpr_struct.reports.plain_json import result_text
from cdpr_struct.reports.remarks import extensions_of, remarks, rest_of, warnings_of

if TYPE_CHECKING:
    from cdpr_struct.interface.result import Result

Files = Mapping[str, Content]
TableForm = Literal["md", "latex", "parquet"]
TABLE_FORMS: tuple[TableForm, ...] = get_args(TableForm)


@dataclass(frozen=True, slots=True)
class Output:
    """What --out, --json, --quiet, --overwrite and --tables say, and the command that repeats the run.

    directory : of --out, or None
    tables    : form in which each CSV table is written once more, or None
    words     : the command as typed, less where its results go; `--out=DIR` at the end
    """

    directory: Path | None
    json: bool
    quiet: bool
    overwrite: bool
    words: tuple[str, ...]
    tables: TableForm | None = None

    def check(self) -> None:
        """Refuse a directory with somebody else's results before any work is done.

        Raises
        ------
        InputError : result.json or report.html is there, and this program did not write it or it was changed since.
        """
        if self.directory is not None and not self.overwrite:
            refuse_foreign(self.directory, (RESULT, "report.html"))

    @contextmanager
    def steps(self, total: int) -> Iterator[Begin]:
        """A progress bar of `total` steps on stderr; call what it yields with the name of the step that begins."""
        if self.quiet:
            yield silent
            return
        with steps(total) as begin:
            yield begin

    def give(self, found: "Result", more: Callable[[], Files] = dict) -> None:
        """Deliver what a function of the interface answered; a result that says how it is repeated gets the command.

        more : makes files that were asked for beside those of the result
        """
        repeat = {"command": self.words} if "command" in found.answer else {}
        self.deliver({**found.answer, **repeat}, found.text, lambda: {**found.files(), **more()})

    def deliver(self, result: Mapping[str, Any], text: Callable[[], str], files: Callable[[], Files]) -> None:
        """Write the files, then print: JSON and nothing else, or `text` with warnings and notes on extensions.

        Files come first, so that a screen that is closed (`| head`) loses nothing.

        result : `warnings` (sentences), `locked` (how the rest at locked lengths was found) and `extensions` (as
        `extension_notes` makes it) are shown if they are there
        """
        if self.directory is not None:
            self.write(result, files())
        if self.json:
            _print(result_text(result), sys.stdout)
        elif not self.quiet:
            said = "\n\n".join([text(), *remarks(result)]) + "\n"
            _print(_STEERING.sub(lambda found: repr(found[0])[1:-1], said), sys.stdout)

    def write(self, result: Mapping[str, Any], files: Files) -> None:
        """Write the files, if --out is given; result.json says under `run` which command on which files made it."""
        if self.directory is not None:
            recorded = {**result, RUN: run_record(self.words)}
            replace_files(self.directory, recorded, self._completed(result, files), self.overwrite)

    def of_input(self, folder: str, words: tuple[str, ...]) -> "Output":
        """Where the results of one of many inputs go: a folder of their own, and the command for that input alone."""
        directory = None if self.directory is None else self.directory / folder
        return replace(self, directory=directory, words=words)

    def _completed(self, result: Mapping[str, Any], files: Files) -> dict[str, Content]:
        """The files; the page says how to repeat the run, and what the screen says beside the result."""
        from cdpr_struct.reports.html import completed

        bare = files["report.html"]
        if not isinstance(bare, str | bytes):
            raise TypeError("report.html must be whole, not in parts")
        page = completed(bare, shlex.join(self.words), warnings_of(result), extensions_of(result), rest_of(result))
        return {**files, "report.html": page, **self._tables(files)}

    def _tables(self, files: Files) -> Files:
        """The CSV tables once more, in the form of --tables."""
        if self.tables is None:
            return {}
        if self.tables == "parquet":
            from cdpr_struct.reports.parquet_table import parquet_tables

            return parquet_tables(files)
        from cdpr_struct.reports.paper_table import paper_tables

        return paper_tables(files, self.tables)


def repeating(typed: Sequence[str]) -> tuple[str, ...]:
    """Words of the command that repeats a run, from those typed after the program's name."""
    words = list(typed)
    kept = []
    while words:
        word = words.pop(0)
        if word in _WITH_VALUE and words:
            words.pop(0)
        elif word not in (*_FLAGS, *_WITH_VALUE) and word.partition("=")[0] not in _WITH_VALUE:
            kept.append(word)
    return ("cdpr-struct", *kept, "--out=DIR")


_STEERING = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")
"""Signs in names that would steer a terminal, or turn the direction of its text."""
_FLAGS, _WITH_VALUE = ("--json", "--quiet", "-q", "--overwrite"), ("--out", "--scheduler")


def _print(text: str, stream: Any) -> None:
    """Write to a stream whose reader may be gone; signs that its encoding lacks are escaped.

    Raises
    ------
    InputError : it takes nothing, as on a full disk.
    """
    encoding = getattr(stream, "encoding", None) or "utf-8"
    try:
        stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
        stream.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())  # what Python flushes at its end
        if not isinstance(error, BrokenPipeError):
            raise InputError("standard output", "", error.strerror, "a place that can be written") from error
