#!/usr/bin/env python3
"""Writes the two files of the project that docs/library.md shows, word for word, into a new folder.

Usage: page_project.py PAGE FOLDER
"""
import sys
from pathlib import Path

sys.path += [str(Path(__file__).parent), str(Path(__file__).parents[1] / "pages")]
from page_blocks import blocks  # noqa: E402


def write_project(page, folder, change=("", "")):
    """One piece of the recipe may be replaced by another."""
    [(_, _, recipe)], [(_, _, program)] = blocks(page, "cmake"), blocks(page, "cpp")
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(recipe.replace(*change) if change[0] else recipe)
    (folder / "cell.cpp").write_text(program)
    return folder


if __name__ == "__main__":
    write_project(Path(sys.argv[1]), Path(sys.argv[2]))
