#!/usr/bin/env python3
"""Runs the Python blocks of a Markdown page, so that what the documentation shows is what the module does.

A block is fenced as ```python. The blocks of a page run one after the other, as one programme, in a fresh folder that
holds a copy of examples/. Where a line's comment begins with `# ->`, the line's value, an expression, is compared: what
stands there is evaluated, and numbers need only agree in the digits that are written.

Usage: run_doc_python.py PACKAGES PAGE   exit status 77 where the module was not built or a package is missing
"""
import ast
import os
import re
import shutil
import sys
import tempfile
import traceback
from pathlib import Path

FENCE = re.compile(r"^```python\n(.*?)^```\s*$", re.MULTILINE | re.DOTALL)
ROOT = Path(__file__).resolve().parents[2]


def python_blocks(page):
    text = page.read_text()
    for match in FENCE.finditer(text):
        yield text.count("\n", 0, match.start()) + 2, match.group(1)


def agree(value, shown, text):
    """Whether a value is what the page shows of it."""
    if isinstance(shown, (tuple, list)):
        texts = [ast.unparse(element) for element in ast.parse(text, mode="eval").body.elts]
        return len(value) == len(shown) and all(map(agree, value, shown, texts))
    if isinstance(shown, float):
        digits = len(text.partition(".")[2])
        return abs(float(value) - shown) <= 0.5001 * 10 ** -digits
    return value == shown


def run_block(block, names, where):
    """Statement by statement; returns what is wrong, in lines."""
    faults = []
    lines = block.splitlines()
    for statement in ast.parse(block).body:
        shown = re.search(r"#\s*->\s*(.+)$", lines[statement.end_lineno - 1])
        if shown and isinstance(statement, ast.Expr):
            value = eval(compile(ast.Expression(statement.value), where, "eval"), names)
            wanted = shown.group(1).strip()
            if not agree(value, ast.literal_eval(wanted), wanted):
                faults.append(f"{where}: {ast.unparse(statement)} is {value!r}, not {wanted}")
        else:
            exec(compile(ast.Module([statement], []), where, "exec"), names)
    return faults


def main():
    packages, page = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    if not list(packages.glob("loopwright/_loopwright*")):
        print("skipped: the Python module was not built (Debian packages pybind11-dev, python3-dev)")
        return 77
    try:
        import matplotlib
        import numpy  # noqa: F401
    except ImportError as missing:
        print(f"skipped: {missing} (Debian packages python3-matplotlib, python3-numpy)")
        return 77
    matplotlib.use("Agg")
    sys.path.insert(0, str(packages))
    os.environ["PYTHONPATH"] = str(packages)
    failed, names = 0, {"__name__": "page"}
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "examples", Path(folder) / "examples")
        os.chdir(folder)
        for line, block in python_blocks(page):
            where = f"{page.name}:{line}"
            try:
                faults = run_block(block, names, where)
            except Exception:
                faults = [f"{where}: {traceback.format_exc()}"]
            print("\n".join(faults) if faults else f"{where}: ok")
            failed += len(faults)
        os.chdir("/")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
