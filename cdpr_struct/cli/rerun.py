"""`cdpr-struct rerun`: run the command that a result records once more, and compare the numbers."""

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from cdpr_struct.cli.compared_results import Difference, compared, read_result
from cdpr_struct.cli.options import directory, number
from cdpr_struct.cli.output import Output
from cdpr_struct.cli.run_record import RUN, digests
from cdpr_struct.cli.written_files import RESULT
from cdpr_struct.errors import InputError
from cdpr_struct.reports.plain_json import SCHEMA, SCHEMA_VERSION

NAME = "rerun"
EXAMPLES = (
    "cdpr-struct rerun results/modes/result.json",
    "cdpr-struct rerun results/modes --out results/modes-again --tolerance 1e-6",
)
_SHOWN = 20  # differences on the screen


def run(
    result: Annotated[str, typer.Argument(metavar="RESULT", help="result.json of an earlier run, or its directory.")],
    out: Annotated[
        Path | None, typer.Option("--out", parser=directory, metavar="DIR", help="Keep the files of the new run here.")
    ] = None,
    tolerance: Annotated[
        float,
        typer.Option(
            "--tolerance", parser=number, metavar="SHARE",
            help="Two numbers are equal if they differ by at most this share of the largest number under their key.",
        ),
    ] = 1e-9,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace files in DIR that this program did not write.")
    ] = False,
    *,
    output: Output,
) -> int:  # fmt: skip
    """Run the command of an earlier result again; exit 0 if the numbers are the same, 1 if they differ."""
    if not 0.0 <= tolerance < 1.0:
        raise InputError("--tolerance", "", tolerance, "a share from 0 to 1, like 1e-9")
    was = Path(result).parent if Path(result).name == RESULT else Path(result)
    words, inputs, schema = _recorded(was)
    if out is not None and out.resolve() == was.resolve():
        raise InputError("--out", "", str(out), "another directory than that of the earlier result")
    changed = [*_changed(inputs, words), *schema]
    with tempfile.TemporaryDirectory() as scratch:
        now = Path(scratch) / "again" if out is None else out
        _run_again(words, now, overwrite)
        differences, count = compared(was, now, tolerance)
    told = {
        "command": list(words),
        "same": not differences,
        "compared": count,
        "tolerance": tolerance,
        "differences": [asdict(one) for one in differences],
        "warnings": changed,
    }
    output.deliver(told, lambda: _text(told, differences), dict)
    return 1 if differences else 0


def _recorded(was: Path) -> tuple[tuple[str, ...], Mapping[str, str], list[str]]:
    """The command of a result, the digests of the files it read, and a sentence if its keys mean something else."""
    whole = read_result(was)
    found = whole.get(RUN)
    record = found if isinstance(found, dict) else {}
    words = record.get("command")
    if not isinstance(words, list) or len(words) < 3 or not all(isinstance(word, str) for word in words):
        expected = "a result that records its command; those written with 0.16.0 or earlier do not"
        raise InputError(str(was / RESULT), RUN, "no command", expected)
    if words[1] == NAME:
        raise InputError(str(was / RESULT), RUN, NAME, "the result of another command")
    inputs = record.get("inputs")
    return tuple(words), inputs if isinstance(inputs, dict) else {}, _other_schema(whole.get(SCHEMA, 1))


def _other_schema(earlier: Any) -> list[str]:
    """A sentence if a result has another schema than this program writes."""
    if earlier == SCHEMA_VERSION:
        return []
    return [f"The earlier result has {SCHEMA} {earlier}, this one {SCHEMA_VERSION}: keys may differ in meaning."]


def _changed(inputs: Mapping[str, str], words: Sequence[str]) -> list[str]:
    """Sentences on input files that are not as they were.

    Raises
    ------
    InputError : a file is not there: the numbers cannot be computed.
    """
    now = digests(words)
    for path in inputs:
        if path not in now and not Path(path).is_file():
            expected = "this input of the earlier run is not here; type the command where that run was typed"
            raise InputError("RESULT", "", path, expected)
    altered = [f"The input {path} changed since the earlier run." for path in inputs if now.get(path) != inputs[path]]
    return altered + [f"The input {path} is new since the earlier run." for path in now if path not in inputs]


def _run_again(words: Sequence[str], now: Path, overwrite: bool) -> None:
    """Run a command with its files into another directory.

    Raises
    ------
    InputError : the command does not run any more (its own complaint is on stderr).
    """
    from cdpr_struct.cli.main import run as program

    kept = [word for word in words[1:] if word != "--out=DIR"]
    code = program([*kept, f"--out={now}", "--quiet", *(["--overwrite"] if overwrite else [])])
    if not (now / RESULT).exists() or code not in (0, 1):
        raise InputError(
            "RESULT", "", " ".join(words), f"the recorded command must run; it ended with exit code {code}"
        )


def _text(told: Mapping[str, Any], differences: Sequence[Difference]) -> str:
    lines = [f"command: {' '.join(told['command'])}"]
    if not differences:
        return "\n".join([*lines, f"SAME: {told['compared']} values, within {told['tolerance']:g} of the largest."])
    lines.append(f"DIFFERS under {len(differences)} keys of {told['compared']} values compared:")
    for one in differences[:_SHOWN]:
        by = "" if one.relative != one.relative else f", by {one.relative:.3g} of the largest"
        lines.append(f"  {one.file}: {one.key}: was {one.was}, is {one.now}{by} ({one.count} values)")
    if len(differences) > _SHOWN:
        lines.append(f"  and {len(differences) - _SHOWN} keys more")
    return "\n".join(lines)
