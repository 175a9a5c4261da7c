#!/usr/bin/env python3
"""Checks that data flows one way: a stage includes only itself and stages to its left.

The order of the stages is read from cmake/stages.cmake, the only place where it is written. Checked are
  - src/<stage>: no header of a stage to the right, none of src/pipeline.hpp or apps/
  - src/*.hpp, src/*.cpp: any stage
  - apps/<app> and python: stages, src/pipeline.hpp and its neighbours, and their own files, not another app's
  - tests/<stage>: the stage and those to its left, as it links; bench and fuzz: any stage
Quoted includes must name an existing file, as "stage/file.hpp" or beside the including one.

Usage: check_layers.py [ROOT]   exit status 1 and one line per fault if there are any
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')
SUFFIXES = {".hpp", ".cpp", ".h", ".inl"}


def stage_order(root):
    text = (root / "cmake/stages.cmake").read_text()
    return re.search(r"set\(LOOPWRIGHT_STAGES ([^)]*)\)", text).group(1).split()


def quoted_includes(file):
    for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
        if match := INCLUDE.match(line):
            yield number, match.group(1)


def fault_of(root, stages, file, included):
    """Why `file` may not include `included`, or None."""
    where = file.relative_to(root).parts
    beside = file.parent / included
    target = (root / "src" / included) if not beside.exists() else beside
    own_tests = root / "tests" / included
    if not target.exists() and where[0] == "tests" and own_tests.exists():
        target = own_tests
    if not target.exists():
        return "no such file"
    to = target.resolve().relative_to(root).parts
    if to[0] == "src":
        to_stage = to[1] if to[1] in stages else None
        if where[0] == "src" and len(where) > 2:
            if to_stage is None:
                return f"stage {where[1]} may not look at the whole road"
            if stages.index(to_stage) > stages.index(where[1]):
                return f"{to_stage} is to the right of {where[1]}"
        if where[0] == "tests" and len(where) > 2 and where[1] in stages:
            if to_stage is None or stages.index(to_stage) > stages.index(where[1]):
                return f"tests of {where[1]} may not look further than {where[1]}"
        return None
    if to[0] != where[0] or (to[0] == "apps" and to[1] != where[1]):
        return f"{where[0]} may not include from {'/'.join(to[:2])}"
    return None


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    stages = stage_order(root)
    faults, files = [], 0
    for folder in ("src", "apps", "python", "tests", "bench", "fuzz"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in SUFFIXES:
                continue
            files += 1
            where = file.relative_to(root).parts
            if where[0] == "src" and len(where) > 2 and where[1] not in stages:
                faults.append(f"{'/'.join(where)}: src/{where[1]} is not a stage of cmake/stages.cmake")
                continue
            for number, included in quoted_includes(file):
                if reason := fault_of(root, stages, file, included):
                    faults.append(f"{'/'.join(where)}:{number}: includes {included}: {reason}")
    print("\n".join(faults) if faults else f"{files} files keep the order {' -> '.join(stages)} -> apps")
    return 1 if faults or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
