#!/usr/bin/env python3
"""What sss-render leaves out because it brings nothing, or is known already: counted in --stats."""

import json

from harness import RESOURCES, SCENE, CliTest, main


class Skips(CliTest):
    def stats_of(self, *arguments, output="out.exr", log=""):
        """The whole --stats of a run that may warn of nothing but `log`."""
        result = self.assert_ok(self.render(*arguments, "-o", output, "--stats", "stats.json"))
        warnings = result.lines("WARN")
        self.assertEqual(len(warnings), 1 if log else 0, str(result))
        for line in warnings:
            self.assertRegex(line, log)
        return json.loads((self.folder / "stats.json").read_text())

    def counts_of(self, *arguments, **options):
        return self.stats_of(*arguments, **options)["counts"]

    def test_nothing_in_the_usual_scene(self):
        counts = self.counts_of(self.write_scene())
        for name in ("equalChannels", "diffuseLimitBodies", "passOneSkipped",
                     "singleScatteringSkipped"):
            self.assertEqual(counts[name], 0, name)

    def test_equal_channels(self):
        for sigma_s, equal in ((2, 2), ([2, 3, 2], 1), ([2, 3, 4], 0)):
            scene = self.write_scene(materials={"stone": {
                "type": "translucent", "sigmaAPerMm": 0.1, "sigmaSPerMm": sigma_s, "eta": 1.3}})
            self.assertEqual(self.counts_of(scene)["equalChannels"], equal, sigma_s)

    def test_no_pass_one_without_translucent_objects(self):
        scene = self.write_scene(materials={"stone": {"type": "lambertian", "reflectance": 0.5}})
        stats = self.stats_of(scene)
        self.assertEqual(stats["counts"]["passOneSkipped"], 1)
        for phase in ("points", "irradiance", "octree"):
            self.assertNotIn(phase, stats["seconds"])
        self.assertEqual(stats["counts"].get("points", 0), 0)
        self.assertEqual(stats["counts"]["exitanceSites"], 0)
        brdf = self.counts_of(scene, "--integrator", "brdf", output="brdf.exr")
        self.assertEqual(brdf["passOneSkipped"], 1)
        found = json.loads(self.assert_ok(self.render("--compare", "out.exr", "brdf.exr",
                                                      "--json")).out)
        self.assertEqual(found["maximum"]["mean"], 0)

    def test_dark_places(self):
        """The far side of a ball in sunlight, and nothing that reflects light there."""
        scene = self.write_scene(
            lights=[{"type": "directional", "direction": [0, -1, -0.3], "irradiance": 3}],
            quality={"tolerance": 0.02, "bounces": 0})
        counts = self.counts_of(scene)
        self.assertGreater(counts["skippedNodes"], 0)
        self.assertGreater(counts["skippedPoints"], 0)

    def test_parts_of_a_cache_that_a_close_up_does_not_need(self):
        """One end of a long bar: the other end is not read."""
        scene = self.write_scene(
            objects=[{"name": "bar", "shape": "box", "size": [60, 5, 5], "material": "stone"}],
            camera={"position": [29, 0, 26], "lookAt": [29, 0, 0], "fovDegrees": 2},
            film={"width": 8, "height": 8, "samples": 1, "filter": "box"},
            quality={"spacingMm": 0.3, "bounces": 0, "irradianceSamples": 2})
        self.assert_ok(self.preprocess(scene, "-o", "bar.ssc"))
        stats = self.stats_of(scene, "--cache", "bar.ssc", "--no-keep")
        needed = stats["values"]["frames"][0]["cacheBytesNeeded"]
        whole = (self.folder / "bar.ssc").stat().st_size
        self.assertGreater(needed, 65536 // 2)
        self.assertLess(needed, 0.6 * whole)

    def test_single_scattering_out_of_light(self):
        """Two balls; only one is in the cone of the lamp."""
        balls = [{**SCENE["objects"][0], "name": name, "transform": [{"translate": [x, 0, 0]}]}
                 for name, x in (("lit", 15), ("dark", -15))]
        lamp = {"type": "spot", "position": [15, 30, 0], "lookAt": [15, 0, 0],
                "intensity": 2000, "coneDegrees": 20, "penumbraDegrees": 2}
        camera = {"position": [0, 12, 90], "lookAt": [0, 0, 0], "fovDegrees": 28}
        scene = self.write_scene(objects=balls, lights=[lamp], camera=camera,
                                 quality={"tolerance": 0.1, "bounces": 0})
        counts = self.counts_of(scene)
        self.assertGreater(counts["singleScatteringSkipped"], 0)
        self.assertGreater(counts["singleScatteringSamples"], 0)

    def test_diffuse_limit(self):
        """The ball in metres: mean free paths far below a pixel. It needs no points, and looks as
        the integrator that knows the limit only."""
        scene = self.write_scene(metersPerUnit=1)
        counts = self.counts_of(scene, "--samples", 64, log="metersPerUnit")
        self.assertEqual((counts["diffuseLimitBodies"], counts["passOneSkipped"]), (1, 1))
        self.assertGreater(counts["diffusionEvaluations"], 0)
        self.assertEqual(counts["exitanceSites"], 0)
        self.stats_of(scene, "--samples", 64, "--integrator", "brdf", output="brdf.exr")
        found = json.loads(self.assert_ok(self.render(
            "--compare", "out.exr", "brdf.exr", "--mask", "A", "--json")).out)
        self.assertLess(abs(found["bias"]["mean"]), 0.02)
        self.assertLess(found["relativeRmse"]["mean"], 0.05)
        # Threads decide nothing.
        self.stats_of(scene, "--samples", 64, "--threads", 3, output="three.exr",
                      log="metersPerUnit")
        self.assertEqual((self.folder / "three.exr").read_bytes(),
                         (self.folder / "out.exr").read_bytes())
        # A cache is for every camera, also one that sees the points apart.
        self.assert_refused(RESOURCES, "would need .* points", self.preprocess, scene, "-o",
                            "out.ssc")


if __name__ == "__main__":
    main()
