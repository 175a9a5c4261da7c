"""Fenced blocks of a Markdown page: the documentation is what the tests run."""
import re
from pathlib import Path

FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```[ \t]*$", re.MULTILINE | re.DOTALL)


def blocks(page, language=None):
    """(line, language, text) of a page's blocks, of one language if it is given. The line is that of the fence."""
    text = Path(page).read_text()
    for match in FENCE.finditer(text):
        if language is None or match.group(1).strip() == language:
            yield text.count("\n", 0, match.start()) + 1, match.group(1).strip(), match.group(2)
