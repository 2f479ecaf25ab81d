#!/usr/bin/env python3
"""Whatever runs in parallel, on scenes of a moment: three threads give the bytes of one. Under the
thread sanitizer, which this is made for, a race ends a program with an error."""

from harness import CliTest, main

WAX = {"type": "translucent", "sigmaAPerMm": [0.01, 0.02, 0.05], "sigmaSPrimePerMm": 1.5,
       "roughness": 0.4}
SCENE = {
    "film": {"width": 20, "height": 20, "samples": 4},
    "materials": {"stone": {"type": "translucent", "medium": "Marble"}, "wax": WAX,
                  "grey": {"type": "lambertian", "reflectance": 0.5}},
    "objects": [
        {"name": "ball", "shape": "sphere", "radius": 4, "material": "stone",
         "transform": [{"translate": {"keys": [{"frame": 1, "value": [-3, 0, 0]},
                                               {"frame": 3, "value": [-4, 1, 0]}]}}]},
        {"name": "block", "shape": "box", "size": [4, 4, 4], "material": "wax",
         "transform": [{"translate": [4, 0, 0]}]},
        {"name": "floor", "shape": "rectangle", "width": 40, "height": 40, "material": "grey",
         "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}, {"translate": [0, -6, 0]}]},
    ],
}


class Threads(CliTest):
    def same(self, *options, output="{}.exr"):
        for threads in (3, 1):
            self.assert_ok(self.render(*options, "-o", output.format(threads),
                                       "--threads", threads))
        self.assertEqual(*((self.folder / output.format(threads)).read_bytes()
                           for threads in (3, 1)))

    def test_two_passes(self):
        scene = self.write_scene(**SCENE)
        for threads in (3, 1):
            self.assert_ok(self.preprocess(scene, "-o", f"{threads}.ssc", "--threads", threads))
        self.assertEqual(*((self.folder / f"{threads}.ssc").read_bytes() for threads in (3, 1)))
        self.same(scene, "--cache", "3.ssc", "--no-keep")

    def test_diffusion_on_the_shape(self):
        self.same(self.write_scene(**SCENE), "--model", "shape", "--size", "8x8")

    def test_frames_from_a_folder_of_stages(self):
        scene = self.write_scene(**SCENE)
        for threads in (3, 1):
            self.assert_ok(self.render(scene, "--frames", "1,3", "--cache", f"{threads}/", "-o",
                                       f"{threads}-####.exr", "--threads", threads))
        self.assertEqual(*((self.folder / f"{threads}-0003.exr").read_bytes()
                           for threads in (3, 1)))

    def test_integrators_without_a_cache(self):
        smooth = {**SCENE["materials"], "wax": {**WAX, "roughness": 0}}
        scene = self.write_scene(**{**SCENE, "materials": smooth})
        for integrator in ("bssrdf", "brdf", "volume"):
            with self.subTest(integrator):
                self.same(scene, "--integrator", integrator, "--size", "8x8",
                          output=integrator + "-{}.exr")


if __name__ == "__main__":
    main()
