"""A figure as small SVG text, for pages that hold many."""

import re

from cdpr_struct.reports.figures.style import FONT_STACK


def compact(text: str) -> str:
    """The same picture to a tenth of a point, its font named once, without names that nothing refers to."""
    text = re.sub(r"<!--.*?-->\n?", "", text, flags=re.DOTALL)
    text = text.replace(f"font-family: {FONT_STACK}; ", "")
    text = text.replace('<style type="text/css">', f'<style type="text/css">text{{font-family: {FONT_STACK}}} ', 1)
    used = set(re.findall(r"#([\w.-]+)", text))
    text = re.sub(r' id="([\w.-]+)"', lambda m: m[0] if m[1] in used else "", text)
    text = re.sub(r"<[^>]*>", lambda tag: re.sub(r"(\d+\.\d)\d+", r"\1", tag[0]), text)
    text = text.replace(' transform="rotate(-0', ' transform="rotate(0')
    return re.sub(r"\n\s*", "\n", re.sub(r'\s+(?=[ML] |")', " ", text)).strip() + "\n"
