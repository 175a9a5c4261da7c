#!/usr/bin/env python3
"""Menu entry and kinds of files, read by the tools that a desktop uses; every example must get its kind.

Usage: check_desktop_files.py     exit status 77 where neither tool is installed
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DESKTOP = ROOT / "data/desktop"
NAMES = "{http://www.freedesktop.org/standards/shared-mime-info}"


def kinds():
    """Of each type that is declared: suffixes and first words."""
    tree = ElementTree.parse(DESKTOP / "loopwright-mime.xml")
    return {kind.get("type"): ([glob.get("pattern") for glob in kind.iter(NAMES + "glob")],
                               [match.get("value") for match in kind.iter(NAMES + "match")])
            for kind in tree.iter(NAMES + "mime-type")}


def example_faults():
    declared = kinds()
    for file in sorted([*ROOT.glob("examples/**/*.verm"), *ROOT.glob("examples/**/*.k")]):
        fitting = [kind for kind, (globs, magics) in declared.items()
                   if any(file.match(glob) for glob in globs) and any(file.read_text().startswith(magic) for magic in magics)]
        if len(fitting) != 1:
            yield f"{file.relative_to(ROOT)} is of {len(fitting)} kinds"


def menu_faults():
    entry = (DESKTOP / "loopwright-view.desktop").read_text()
    if set(re.search("^MimeType=(.*)$", entry, re.MULTILINE).group(1).strip(";").split(";")) != set(kinds()):
        yield "the menu entry does not take the kinds that are declared"
    if not (DESKTOP / (re.search("^Icon=(.*)$", entry, re.MULTILINE).group(1) + ".svg")).exists():
        yield "no icon of the name in the menu entry"
    ElementTree.parse(DESKTOP / "loopwright.svg")
    if shutil.which("desktop-file-validate"):
        done = subprocess.run(["desktop-file-validate", DESKTOP / "loopwright-view.desktop"], text=True, capture_output=True)
        if done.returncode or done.stdout:
            yield done.stdout + done.stderr


def database_faults():
    with tempfile.TemporaryDirectory() as folder:
        database = Path(folder) / "mime"
        (database / "packages").mkdir(parents=True)
        shutil.copy(DESKTOP / "loopwright-mime.xml", database / "packages")
        done = subprocess.run(["update-mime-database", database], text=True, capture_output=True,
                              env=dict(os.environ, XDG_DATA_HOME=folder))
        if done.returncode or done.stderr:
            yield f"update-mime-database: {done.stderr}"
        globs = (database / "globs2").read_text() if (database / "globs2").exists() else ""
        for kind, (patterns, _) in kinds().items():
            for pattern in patterns:
                if not re.search(rf"^\d+:{re.escape(kind)}:{re.escape(pattern)}$", globs, re.MULTILINE):
                    yield f"the database does not know {pattern} as {kind}"


def main():
    tools = [tool for tool in ("desktop-file-validate", "update-mime-database") if shutil.which(tool)]
    if not tools:
        print("Neither desktop-file-utils nor shared-mime-info is installed.")
        return 77
    faults = [*example_faults(), *menu_faults(), *(database_faults() if "update-mime-database" in tools else [])]
    print(*faults, sep="\n", end="\n" if faults else "")
    print(f"{len(kinds())} kinds of files, read by {' and '.join(tools)}: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
