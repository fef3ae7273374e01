"""python -m tests.published: write docs/published_cases.md."""

from tests.published.page import PAGE, page

PAGE.write_text(page(), "utf-8")
print(f"wrote {PAGE}")
