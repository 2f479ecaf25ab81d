#!/usr/bin/env python3
"""run.py --smoke: does the benchmark's plumbing hold? No time is asserted, only that every part
says what it should, and that the errors are those of methods that work.

    smoke_test.py BIN_DIR
"""

import csv
import importlib.util
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import curves
import pictures

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
                         {"preprocess", "render", "moved", "movedShape", "lambertian", "all"})
        for run in frame["programs"].values():
            self.assertGreater(run["cpuMin"], 0)
            self.assertGreater(run["memory"], 1 << 20)
        self.assertGreater(frame["reference"]["points"], 1.9 * frame["counts"]["points"])
        accuracy = frame["accuracy"]
        # A coarse cloud at 64 x 64 pixels: wrong, but not nonsense; the reference is better.
        self.assertLess(accuracy["error"]["rmsOfMean"], 0.2)
        self.assertLess(accuracy["ofReference"]["rmsOfMean"], accuracy["error"]["rmsOfMean"])
        self.assertGreater(accuracy["lookupSeconds"], 0)
        self.assertEqual(len(self.rows("frame.csv")), 6)
        exitance = frame["exitance"]
        for place in ("seen", "everywhere"):
            costs = [exitance["profile"][place], exitance["corrected"][place]]
            for cost in (*costs, exitance["solution"]):
                self.assertGreater(cost["seconds"], 0)
            # The same sites but for where the correction smooths.
            self.assertAlmostEqual(costs[0]["interactions"] / costs[1]["interactions"], 1, delta=0.3)
        self.assertGreater(exitance["solution"]["interactions"],
                           exitance["profile"]["everywhere"]["interactions"])
        turntable = frame["turntable"]
        for seconds in turntable["cpuSeconds"].values():
            self.assertEqual(len(seconds), 2)
            self.assertGreater(min(seconds), 0)
        # Pass 1 is the first frame's.
        self.assertLess(turntable["later"]["marble"], turntable["cpuSeconds"]["marble"][0])

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

    def test_pictures_of_all_methods_tend_to_their_references(self):
        (scene,) = self.result["pictures"]
        curves = {method["name"]: method["curve"] for method in scene["methods"]}
        self.assertEqual(set(curves),
                         {"cached", "solid-angle", "brute-force", "bssrdf", "volume"})
        # Asked for 10 %; with the sum over the same points it has the error of the points alone.
        self.assertLess(curves["cached"][-1]["error"], 0.02)
        self.assertLess(curves["brute-force"][-1]["error"], 0.02)
        self.assertLess(curves["solid-angle"][-1]["error"], 0.05)
        # Four times as many samples, half of the noise; the more so, the better they spread.
        bssrdf = [entry["error"] for entry in curves["bssrdf"]]
        self.assertLess(bssrdf[1], 0.7 * bssrdf[0])
        for entry in curves["bssrdf"]:
            self.assertLess(abs(entry["bias"]), 0.2)
        noise = [entry["error"] for entry in curves["volume"]]
        self.assertLess(noise[-1], noise[0])
        for method in scene["methods"]:
            self.assertGreater(method["timeTo"]["0.01"]["seconds"], 0)
            self.assertEqual(method["timeTo"]["0.01"]["extrapolated"], method["noise"])
        self.assertEqual(len(self.rows("time-to-error.csv")), 10)
        self.assertIn("bssrdf, by samples", self.said)

    def test_models_stand_beside_radiative_transfer_within_its_noise(self):
        (scene,) = self.result["models"]
        models = {model["name"]: model for model in scene["models"]}
        self.assertEqual(set(models), {"dipole-alone", "dipole", "shape"})
        self.assertEqual(scene["truth"]["seeds"], 3)
        for model in models.values():
            self.assertGreater(model["seconds"], 0)
            self.assertGreater(model["meanStandardError"], 0)
            # -20 % for a half-space in pictures with less noise; the shape's points are as coarse as
            # they may be here.
            expected, delta = (0, 0.15) if model["name"] == "shape" else (-0.2, 0)
            self.assertAlmostEqual(model["mean"], expected,
                                   delta=delta + 5 * model["meanStandardError"])
        self.assertEqual(len(self.rows("models.csv")), 3)

    def test_report_is_one_file_with_its_pictures_and_tables(self):
        page = (self.folder / "out/report.html").read_text()
        links = re.findall(r'(?:src|href)="(?!data:image/png;base64,|#)([^"]*)"', page)
        self.assertEqual(links, [])
        # Of three methods: the picture, its reference, the error image.
        self.assertEqual(page.count("data:image/png;base64,"), 9)
        if importlib.util.find_spec("matplotlib"):
            # Every part has its charts: a page of tables alone would not say so.
            self.assertEqual(page.count("<svg"), 7)
        for section in ("pictures", "models", "frame", "scaling", "hierarchy", "machine"):
            self.assertIn(f'<section id="{section}">', page)
            self.assertIn(f'href="#{section}"', page)
        names = re.findall(r' id="([^"]+)"', page)
        self.assertEqual(len(names), len(set(names)))
        tables = (self.folder / "out/tables.md").read_text()
        self.assertIn("| slab, ketchup | cached, both passes |", tables)
        self.assertIn("| diffusion on the shape |", tables)


class CurvesTest(unittest.TestCase):
    def test_between_measured_points_on_a_log_log_plot(self):
        curve = [(0.1, 1.0), (0.001, 100.0)]
        self.assertAlmostEqual(curves.time_to(curve, 0.01), 10.0)
        self.assertAlmostEqual(curves.time_to(curve, 0.5), 1.0)
        self.assertIsNone(curves.time_to(curve, 0.0001))

    def test_noise_falls_with_the_square_root_beyond(self):
        curve = [(0.4, 1.0), (0.2, 4.0)]
        seconds, beyond = curves.time_with_noise(curve, 0.02)
        self.assertAlmostEqual(seconds, 400.0)
        self.assertTrue(beyond)
        self.assertEqual(curves.time_with_noise(curve, 0.4), (1.0, False))

    def test_what_nothing_beats(self):
        points = [{"seconds": s, "error": e} for s, e in ((2, 0.5), (1, 1), (3, 0.6), (4, 0.1))]
        self.assertEqual([point["seconds"] for point in pictures.unbeaten(points)], [1, 2, 4])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
