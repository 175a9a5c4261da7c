#!/usr/bin/env python3
"""Runs the command blocks of a Markdown page, so that what the documentation shows is what the command does.

A command block is a fenced block whose first line starts with `loopwright`. The blocks of a page run one after the
other, by bash with -euo pipefail, in one fresh folder that holds a copy of examples/. A block must succeed, unless a
line `# exit status N` says what it ends with.

Usage: run_doc_commands.py COMMAND PAGE   exit status 77 if the page has no command block
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

FENCE = re.compile(r"^```[^\n]*\n(.*?)^```\s*$", re.MULTILINE | re.DOTALL)
ROOT = Path(__file__).resolve().parents[2]


def command_blocks(page):
    text = page.read_text()
    for match in FENCE.finditer(text):
        if match.group(1).lstrip().startswith("loopwright"):
            yield text.count("\n", 0, match.start()) + 1, match.group(1)


def main():
    command, page = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    blocks = list(command_blocks(page))
    if not blocks:
        print(f"{page.name} has no command block")
        return 77
    environment = dict(os.environ, PATH=f"{command.parent}:{os.environ['PATH']}")
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "examples", Path(folder) / "examples")
        for line, block in blocks:
            wanted = re.search(r"^# exit status (\d+)", block, re.MULTILINE)
            wanted = int(wanted.group(1)) if wanted else 0
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=folder, env=environment,
                                  stdin=subprocess.DEVNULL, text=True, errors="replace",
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            verdict = "ok" if done.returncode == wanted else f"FAILED: exit status {done.returncode}, not {wanted}"
            print(f"{page.name}:{line}: {verdict}\n{block}{done.stdout}")
            failed += done.returncode != wanted
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
