#!/usr/bin/env python3
"""Installs a build, moves the installation elsewhere and lets a program of another project use it.

The project is the one that docs/library.md shows, word for word; what its program prints must be what the command
prints. A component that is not there and a version that is too new must be refused.

Usage: use_installed.py BUILD COMPILER
"""
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from page_project import write_project  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/library.md"
RIB = ROOT / "examples/structures/rib.verm"
OF_THE_RUN = {"wall_s", "peak_memory_mb"}  # not of the cloth


def run(*command, fails=False):
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if (done.returncode != 0) != fails:
        sys.exit(f"exit status {done.returncode} of {' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


def cloth(text):
    return {key: value for key, value in json.loads(text).items() if key not in OF_THE_RUN}


def configure(folder, prefix, compiler, **options):
    run("cmake", "-G", "Ninja", "-S", folder, "-B", folder / "build", "-DCMAKE_BUILD_TYPE=Release",
        f"-DCMAKE_CXX_COMPILER={compiler}", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror",
        **options)


def main():
    build, compiler = Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        for component in ("library", "development", "command"):
            run("cmake", "--install", build, "--prefix", scratch / "first", "--component", component)
        prefix = scratch / "elsewhere"
        shutil.move(scratch / "first", prefix)

        own = write_project(PAGE, scratch / "cell")
        configure(own, prefix, compiler)
        run("cmake", "--build", own / "build")
        printed = cloth(run(own / "build/cell", RIB))
        command = run(prefix / "bin/loopwright", "relax", RIB, "--periodic", "-o", scratch / "rib.h5", "--json",
                      scratch / "rib.json")
        wanted = cloth((scratch / "rib.json").read_text())
        if printed != wanted:
            sys.exit(f"the program prints\n{printed}\nthe command\n{wanted}\n{command}")
        if printed["interlacings_intact"] != printed["interlacings"] or not printed["converged"]:
            sys.exit(f"not cloth at rest: {printed}")

        strange = write_project(PAGE, scratch / "strange", ("REQUIRED", "REQUIRED COMPONENTS mechanics knitting_needles"))
        configure(strange, prefix, compiler, fails=True)
        newer = write_project(PAGE, scratch / "newer", ("Loopwright 0.1", "Loopwright 7.2"))
        configure(newer, prefix, compiler, fails=True)
    print("installed, moved, used: the program of docs/library.md prints what the command prints")


if __name__ == "__main__":
    main()
