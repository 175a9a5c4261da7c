#!/usr/bin/env python3
"""Holds the command's machine against a second one that was written from the rules of knitout alone.

    compare.py COMMAND CORPUS [--random N] [--seed N]

COMMAND is the built program. Three kinds of programmes go through both:

    cases       short ones, each for one rule, whose verdict is written beside them (cases.py)
    random      programmes that keep every rule, and the same with one line spoilt
    corpus      the real ones under CORPUS (the environment variable LOOPWRIGHT_CORPUS comes first)

Both must say the same of every programme: is it accepted, and if it is not, on which line is the first error.
For an accepted one they must agree on every loop (where it was made, every needle that it came onto, which
loops it was drawn through in stack order, how it ended), on the stacks at the end, the highest stack, and on
where each carrier was before and after each of its uses. Exit status 0 when they do, 1 when they differ, 77
when all but the corpus was compared and the corpus is not there.
"""

import argparse
import concurrent.futures
import csv
import functools
import gc
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import knitout_check
from cases import CASES
from random_programme import programme, spoilt

COMPARED = ("loops_at_end", "stack_heights", "most_stack", "loops_made", "loops", "uses")
SKIPPED = 77


def said_by_command(command, files, scratch):
    """The command's machine states of the files, in their order."""
    state = scratch / f"state_{os.getpid()}.json"
    state.unlink(missing_ok=True)
    ran = subprocess.run(
        [command, "check", *map(str, files), "--machine-state", str(state)],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=300, check=False,
    )  # fmt: skip
    if ran.returncode not in (0, 1) or not state.exists():
        raise RuntimeError(f"{command} check ended with {ran.returncode}: {ran.stderr[-500:]}")
    return json.loads(state.read_text(encoding="utf-8"))["files"]


def first_line(errors):
    """Line of the first error; 0 when all are about the file as a whole."""
    return min((line for line, _ in errors if line > 0), default=0)


def first_difference(ours, theirs):
    for place, (a, b) in enumerate(zip(ours, theirs)):
        if a != b:
            return f"[{place}]: command {a!r}, checker {b!r}"
    return f"lengths: command {len(ours)}, checker {len(theirs)}"


def differences(command, checker):
    """What the two say differently of one programme, as lines of text."""
    errors, accepted = checker["errors"], checker["accepted"]
    if command["accepted"] != accepted:
        who, said = ("checker", errors[0]) if errors else ("command", command["errors"][0])
        return [f"rejected by the {who} only, line {said[0]}: {said[1]}"]
    if not accepted:
        lines = first_line(command["errors"]), first_line(errors)
        if lines[0] != lines[1]:
            return [f"first error at line {lines[0]} by the command, {lines[1]} by the checker: {errors[0][1]}"]
        return []
    found = []
    for key in COMPARED:
        ours, theirs = command[key], checker[key]
        if ours == theirs:
            continue
        if isinstance(ours, list):
            found.append(f"{key}{first_difference(ours, theirs)}")
        elif isinstance(ours, dict):
            needle = next(n for n in {**ours, **theirs} if ours.get(n) != theirs.get(n))
            found.append(f"{key}[{needle}]: command {ours.get(needle)}, checker {theirs.get(needle)}")
        else:
            found.append(f"{key}: command {ours}, checker {theirs}")
    for carrier, theirs in checker["carriers"].items():
        theirs = {key: theirs[key] for key in ("last_used_at", "active")}
        if command["carriers"].get(carrier) != theirs:
            found.append(f"carrier {carrier}: command {command['carriers'].get(carrier)}, checker {theirs}")
    return found


def compared(command, files, scratch):
    """For each file the checker's report, without its longest lists, and what the command says differently."""
    gc.disable()  # nothing here is cyclic, and looking for cycles took half of the time
    results = []
    for path, said in zip(files, said_by_command(command, files, scratch), strict=True):
        report = knitout_check.check(path, history=True)
        found = differences(said, report)
        del report["loops"], report["uses"]
        results.append((report, found))
    return results


class Comparison:
    def __init__(self, command, scratch):
        self.command, self.scratch = command, scratch
        self.failed = False

    def fail(self, text):
        self.failed = True
        print(text)

    def compare(self, kind, files, names=None, at_once=map):
        """Runs files through both; the checker's reports in the order of the files."""
        batches = [files[start : start + 20] for start in range(0, len(files), 20)]
        run = functools.partial(compared, self.command, scratch=self.scratch)
        results = [result for batch in at_once(run, batches) for result in batch]
        differing = [(path, found) for path, (_, found) in zip(files, results) if found]
        self.failed = self.failed or bool(differing)
        for path, found in differing[:10]:
            self.fail(f"{kind} {names[path] if names else path}: {found[0]}")
        reports = [report for report, _ in results]
        accepted, loops = sum(r["accepted"] for r in reports), sum(r["loops_made"] for r in reports)
        print(f"{kind}: {len(files)} programmes, {accepted} accepted, {loops} loops, {len(differing)} differ")
        return reports

    def corpus(self, files, manifest):
        """The real programmes; none may be rejected that the converter to a Shima machine took."""
        taken = set()
        if manifest.is_file():
            for row in csv.DictReader(manifest.open(encoding="utf-8"), delimiter="\t"):
                if row["shima_converter"] == "ok":
                    taken.add(manifest.parent / row["file"])
        with concurrent.futures.ProcessPoolExecutor(2) as pool:
            reports = self.compare("corpus", files, at_once=pool.map)
        for path, report in zip(files, reports):
            if path in taken and not report["accepted"]:
                self.fail(f"corpus {path}: the converter took it: {report['errors'][0]}")

    def write(self, name, lines):
        path = self.scratch / f"{name}.k"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return path

    def cases(self):
        files = [self.write(f"case_{place}", text.strip("\n").split("\n")) for place, (_, _, text) in enumerate(CASES)]
        names = {path: what for path, (what, _, _) in zip(files, CASES)}
        for report, (what, expected, _) in zip(self.compare("case", files, names), CASES):
            if report["accepted"] != expected:
                self.fail(f"case {what}: the checker says {report['errors'] or 'accepted'}")

    def random(self, count, seed):
        draw = random.Random(seed)
        whole = [programme(draw, draw.randint(5, 80)) for _ in range(count)]
        broken = [spoilt(draw, lines) for lines in whole]
        good = self.compare("random", [self.write(f"random_{i}", lines) for i, lines in enumerate(whole)])
        for report in good:
            if not report["accepted"]:
                self.fail(f"{report['file']}: was to keep every rule: {report['errors'][0]}")
        self.compare("spoilt", [self.write(f"spoilt_{i}", lines) for i, lines in enumerate(broken)])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("command")
    parser.add_argument("corpus")
    parser.add_argument("--random", type=int, default=300, help="random programmes of each sort")
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--keep", help="folder for the programmes that are written, to look at them")
    asked = parser.parse_args()
    corpus = pathlib.Path(os.environ.get("LOOPWRIGHT_CORPUS", asked.corpus))
    real = sorted(p for p in corpus.glob("*/*") if p.suffix in (".k", ".knitout"))
    with tempfile.TemporaryDirectory() as folder:
        comparison = Comparison(asked.command, pathlib.Path(asked.keep or folder))
        comparison.cases()
        comparison.random(asked.random, asked.seed)
        if real:
            comparison.corpus(real, corpus / "MANIFEST.tsv")
        elif not comparison.failed:
            print(f"the corpus is not at {corpus}: real programmes were not compared")
            return SKIPPED
    return 1 if comparison.failed else 0


if __name__ == "__main__":
    sys.exit(main())
