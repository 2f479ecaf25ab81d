#!/usr/bin/env python3
"""The same scene gives the same bytes: run again, with other numbers of threads, with the cache or
without; and the same picture in whatever units it is written."""

from harness import SOURCE, CliTest, main
from images import read_png


class Same(CliTest):
    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def test_threads_and_repetition(self):
        scene = self.write_scene()
        for name, threads in (("one", 1), ("two", 2), ("again", 2), ("three", 3)):
            self.assert_ok(self.preprocess(scene, "-o", f"{name}.ssc", "--threads", threads))
            self.assert_ok(self.render(scene, "--cache", "one.ssc", "-o", f"{name}.exr",
                                       "--threads", threads))
        for name in ("two", "again", "three"):
            for kind in ("ssc", "exr", "png"):
                self.assertEqual(self.bytes_of(f"{name}.{kind}"), self.bytes_of(f"one.{kind}"),
                                 f"{name}.{kind} differs from that of one thread")

    def test_volumes(self):
        """Fog and a flame: in both passes."""
        scene = self.write_scene(volumes=[
            {"shape": "box", "size": [30, 30, 30], "sigmaSPerMm": 0.01, "sigmaAPerMm": 0.002},
            {"shape": "sphere", "radius": 2, "sigmaAPerMm": [0.1, 0.2, 0.3], "emission": 50,
             "transform": [{"translate": [0, 9, 2]}]}])
        for threads in (1, 2, 3):
            self.assert_ok(self.render(scene, "-o", f"{threads}.exr", "--threads", threads))
        for threads in (2, 3):
            self.assertEqual(self.bytes_of(f"{threads}.exr"), self.bytes_of("1.exr"))
        self.assert_ok(self.render(self.write_scene("clear.json"), "-o", "clear.exr"))
        self.assertNotEqual(self.bytes_of("clear.exr"), self.bytes_of("1.exr"))

    def test_cache_in_memory_or_in_a_file(self):
        scene = self.write_scene()
        self.assert_ok(self.preprocess(scene, "-o", "out.ssc"))
        self.assert_ok(self.render(scene, "--cache", "out.ssc", "-o", "file.exr"))
        self.assert_ok(self.render(scene, "-o", "memory.exr"))
        self.assertEqual(self.bytes_of("file.png"), self.bytes_of("memory.png"))

    def test_the_seed_matters(self):
        scene = self.write_scene()
        for seed in (1, 2):
            self.assert_ok(self.preprocess(scene, "-o", f"{seed}.ssc", "--seed", seed))
            self.assert_ok(self.render(scene, "-o", f"{seed}.exr", "--seed", seed))
        self.assertNotEqual(self.bytes_of("1.ssc"), self.bytes_of("2.ssc"))
        self.assertNotEqual(self.bytes_of("1.exr"), self.bytes_of("2.exr"))

    def test_camera_does_not_matter_to_the_cache(self):
        self.assert_ok(self.preprocess(self.write_scene(), "-o", "a.ssc"))
        self.assert_ok(self.preprocess(
            self.write_scene(camera={"position": [9, 9, 9], "fovDegrees": 50},
                             film={"width": 3, "height": 3}), "-o", "b.ssc"))
        self.assertEqual(self.bytes_of("a.ssc"), self.bytes_of("b.ssc"))

    def test_units(self):
        pictures = {}
        for unit in ("mm", "cm", "m"):
            self.assert_ok(self.render(SOURCE / f"scenes/units/{unit}.json", "-o", f"{unit}.exr"))
            pictures[unit] = read_png(self.folder / f"{unit}.png")
        self.assertGreater(max(pictures["mm"][3]), 50)
        for unit in ("cm", "m"):
            self.assertEqual(pictures[unit][:3], pictures["mm"][:3])
            worst = max(abs(a - b) for a, b in zip(pictures[unit][3], pictures["mm"][3]))
            self.assertLessEqual(worst, 1, f"{unit} and mm: one level of 255 is rounding")


if __name__ == "__main__":
    main()
