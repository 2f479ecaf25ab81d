#!/usr/bin/env python3
"""What the programs write: pictures, caches, reports, help, and what a signal leaves behind."""

import json
import math
import re
import signal
import subprocess

from harness import BIN, SOURCE, CliTest, main
from images import read_exr_header, read_ply, read_png

RADIUS_MM = 5  # of the ball in the harness's scene


class Help(CliTest):
    def test_help_of_both(self):
        for run, name in ((self.preprocess, "sss-preprocess"), (self.render, "sss-render")):
            result = self.assert_ok(run("--help"))
            self.assertEqual(result.err, "")
            self.assertIn(f"usage: {name}", result.out.lower())
            for option in ("--threads", "--seed", "--quiet", "--stats", "--tolerance", "--strict"):
                self.assertIn(option, result.out)
            self.assertRegex(result.out.lower(), r"exit codes?")
            self.assertTrue(all(len(line) <= 100 for line in result.out.splitlines()), result.out)

    def test_examples_can_be_copied(self):
        """The example lines run as they stand, from the root of the sources."""
        seen = 0
        (self.folder / "scenes").symlink_to(SOURCE / "scenes")
        for program in ("sss-preprocess", "sss-render"):
            text = self.run_program(program, "--help").out
            options = set(re.findall(r"(?<!\S)--?[a-z][a-z-]*", text.lower()))
            for line in re.findall(r"^ +(sss-(?:preprocess|render) .+)$", text, re.MULTILINE):
                seen += 1
                words = line.split()
                self.assertTrue((BIN / words[0]).exists(), line)
                for word in words[1:]:
                    if word.startswith("-"):
                        self.assertIn(word.lower(), options, line)
                    elif word.startswith("scenes/"):
                        self.assertTrue((SOURCE / word).is_file(), line)
        self.assertGreaterEqual(seen, 4)

    def test_help_into_a_closed_pipe(self):
        command = f"{BIN}/sss-render --help | head -n 1 > /dev/null; exit ${{PIPESTATUS[0]}}"
        self.assertEqual(subprocess.run(["bash", "-c", command]).returncode, 0)


