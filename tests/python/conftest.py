"""What the tests of the Python module share."""
import json
import os
import subprocess
from pathlib import Path

import pytest

import loopwright

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"


@pytest.fixture(scope="session")
def examples():
    return EXAMPLES


@pytest.fixture(scope="session")
def rib():
    """A relaxed cell of 1x1 rib."""
    return loopwright.relax(EXAMPLES / "structures/rib.verm", periodic=True)


@pytest.fixture
def command(tmp_path):
    """The built command, run in the test's own folder: text of its standard output and of its errors."""

    def run(*arguments, status=0):
        done = subprocess.run([os.environ["LOOPWRIGHT_COMMAND"], *map(str, arguments)], cwd=tmp_path, text=True,
                              stdin=subprocess.DEVNULL, capture_output=True)
        assert done.returncode == status, done.stderr
        return done.stdout, done.stderr

    run.json = lambda *arguments, **named: json.loads(run(*arguments, "--json", "-", **named)[0])
    return run
