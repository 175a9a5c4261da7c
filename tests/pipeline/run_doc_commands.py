#!/usr/bin/env python3
"""Runs the command blocks of a Markdown page, so that what the documentation shows is what the command does.

A command block is a fenced block whose first line starts with `loopwright`, or a block of `sh` with a line that does. The
blocks of a page run one after the other, by bash with -euo pipefail, in one fresh folder that holds a copy of examples/. A
block must succeed, unless a line `# exit status N` says what it ends with. Pictures that the blocks leave under the name
of one in docs/pictures must look like it.

Usage: run_doc_commands.py COMMAND PAGE [--keep-pictures]
       --keep-pictures: copies such pictures to docs/pictures instead (those that the page shows)
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/pages"))
from compare_pictures import picture_fault  # noqa: E402
from page_blocks import blocks  # noqa: E402

PICTURES = ROOT / "docs/pictures"


def command_blocks(page):
    for line, language, text in blocks(page):
        if text.lstrip().startswith("loopwright") or (language == "sh" and re.search("^loopwright ", text, re.MULTILINE)):
            yield line, text


def run_block(page, line, block, folder, environment):
    """Whether the block ends as it should; tells of it."""
    wanted = re.search(r"^# exit status (\d+)", block, re.MULTILINE)
    wanted = int(wanted.group(1)) if wanted else 0
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=folder, env=environment,
                          stdin=subprocess.DEVNULL, text=True, errors="replace",
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    verdict = "ok" if done.returncode == wanted else f"FAILED: exit status {done.returncode}, not {wanted}"
    print(f"{page.name}:{line}: {verdict}\n{block}{done.stdout}")
    return done.returncode == wanted


def picture_faults(page, folder, keep):
    """Pictures that the page shows and its commands make."""
    for name in sorted(set(re.findall(r"\]\((?:\.\./)*(?:docs/)?pictures/([\w.-]+)\)", page.read_text()))):
        made = folder / name
        if not made.exists():
            continue
        if keep:
            shutil.copy(made, PICTURES / name)
        elif not (PICTURES / name).exists():
            yield f"{name} is not in docs/pictures: --keep-pictures puts it there"
        elif fault := picture_fault(made, PICTURES / name):
            yield f"{name}: {fault}"


def main():
    command, page = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    found = list(command_blocks(page))
    if not found:
        sys.exit(f"{page.name} has no command block")
    environment = dict(os.environ, PATH=f"{command.parent}:{os.environ['PATH']}")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        shutil.copytree(ROOT / "examples", folder / "examples")
        failed = [line for line, block in found if not run_block(page, line, block, folder, environment)]
        pictures = list(picture_faults(page, folder, "--keep-pictures" in sys.argv))
    for fault in pictures:
        print(f"{page.name}: {fault}")
    return 1 if failed or pictures else 0


if __name__ == "__main__":
    sys.exit(main())
