"""python -m tests.verification: write docs/verification.md."""

from tests.verification.page import PAGE, page

PAGE.write_text(page(), "utf-8")
print(f"wrote {PAGE}")