class Preprocess(CliTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write_scene()

    def test_cache_stats_and_ply_agree(self):
        result = self.assert_ok(self.preprocess(
            self.scene, "-o", "out.ssc", "--stats", "stats.json", "--export-ply", "points.ply"))
        self.assertEqual(result.out, "")
        self.assertEqual(self.files(), ["out.ssc", "points.ply", "scene.json", "stats.json"])
        stats = json.loads((self.folder / "stats.json").read_text())
        self.assertEqual(stats["program"], "sss-preprocess")
        self.assertGreater(stats["seconds"]["total"], 0)
        self.assertGreaterEqual(len(stats["seconds"]), 4)
        self.assertEqual(stats["seconds"].keys(), stats["cpuSeconds"].keys())
        self.assertGreater(stats["peakMemoryBytes"], 1 << 20)
        self.assertGreater(stats["counts"]["nodes"], 0)
        self.assertGreater(stats["counts"]["rays"], 0)
        self.assertEqual(stats["counts"]["nan"], 0)
        self.assertGreater(stats["values"]["spacingMm"], 0)
        self.assertEqual(len(stats["values"]["meanFreePathMm"]), 3)
        names, points = read_ply(self.folder / "points.ply")
        self.assertEqual(names, "x y z nx ny nz area irradiance_r irradiance_g irradiance_b".split())
        self.assertEqual(len(points), stats["counts"]["points"])
        self.check_points(points)

    def check_points(self, points):
        for x, y, z, nx, ny, nz, area, *irradiance in points:
            # The ball is tessellated, so that points lie a little inside.
            self.assertAlmostEqual(math.hypot(x, y, z), RADIUS_MM, delta=0.02 * RADIUS_MM)
            self.assertAlmostEqual(math.hypot(nx, ny, nz), 1, delta=1e-5)
            self.assertGreater(area, 0)
            self.assertTrue(all(math.isfinite(e) and e >= 0 for e in irradiance))
        self.assertAlmostEqual(sum(p[6] for p in points) / (4 * math.pi * RADIUS_MM ** 2), 1,
                               delta=0.01)
        # The lamp stands up, left and in front.
        lit = [p[7] for p in points if -p[0] + p[1] + p[2] / 2 > 1.2 * RADIUS_MM]
        dark = [p[7] for p in points if -p[0] + p[1] + p[2] / 2 < -1.2 * RADIUS_MM]
        self.assertGreater(sum(lit) / len(lit), 2 * sum(dark) / len(dark))

    def test_info(self):
        self.assert_ok(self.preprocess(self.scene, "-o", "out.ssc", "--stats", "stats.json"))
        stats = json.loads((self.folder / "stats.json").read_text())
        text = self.assert_ok(self.preprocess("--info", "out.ssc"))
        self.assertIn(str(stats["counts"]["points"]), text.out)
        info = json.loads(self.assert_ok(self.preprocess("--info", "out.ssc", "--json")).out)
        self.assertEqual(info["format"], 5)
        self.assertEqual(len(info["bodies"]), 1)
        self.assertEqual(info["bodies"][0]["points"], stats["counts"]["points"])
        self.assertEqual(info["bodies"][0]["nodes"], stats["counts"]["nodes"])
        self.assertGreater(info["bodies"][0]["spacingMm"], 0)

    def test_spacing_sets_the_number_of_points(self):
        counts = []
        for spacing in ("0.8", "0.4"):
            self.assert_ok(self.preprocess(self.scene, "-o", "out.ssc", "--spacing", spacing,
                                           "--stats", "stats.json"))
            stats = json.loads((self.folder / "stats.json").read_text())
            # The spacing of so many points, and about as many points as the spacing asks for: disks
            # are thrown until none fits, so that the number comes out, and is not set.
            area, points = stats["values"]["bodies"][0]["areaMm2"], stats["counts"]["points"]
            self.assertAlmostEqual(stats["values"]["spacingMm"], math.sqrt(area / points),
                                   delta=1e-9)
            self.assertAlmostEqual(points * float(spacing) ** 2 / area, 1, delta=0.02)
            counts.append(points)
        self.assertAlmostEqual(counts[1] / counts[0], 4, delta=0.6)

    def test_quiet_says_nothing(self):
        result = self.assert_ok(self.preprocess(self.scene, "-o", "out.ssc", "--quiet"))
        self.assertEqual(result.out + result.err, "")

    def test_the_log_is_plain_lines(self):
        result = self.assert_ok(self.preprocess(self.scene, "-o", "out.ssc"))
        for line in result.err.splitlines():
            self.assertRegex(line, r"^(INFO|WARN|PROGRESS) +[0-9.]+s \S+ +\S")
            self.assertTrue(line.isascii() and line.isprintable(), line)
        self.assertRegex(result.err, r"out\.ssc")


class Render(CliTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write_scene()

    def test_picture_preview_and_stats(self):
        result = self.assert_ok(self.render(self.scene, "-o", "out.exr", "--stats", "stats.json"))
        self.assertEqual(result.out, "")
        self.assertEqual(self.files(), ["out.exr", "out.png", "scene.json", "stats.json"])
        header = read_exr_header(self.folder / "out.exr")
        expected = set("RGBAZ") | {f"N.{c}" for c in "XYZ"} | {
            f"{layer}.{c}" for layer in ("diffusion", "single", "surface", "albedo") for c in "RGB"}
        self.assertEqual({"Z" if name == "Z.Z" else name for name in header["channels"]}, expected)
        for name in ("chromaticities", "sss/version", "sss/scene", "sss/seed", "sss/metersPerUnit"):
            self.assertIn(name, header)
        width, height, channels, pixels = read_png(self.folder / "out.png")
        self.assertEqual((width, height), (24, 16))
        middle = pixels[(8 * 24 + 12) * channels:][:3]
        self.assertTrue(all(0 < value < 255 for value in middle), middle)
        stats = json.loads((self.folder / "stats.json").read_text())
        self.assertEqual(stats["program"], "sss-render")
        self.assertGreater(stats["counts"]["rays"], 24 * 16 * 2 - 1)
        self.assertGreater(stats["counts"]["diffusionEvaluations"], 0)
        self.assertEqual(stats["counts"]["nan"], 0)
        self.assertGreater(stats["seconds"]["total"], 0)

    def test_size_and_samples_override_the_scene(self):
        self.assert_ok(self.render(self.scene, "-o", "out.exr", "--size", "10x6", "--samples", "1"))
        self.assertEqual(read_png(self.folder / "out.png")[:2], (10, 6))

    def test_exitance_is_kept_beside_the_cache(self):
        def frame(*options):
            self.assert_ok(self.render(self.scene, "--cache", "c.ssc", "-o", "out.exr", "--no-png",
                                       "--stats", "stats.json", *options))
            return (json.loads((self.folder / "stats.json").read_text())["counts"],
                    (self.folder / "out.exr").read_bytes())

        self.assert_ok(self.preprocess(self.scene, "-o", "c.ssc"))
        alone, expected = frame("--no-keep")
        self.assertNotIn("c.ssc.exitance", self.files())
        first, picture = frame()
        self.assertIn("c.ssc.exitance", self.files())
        self.assertEqual((first["exitanceGroupsReused"], picture), (0, expected))
        self.assertEqual(first["exitanceGroups"], alone["exitanceGroups"])
        again, picture = frame()
        self.assertEqual((again["exitanceGroupsReused"], picture),
                         (first["exitanceGroups"], expected))
        self.assertEqual((again["exitanceGroups"], again["sumReceivers"]), (0, 0))

    def test_no_png(self):
        self.assert_ok(self.render(self.scene, "-o", "out.exr", "--no-png", "--quiet"))
        self.assertEqual(self.files(), ["out.exr", "scene.json"])


class Signals(CliTest):
    def check(self, program, *arguments):
        before = self.files()
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(program=program, signal=number):
                result = self.interrupt(number, program, *arguments)
                self.assertEqual(result.code, 128 + number, str(result))
                self.assertRegex(result.err, "ERROR.*interrupted")
                self.assertEqual(self.files(), before)

    def test_preprocess(self):
        self.write("out.ssc", "old")
        self.check("sss-preprocess", self.write_scene(), "-o", "out.ssc", "--spacing", "0.02")
        self.assertEqual((self.folder / "out.ssc").read_text(), "old")

    def test_render(self):
        self.check("sss-render", self.write_scene(), "-o", "out.exr", "--size", "2000x2000",
                   "--samples", "1000")


if __name__ == "__main__":
    main()
