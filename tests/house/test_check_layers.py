#!/usr/bin/env python3
"""tools/check_layers.py must let the order of the stages pass and report what goes against it."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class CheckLayers(unittest.TestCase):
    def run_on(self, files):
        """Exit status and output of the check on a tree of {path: text}."""
        with tempfile.TemporaryDirectory() as folder:
            tree = Path(folder)
            files = {"cmake/stages.cmake": (ROOT / "cmake/stages.cmake").read_text(), **files}
            for path, text in files.items():
                (tree / path).parent.mkdir(parents=True, exist_ok=True)
                (tree / path).write_text(text)
            done = subprocess.run([sys.executable, ROOT / "tools/check_layers.py", folder],
                                  capture_output=True, text=True)
            return done.returncode, done.stdout

    def test_to_the_left_passes(self):
        status, out = self.run_on({"src/base/vec3.hpp": "", "src/geometry/fabric.hpp": '#include "base/vec3.hpp"\n',
                                   "src/pipeline.hpp": '#include "geometry/fabric.hpp"\n',
                                   "apps/loopwright/main.cpp": '#include "pipeline.hpp"\n'})
        self.assertEqual(status, 0, out)

    def test_to_the_right_is_reported_with_its_line(self):
        status, out = self.run_on({"src/geometry/fabric.hpp": "",
                                   "src/base/vec3.hpp": '#pragma once\n  #  include "geometry/fabric.hpp"\n'})
        self.assertEqual(status, 1)
        self.assertIn("src/base/vec3.hpp:2", out)
        self.assertIn("geometry is to the right of base", out)

    def test_stage_may_not_include_the_road_or_an_app(self):
        files = {"src/pipeline.hpp": "", "apps/loopwright/options.hpp": ""}
        self.assertEqual(self.run_on({**files, "src/outputs/a.cpp": '#include "pipeline.hpp"\n'})[0], 1)
        self.assertEqual(self.run_on({**files, "src/outputs/a.cpp": '#include "../apps/loopwright/options.hpp"\n'})[0],
                         1)

    def test_missing_file_and_unknown_stage(self):
        self.assertEqual(self.run_on({"src/base/a.hpp": '#include "base/b.hpp"\n'})[0], 1)
        self.assertEqual(self.run_on({"src/extras/a.hpp": ""})[0], 1)

    def test_tests_of_a_stage_see_what_it_links(self):
        status, out = self.run_on({"src/outputs/a.hpp": "", "tests/base/a.cpp": '#include "outputs/a.hpp"\n'})
        self.assertEqual(status, 1, out)

    def test_empty_tree_is_an_error(self):
        self.assertEqual(self.run_on({})[0], 1)


if __name__ == "__main__":
    unittest.main()
