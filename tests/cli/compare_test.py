#!/usr/bin/env python3
"""--integrator, and --compare: how far pictures are from a reference."""

import json
import math
import re

from harness import BAD_INPUT, IO, SCENE, USAGE, CliTest, main
from images import read_png, write_even_exr

SMOOTH = {"stone": {"type": "translucent", "medium": "Marble"}}


def figures(text):
    """{name: (mean, error or None)} of what --compare printed."""
    rows = re.findall(r"^(relative RMSE|bias|maximum|FLIP) +(\S+)(?: +\+- (\S+))?$", text, re.MULTILINE)
    return {name: (float(mean), float(error) if error else None) for name, mean, error in rows}


class Integrators(CliTest):
    def test_every_integrator_renders(self):
        scene = self.write_scene(materials=SMOOTH)
        for name in ("cached", "bssrdf", "brdf", "lambertian", "volume"):
            result = self.assert_ok(self.render(scene, "-o", f"{name}.exr", "--integrator", name,
                                                "--samples", 64, "--stats", f"{name}.json"))
            self.assertEqual(result.out, "")
            stats = json.loads((self.folder / f"{name}.json").read_text())
            self.assertEqual(stats["values"]["integrator"], name)
            self.assertEqual("points" in stats["counts"], name == "cached")
            self.assertEqual(stats["counts"]["scatterings"] > 0, name == "volume")
        # All show the same ball: its light but for the models' errors (on this ball, of 26
        # free paths, the dipole is too dark by a fifth or so) and the noise.
        for name in ("cached", "bssrdf", "brdf", "lambertian"):
            out = self.assert_ok(self.render("--compare", f"{name}.exr", "volume.exr")).out
            self.assertLess(abs(figures(out)["bias"][0]), 0.4, out)
        # These two are one model.
        out = self.assert_ok(self.render("--compare", "bssrdf.exr", "cached.exr")).out
        self.assertLess(abs(figures(out)["bias"][0]), 0.02, out)

    def test_the_scene_names_it_and_the_option_overrules(self):
        quality = {**SCENE["quality"], "integrator": "brdf"}
        scene = self.write_scene(materials=SMOOTH, quality=quality)
        self.assert_ok(self.render(scene, "-o", "a.exr", "--stats", "a.json"))
        self.assert_ok(self.render(scene, "-o", "b.exr", "--stats", "b.json",
                                   "--integrator", "volume"))
        for name, integrator in (("a", "brdf"), ("b", "volume")):
            stats = json.loads((self.folder / f"{name}.json").read_text())
            self.assertEqual(stats["values"]["integrator"], integrator)

    def test_threads_do_not_matter(self):
        scene = self.write_scene(materials=SMOOTH)
        for name in ("volume", "bssrdf"):
            for threads in (1, 2):
                self.assert_ok(self.render(scene, "-o", f"{threads}.exr", "--integrator", name,
                                           "--threads", threads))
            self.assertEqual((self.folder / "1.exr").read_bytes(),
                             (self.folder / "2.exr").read_bytes())

    def test_meshes_that_cut_each_other_are_told(self):
        balls = [{"name": name, "shape": "sphere", "radius": 5, "material": "stone",
                  "group": "twins", "transform": [{"translate": [x, 0, 0]}]}
                 for name, x in (("left", -2), ("right", 2))]
        for objects, warnings in ((balls, 1), (balls[:1], 0)):
            scene = self.write_scene(materials=SMOOTH, objects=objects)
            result = self.assert_ok(self.render(scene, "-o", "a.exr", "--integrator", "volume"))
            told = [line for line in result.lines("WARN") if "cut each other" in line]
            self.assertEqual(len(told), warnings, str(result))

    def test_refusals(self):
        rough = self.write_scene()
        volume = ("-o", "a.exr", "--integrator", "volume")
        self.assert_ok(self.render(rough, *volume, "--samples", 1))
        unknown = self.write_scene("unknown.json", quality={"integrator": "volumes"})
        self.assert_refused(BAD_INPUT, r"unknown\.json:\d+:\d+: .*did you mean \"volume\"",
                            self.render, unknown, "-o", "a.exr")
        self.assert_refused(USAGE, "--integrator: .*did you mean \"cached\"", self.render, rough,
                            "-o", "a.exr", "--integrator", "cache")
        self.assert_ok(self.preprocess(rough, "-o", "a.ssc"))
        self.assert_refused(USAGE, "--cache: the integrator \"brdf\" uses none", self.render,
                            rough, "-o", "a.exr", "--integrator", "brdf", "--cache", "a.ssc")
        sun = [{"type": "directional", "direction": [0, -1, 0], "irradiance": 1}]
        lit = self.write_scene("sun.json", materials=SMOOTH, lights=sun)
        self.assert_refused(BAD_INPUT, "cannot find a point, spot or directional light",
                            self.render, lit, *volume)


