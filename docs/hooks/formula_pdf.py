"""mkdocs hook: the formula sheet as a PDF where pdflatex and its packages are installed; else the build says so."""

import logging
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

SHEET = Path(__file__).resolve().parents[2] / "derivations" / "latex" / "formula_sheet.tex"
PLACE = "formulas/formula_sheet.pdf"
_WORDS = "All on paper: [PDF](../building_the_docs.md)."
_log = logging.getLogger("mkdocs.hooks.formula_pdf")


def compiled() -> bytes | None:
    """The sheet as a PDF; None without pdflatex, or where it lacks packages."""
    program = shutil.which("pdflatex")
    if program is None:
        _log.info("no pdflatex: the site has no PDF of the formula sheet (docs/building_the_docs.md)")
        return None
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "-interaction=batchmode", "-halt-on-error", f"-output-directory={folder}", str(SHEET)]
        done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
        if done.returncode:
            _log.info("pdflatex lacks packages for the formula sheet: the site has no PDF of it")
            return None
        return (Path(folder) / SHEET.with_suffix(".pdf").name).read_bytes()


def on_files(files: Any, config: Any) -> Any:
    """Add the PDF to the site."""
    made = compiled()
    if made is not None:
        files.append(File.generated(config, PLACE, content=made))
    return files


def on_page_markdown(markdown: str, page: Any, files: Any, **_: Any) -> str:
    """Formula pages link to the PDF where there is one."""
    if page.file.src_uri.startswith("formulas/") and files.get_file_from_path(PLACE) is not None:
        return markdown.replace(_WORDS, f"All on paper: [PDF]({PLACE.split('/')[1]}).")
    return markdown
