#!/usr/bin/env python3
"""Runs pytest on the files named, with the built package first on Python's path.

Usage: run_pytest.py PACKAGES COMMAND FILE...   exit status 77 where the module was not built or pytest is missing
"""
import os
import sys
from pathlib import Path


def main():
    packages, command, files = sys.argv[1], sys.argv[2], sys.argv[3:]
    if not list(Path(packages).glob("loopwright/_loopwright*")):
        print("skipped: the Python module was not built (Debian packages pybind11-dev, python3-dev)")
        return 77
    try:
        import numpy  # noqa: F401
        import pytest
    except ImportError as missing:
        print(f"skipped: {missing} (Debian packages python3-pytest, python3-numpy)")
        return 77
    sys.path.insert(0, packages)
    os.environ["PYTHONPATH"] = packages  # for the processes that tests start
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    os.environ["LOOPWRIGHT_COMMAND"] = command
    os.environ.setdefault("MPLBACKEND", "Agg")
    return pytest.main(["-q", "-p", "no:cacheprovider", *files])


if __name__ == "__main__":
    sys.exit(main())