class Compare(CliTest):
    def setUp(self):
        super().setUp()
        self.brdf = (self.write_scene(), "--integrator", "brdf")  # the quickest
        for name, seed, samples in (("a", 1, 2), ("b", 2, 2), ("c", 3, 2), ("truth", 9, 64)):
            self.assert_ok(self.render(*self.brdf, "-o", f"{name}.exr", "--seed", seed, "--samples",
                                       samples, "--no-png"))
        self.assert_ok(self.render(*self.brdf, "-o", "small.exr", "--size", "8x8", "--no-png"))

    def compare(self, *arguments):
        return self.assert_ok(self.render("--compare", *arguments))

    def test_a_picture_and_itself(self):
        result = self.compare("a.exr", "a.exr")
        self.assertEqual(result.err, "")
        self.assertIn(f"beauty: {24 * 16} pixels", result.out)
        self.assertEqual(figures(result.out), {
            "relative RMSE": (0, None), "bias": (0, None), "maximum": (0, None), "FLIP": (0, None)})

    def test_several_seeds(self):
        rows = [figures(self.compare(f"{name}.exr", "truth.exr").out) for name in "abc"]
        together = figures(self.compare("a.exr", "b.exr", "c.exr", "truth.exr").out)
        for name, (mean, error) in together.items():
            values = [row[name][0] for row in rows]
            expected = sum(values) / 3
            spread = math.sqrt(sum((v - expected) ** 2 for v in values) / 2 / 3)
            self.assertAlmostEqual(mean, expected, delta=1e-4 * max(map(abs, values)))
            self.assertAlmostEqual(error, spread, delta=0.06 * spread)
        self.assertGreater(together["relative RMSE"][0], abs(together["bias"][0]))
        self.assertGreater(together["maximum"][0], together["relative RMSE"][0])
        self.assertTrue(0 < together["FLIP"][0] < 1)

    def test_json_says_the_same(self):
        arguments = ("a.exr", "b.exr", "truth.exr", "--layer", "diffusion", "--mask", "A")
        text = self.compare(*arguments).out
        data = json.loads(self.compare(*arguments, "--json").out)
        self.assertEqual((data["layer"], data["pictures"]), ("diffusion", 2))
        self.assertIn(f"diffusion: {data['pixels']} pixels", text)
        self.assertLess(data["pixels"], 24 * 16)
        for key, name in (("relativeRmse", "relative RMSE"), ("bias", "bias"), ("flip", "FLIP")):
            self.assertAlmostEqual(data[key]["mean"], figures(text)[name][0], places=4)
        depth = json.loads(self.compare("a.exr", "truth.exr", "--layer", "Z", "--json").out)
        self.assertNotIn("flip", depth)  # no colours
        alone = json.loads(self.compare("a.exr", "truth.exr", "--json").out)
        self.assertIsNone(alone["bias"]["standardError"])

    def test_error_image(self):
        self.compare("a.exr", "truth.exr", "--mask", "A", "--error-image", "error.png")
        width, height, channels, values = read_png(self.folder / "error.png")
        self.assertEqual((width, height, channels), (24, 16, 3))
        colours = {bytes(values[i:i + 3]) for i in range(0, len(values), 3)}
        self.assertIn(bytes((96, 96, 96)), colours)  # beside the ball
        self.assertGreater(len(colours), 20)
        self.compare("a.exr", "a.exr", "--error-image", "none.png")
        self.assertEqual(set(read_png(self.folder / "none.png")[3]), {0, 4})

    def test_refusals(self):
        self.write("text.exr", "no picture")
        write_even_exr(self.folder / "opaque.exr", 24, 16)
        write_even_exr(self.folder / "grey.exr", 24, 16, ("Z",))
        for code, pattern, arguments in (
                (USAGE, "needs a picture and a reference", ("--compare", "a.exr")),
                (USAGE, "--layer: belongs to --compare", ("--layer", "Z")),
                (USAGE, "--mask: belongs to --compare", ("--mask", "A")),
                (USAGE, "--error-image: belongs to --compare", ("--error-image", "a.png")),
                (USAGE, r"does not end in \.png",
                 ("--compare", "a.exr", "b.exr", "--error-image", "a.jpg")),
                (USAGE, "do not go together", ("--compare", "a.exr", "b.exr", "--list-materials")),
                (BAD_INPUT, "24 x 16 pixels, the reference 8 x 8",
                 ("--compare", "a.exr", "small.exr")),
                (BAD_INPUT, "no layer called \"difusion\"; did you mean \"diffusion\"",
                 ("--compare", "a.exr", "b.exr", "--layer", "difusion")),
                (BAD_INPUT, "b.exr: has no layer called \"ball\"",
                 ("--compare", "a.exr", "b.exr", "--mask", "ball")),
                (BAD_INPUT, "opaque.exr: has no alpha to be the mask",
                 ("--compare", "a.exr", "opaque.exr", "--mask", "A")),
                (BAD_INPUT, "grey.exr: has no R, G, B", ("--compare", "a.exr", "grey.exr")),
                (BAD_INPUT, "text.exr", ("--compare", "a.exr", "text.exr")),
                (IO, "none.exr", ("--compare", "none.exr", "b.exr")),
                (IO, "nowhere", ("--compare", "a.exr", "b.exr",
                                 "--error-image", "nowhere/error.png"))):
            with self.subTest(arguments=arguments):
                self.assert_refused(code, pattern, self.render, *arguments)


if __name__ == "__main__":
    main()
