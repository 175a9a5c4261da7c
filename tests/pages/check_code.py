#!/usr/bin/env python3
"""Checks the code that the manual shows, by language:

  cpp      compiled against the headers of this source, warnings being errors: every block stands for itself
  py       parsed: it is for another program's Python (blocks of `python` are run by tests/python)
  sh       parsed by bash; blocks that start with `loopwright` are run by run_doc_commands.py
  sbatch   parsed by bash, then run as Slurm would run them: see run_job_array.py
  cmake    docs/library.md's is built by tests/packages/use_installed.py
  knitout, verm   whole files (they start with their magic line) are read by `loopwright check`

Usage: check_code.py COMPILER BUILD COMMAND PAGE...
"""
import ast
import json
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from page_blocks import blocks  # noqa: E402
from run_job_array import job_array_fault  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
COMPILER, BUILD, COMMAND = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
SUFFIX = {"knitout": ".k", "verm": ".verm"}


def fault_of(*command, text=None):
    done = subprocess.run([str(word) for word in command], text=True, input=text, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    return done.stdout if done.returncode else None


def include_options():
    """Folders that a source of the last stage is compiled with, third-party headers among them."""
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        if entry["file"].endswith("outputs/hdf5_columns.cpp"):
            words = shlex.split(entry["command"])
            return [word for i, word in enumerate(words) if word.startswith("-I") or "-isystem" in (word, words[i - 1])]
    sys.exit("outputs/hdf5_columns.cpp is not among the sources of this build")


def cpp_fault(text):
    return fault_of(COMPILER, "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", *include_options(), "-x", "c++",
                    "-", text=text)


def python_fault(text):
    try:
        ast.parse(text)
    except SyntaxError as error:
        return str(error)
    return None


def shell_fault(text):
    return fault_of("bash", "-n", text=text)


def notation_fault(text, language):
    magic = {"knitout": ";!knitout-", "verm": ";!vermiculation-"}[language]
    if not text.startswith(magic):
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / ("block" + SUFFIX[language])
        file.write_text(text)
        return fault_of(COMMAND, "check", file)


def block_fault(language, text):
    if language == "cpp":
        return cpp_fault(text)
    if language == "py":
        return python_fault(text)
    if language == "sh":
        return shell_fault(text)
    if language == "sbatch":
        return shell_fault(text) or job_array_fault(text, COMMAND)
    if language in SUFFIX:
        return notation_fault(text, language)
    return None


def main():
    counts, failed = {}, 0
    for page in map(Path, sys.argv[4:]):
        for line, language, text in blocks(page):
            if page.name == "notation.md" and language in SUFFIX:
                continue  # tests/notation/examples_test.cpp reads every one and compares what it makes
            counts[language] = counts.get(language, 0) + 1
            if fault := block_fault(language, text):
                failed += 1
                print(f"{os.path.relpath(page, ROOT)}:{line}: {language} block\n{fault}")
    print(", ".join(f"{count} {language or 'without a language'}" for language, count in sorted(counts.items())),
          f": {failed} faults", sep="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
