#!/usr/bin/env python3
"""run.py --smoke: does the benchmark's plumbing hold? No time is asserted, only that every part
says what it should, and that the errors are those of methods that work.

    smoke_test.py BIN_DIR
"""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parent


def numbers(value):
    """All numbers in a JSON value."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, (int, float)):
        yield value


class SmokeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.place.name)
        done = subprocess.run(
            [sys.executable, BENCH / "run.py", "--smoke", "--fresh", "--out", cls.folder / "out",
             "--cache", cls.folder / "cache"],
            env=os.environ | {"SSS_BIN_DIR": sys.argv[1], "PYTHONDONTWRITEBYTECODE": "1"},
            capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        cls.said = done.stdout
        cls.result = json.loads((cls.folder / "out/bench.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def rows(self, name):
        with open(self.folder / "out" / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_every_number_is_one(self):
        found = list(numbers(self.result))
        self.assertGreater(len(found), 300)
        self.assertTrue(all(math.isfinite(number) for number in found))

    def test_whole_frame_has_cost_and_error(self):
        frame = self.result["frame"]
        self.assertEqual(set(frame["programs"]),
                         {"preprocess", "render", "moved", "lambertian", "all"})
        for run in frame["programs"].values():
            self.assertGreater(run["cpuMin"], 0)
            self.assertGreater(run["memory"], 1 << 20)
        self.assertGreater(frame["reference"]["points"], 1.9 * frame["counts"]["points"])
        accuracy = frame["accuracy"]
        # A coarse cloud at 64 x 64 pixels: wrong, but not nonsense; the reference is better.
        self.assertLess(accuracy["error"]["rmsOfMean"], 0.2)
        self.assertLess(accuracy["ofReference"]["rmsOfMean"], accuracy["error"]["rmsOfMean"])
        self.assertGreater(accuracy["lookupSeconds"], 0)
        self.assertEqual(len(self.rows("frame.csv")), 5)

    def test_scaling_keeps_the_tolerance(self):
        (row,) = self.rows("scaling.csv")
        self.assertEqual(int(row["cloudPoints"]), 10000)
        self.assertLess(float(row["p999"]), 0.01)

    def test_methods_agree_with_the_sum_over_all_points(self):
        (scene,) = self.result["scenes"]
        worst = {method["name"]: [entry["error"]["max"] for entry in method["curve"]]
                 for method in scene["methods"]}
        self.assertEqual(set(worst),
                         {"ours", "solid-angle", "solid-angle-table", "brute-force"})
        self.assertLess(worst["brute-force"][0], 1e-5)
        self.assertLess(worst["ours"][0], 0.3)
        self.assertLess(worst["ours"][1], 0.03)
        for name in ("solid-angle", "solid-angle-table"):
            self.assertLess(worst[name][1], 0.05)
            self.assertLess(worst[name][1], worst[name][0])
        # Same traversal, same kernel, written twice.
        self.assertAlmostEqual(worst["solid-angle"][1], worst["solid-angle-table"][1], delta=1e-5)
        self.assertEqual(len(self.rows("hierarchy.csv")), 7)
        self.assertIn("solid angle, exps", self.said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
