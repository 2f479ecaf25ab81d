#!/usr/bin/env python3
"""Animations with a cache of stages: every frame is the same bytes alone, in a range, resumed and in
parallel; nothing that holds is made twice; nothing that is stale or damaged is used."""

import itertools
import json
import math
import shutil
import subprocess

from harness import BAD_INPUT, BIN, OK, USAGE, CliTest, main
from images import read_exr, read_ply


def keys(*pairs, **more):
    return {"keys": [{"frame": f, "value": v} for f, v in pairs], **more}


LAMP = {"type": "rectangle", "centre": [-20, 20, 10], "width": 10, "height": 10, "radiance": 10}
SKY = {"type": "environment", "radiance": 0.2}
MARBLE = {"type": "translucent", "medium": "Marble"}


def bar(bend, segments=6):
    """A closed box of triangles, 10 x 4 x 4 mm, bent: as an OBJ."""
    rings, text = [], ""
    for i in range(segments + 1):
        x = 10 * i / segments - 5
        lift = bend * math.sin(math.pi * i / segments)
        for y, z in ((-2, -2), (2, -2), (2, 2), (-2, 2)):
            text += f"v {x} {y + lift} {z}\n"
        rings.append([4 * i + k + 1 for k in range(4)])
    for a, b in zip(rings, rings[1:]):
        for k in range(4):
            m = (k + 1) % 4
            text += f"f {a[k]} {b[k]} {b[m]}\nf {a[k]} {b[m]} {a[m]}\n"
    first, last = rings[0], rings[-1]
    text += f"f {first[0]} {first[1]} {first[2]}\nf {first[0]} {first[2]} {first[3]}\n"
    return text + f"f {last[0]} {last[2]} {last[1]}\nf {last[0]} {last[3]} {last[2]}\n"


def lift_of_bar(bend, x, segments=6):
    """How far bar() is bent at x: straight from ring to ring."""
    at = (x + 5) / 10 * segments
    i = min(max(int(at), 0), segments - 1)
    a, b = (bend * math.sin(math.pi * k / segments) for k in (i, i + 1))
    return a + (b - a) * (at - i)


class Animation(CliTest):
    def write_scene(self, name="scene.json", **changes):
        """The harness's scene with a box in place of its ball of many triangles."""
        box = {"name": "ball", "shape": "box", "size": [7, 8, 6], "material": "stone"}
        return super().write_scene(name, **{"objects": [box], **changes})

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def rows(self, name="stats.json"):
        """{frame: {(body, stage): reused}} of a --stats file."""
        stats = json.loads((self.folder / name).read_text())
        return {frame["frame"]: {(row["body"], row["stage"]): row["reused"]
                                 for row in frame.get("stages", [])}
                for frame in stats["values"]["frames"]}

    def points_of(self, name):
        """(x, y, z) of the points of a PLY."""
        return [vertex[:3] for vertex in read_ply(self.folder / name)[1]]

    def skipped(self):
        """Of each frame, whether --resume found it complete."""
        stats = json.loads((self.folder / "stats.json").read_text())
        return [frame["skipped"] for frame in stats["values"]["frames"]]

    def same_frames(self, scene, frames):
        """Renders frames in a range, alone in memory, alone from the cache, and in four processes
        at once over a fresh cache; all must be the same bytes."""
        self.assert_ok(self.render(scene, "--frames", frames, "--cache", "c/", "-o", "r.####.exr",
                                   "--stats", "stats.json"))
        numbers = sorted(self.rows())
        for n in numbers:
            self.assert_ok(self.render(scene, "--frames", n, "-o", f"alone.{n:04d}.exr"))
            self.assert_ok(self.render(scene, "--frames", n, "--cache", "c/", "--cache-only",
                                       "-o", f"cached.{n:04d}.exr"))
        command = [str(BIN / "sss-render"), scene, "--frames", frames, "--cache", "shared/"]
        processes = [subprocess.Popen([*command, "-o", f"p{k}.####.exr", "--stats", f"p{k}.json"],
                                      cwd=self.folder, stderr=subprocess.PIPE) for k in range(4)]
        for process in processes:
            error = process.communicate()[1].decode()
            self.assertEqual(process.returncode, OK, error)
        for n in numbers:
            for name in ("alone", "cached", "p0", "p1", "p2", "p3"):
                for kind in ("exr", "png"):
                    self.assertEqual(self.bytes_of(f"{name}.{n:04d}.{kind}"),
                                     self.bytes_of(f"r.{n:04d}.{kind}"), f"{name} {n} {kind}")
        # The same stages, the same bytes, whoever made them; exitance is merged in turn.
        for path in sorted((self.folder / "c").iterdir()):
            if path.suffix in (".ssp", ".ssi", ".ssb", ".ssd"):
                self.assertEqual((self.folder / "shared" / path.name).read_bytes(),
                                 path.read_bytes())
        self.assert_nothing_made_twice("shared", [f"p{k}.json" for k in range(4)])
        return self.rows()

    def assert_nothing_made_twice(self, folder, stats):
        """What the processes of these --stats say they made is what lies in their folder, once."""
        made = [stage for name in stats for frame in self.rows(name).values()
                for (_, stage), reused in frame.items() if not reused]
        for stage, suffix in (("points", "ssp"), ("irradiance", "ssi"), ("shape", "ssd")):
            self.assertEqual(made.count(stage), len(list((self.folder / folder).glob(f"*.{suffix}"))),
                             f"{stage} by {stats}")

    def test_moving_camera(self):
        scene = self.write_scene(camera={"position": keys((1, [0, 3, 26]), (5, [8, 3, 24]))})
        rows = self.same_frames(scene, "1-3")
        for stage in ("points", "irradiance", "octree", "exitance"):
            self.assertFalse(rows[1]["ball", stage])
        for frame in (2, 3):
            for stage in ("points", "irradiance", "octree"):
                self.assertTrue(rows[frame]["ball", stage])
        self.assertNotEqual(self.bytes_of("r.0001.exr"), self.bytes_of("r.0002.exr"))

    def test_moving_light(self):
        scene = self.write_scene(lights=[
            {**LAMP, "transform": [{"rotate": {"axis": [0, 1, 0],
                                               "degrees": keys((1, 0), (10, 90))}}]}, SKY])
        rows = self.same_frames(scene, "1,4")
        self.assertTrue(rows[4]["ball", "points"])
        self.assertFalse(rows[4]["ball", "irradiance"])
        self.assertFalse(rows[4]["ball", "exitance"])

    def test_moving_occluder(self):
        screen = {"name": "screen", "shape": "rectangle", "width": 6, "height": 6, "material": "wall",
                  "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}},
                                {"translate": keys((1, [-9, 8, 4]), (4, [-3, 8, 4]))}]}
        box = {"name": "ball", "shape": "box", "size": [7, 8, 6], "material": "stone"}
        scene = self.write_scene(objects=[box, screen], materials={
            "stone": MARBLE, "wall": {"type": "lambertian", "reflectance": 0.5}})
        rows = self.same_frames(scene, "1,4")
        self.assertTrue(rows[4]["ball", "points"])
        self.assertFalse(rows[4]["ball", "irradiance"])
        self.assertNotEqual(self.bytes_of("r.0001.png"), self.bytes_of("r.0004.png"))

    def test_moving_body(self):
        """Under an even sky it is lit anew only by what stands around it."""
        turn = [{"rotate": {"axis": [0, 1, 0], "degrees": keys((1, 0), (3, 50))}},
                {"translate": keys((1, [0, 0, 0]), (3, [3, 0, 0]))}]
        box = {"name": "ball", "shape": "box", "size": [7, 8, 6], "material": "stone",
               "transform": turn}
        wall = {"name": "wall", "shape": "rectangle", "width": 9, "height": 9, "material": "wall",
                "transform": [{"translate": [0, 0, -7]}]}
        materials = {"stone": MARBLE, "wall": {"type": "lambertian", "reflectance": 0.5}}
        for objects, is_lit_the_same in (([box], True), ([box, wall], False)):
            scene = self.write_scene(objects=objects, materials=materials, lights=[SKY])
            self.assert_ok(self.render(scene, "--frames", "1-3", "--cache", f"m{len(objects)}/",
                                       "-o", "m.##.exr", "--stats", "stats.json"))
            self.assert_ok(self.render(scene, "--frames", 3, "-o", "alone.exr"))
            self.assertEqual(self.bytes_of("m.03.exr"), self.bytes_of("alone.exr"))
            rows = self.rows()
            for frame in (2, 3):
                self.assertTrue(rows[frame]["ball", "points"])
                self.assertEqual(rows[frame]["ball", "irradiance"], is_lit_the_same)

    def test_moving_together(self):
        """A turning body whose lamp turns with it, under an even sky, is lit the same."""
        turn = [{"rotate": {"axis": [0, 1, 0], "degrees": keys((1, 0), (10, 77))}},
                {"translate": keys((1, [0, 0, 0]), (10, [1, 0.3, 0.1]))}]
        scene = self.write_scene(
            objects=[{"name": "box", "shape": "box", "size": [8, 6, 4], "material": "stone",
                      "transform": turn}], lights=[{**LAMP, "transform": turn}, SKY])
        rows = self.same_frames(scene, "1,3,10")
        for frame in (3, 10):
            for stage in ("points", "irradiance", "octree"):
                self.assertTrue(rows[frame]["box", stage], frame)

    def shape_scene(self, name="scene.json", **changes):
        """The harness's ball, small enough for its shape to matter."""
        ball = {"name": "ball", "shape": "sphere", "radius": 2, "material": "stone"}
        stone = {"type": "translucent", "medium": "Marble", "diffusion": "shape"}
        return super().write_scene(name, **{"objects": [ball], "materials": {"stone": stone},
                                            "quality": {"tolerance": 0.1, "bounces": 0}, **changes})

    def test_shape_under_a_moving_camera(self):
        scene = self.shape_scene(camera={"position": keys((1, [0, 1, 11]), (5, [4, 1, 10]))})
        rows = self.same_frames(scene, "1-3")
        for stage in ("points", "irradiance", "octree", "shape"):
            self.assertFalse(rows[1]["ball", stage])
            self.assertTrue(rows[2]["ball", stage] and rows[3]["ball", stage], stage)
        self.assertNotEqual(self.bytes_of("r.0001.exr"), self.bytes_of("r.0002.exr"))

    def test_shape_under_a_moving_light(self):
        scene = self.shape_scene(lights=[
            {**LAMP, "transform": [{"rotate": {"axis": [0, 1, 0],
                                               "degrees": keys((1, 0), (10, 90))}}]}, SKY])
        rows = self.same_frames(scene, "1,4")
        self.assertTrue(rows[4]["ball", "points"])
        for stage in ("irradiance", "octree", "shape"):
            self.assertFalse(rows[4]["ball", stage])

    def test_shape_of_a_changing_medium(self):
        stone = {"type": "translucent", "sigmaSPrimePerMm": 2.5, "diffusion": "shape",
                 "sigmaAPerMm": keys((1, 0.002), (3, 0.02))}
        rows = self.same_frames(self.shape_scene(materials={"stone": stone}), "1-2")
        for stage in ("points", "irradiance", "octree"):
            self.assertTrue(rows[2]["ball", stage], stage)
        self.assertFalse(rows[2]["ball", "shape"])

    def test_shape_after_a_profile(self):
        """Light that was gathered for a profile is the same light; only its beams are lacking."""
        scene = self.shape_scene()
        self.assert_ok(self.render(scene, "-o", "alone.exr"))
        self.assert_ok(self.preprocess(scene, "--model", "dipole", "-o", "c/"))
        kept = {path.name: path.read_bytes() for path in (self.folder / "c").glob("*.ss*")}
        out = self.assert_ok(self.preprocess(scene, "-o", "c/", "--explain")).out
        self.assertIn("ball: irradiance made: no beams were kept", out)
        self.assertIn("ball: octree reused", out)
        self.assertIn("ball: shape made", out)
        for name, content in kept.items():
            self.assertEqual(self.bytes_of(f"c/{name}"), content, name)
        self.assert_ok(self.render(scene, "--cache", "c/", "--cache-only", "-o", "cached.exr"))
        self.assertEqual(self.bytes_of("cached.exr"), self.bytes_of("alone.exr"))
        next((self.folder / "c").glob("*.ssd")).unlink()
        self.assert_refused(BAD_INPUT, 'no shape for "ball"', self.render, scene, "--cache", "c/",
                            "--cache-only", "-o", "none.exr")

    def test_diffuse_limit_needs_no_stages(self):
        """Nor at a distance; closer by, the same body may want them."""
        camera = {"position": keys((1, [0, 600, 6000]), (2, [0, 600, 6000]), (3, [0, 3, 26]))}
        stone = {"type": "translucent", "sigmaSPrimePerMm": 10, "sigmaAPerMm": 0.3}
        scene = self.write_scene(camera=camera, materials={"stone": stone})
        rows = self.same_frames(scene, "1-3")
        self.assertEqual((rows[1], rows[2]), ({}, {}))
        self.assertFalse(rows[3]["ball", "points"])
        stats = json.loads((self.folder / "stats.json").read_text())["counts"]
        self.assertEqual((stats["diffuseLimitBodies"], stats["passOneSkipped"]), (2, 2))

    def test_changing_medium(self):
        """No light comes back to a box by itself: what its medium reflects lights nothing."""
        scene = self.write_scene(
            quality={"tolerance": 0.1, "bounces": 4},
            materials={"stone": {"type": "translucent", "sigmaSPrimePerMm": 2.5,
                                 "sigmaAPerMm": keys((1, 0.002), (3, 0.02))}})
        rows = self.same_frames(scene, "1-2")
        for stage in ("points", "irradiance", "octree"):
            self.assertTrue(rows[2]["ball", stage])
        self.assertFalse(rows[2]["ball", "exitance"])

    def test_medium_that_lights_its_own_body(self):
        """Light comes back from a floor: what the body reflects counts, and nothing else of it."""
        floor = {"name": "floor", "shape": "rectangle", "width": 30, "height": 30,
                 "material": "floor", "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}},
                                                    {"translate": [0, -4.1, 0]}]}
        box = {"name": "ball", "shape": "box", "size": [7, 8, 6], "material": "stone"}

        def explained(**changes):
            scene = self.write_scene(
                objects=[box, floor], quality={"tolerance": 0.1, "bounces": 4, "spacingMm": 1},
                materials={"floor": {"type": "lambertian", "reflectance": 0.8},
                           "stone": {"type": "translucent", "sigmaSPrimePerMm": 2,
                                     "sigmaAPerMm": 0.01, **changes}})
            return self.assert_ok(self.preprocess(scene, "-o", "c/", "--explain")).out
        explained()
        for change in ({"surfaceReflection": False}, {"singleScattering": False},
                       {"roughness": 0.5}, {"sigmaSPrimePerMm": 4, "sigmaAPerMm": 0.02}):
            self.assertIn("ball: irradiance reused", explained(**change), change)
        for change in ({"sigmaAPerMm": 0.1}, {"eta": 1.4}):
            self.assertIn("ball: irradiance made: its medium refracts or reflects otherwise",
                          explained(**change), change)

    def bend(self, frames):
        for n in frames:
            self.write(f"bar.{n:04d}.obj", bar(0.4 * (n - 1)))
        return self.write_scene(objects=[{"name": "bar", "mesh": "bar.####.obj",
                                          "material": "stone"}])

    def test_mesh_sequence(self):
        scene = self.bend((1, 2, 3))
        rows = self.same_frames(scene, "1-3")
        for frame in (2, 3):
            self.assertTrue(rows[frame]["bar", "points"], "carried, not placed again")
            self.assertFalse(rows[frame]["bar", "irradiance"])
        self.assert_ok(self.preprocess(scene, "--frames", "1-3", "-o", "c/", "--export-ply",
                                       "p.##.ply"))
        first, third = (self.points_of(f"p.0{n}.ply") for n in (1, 3))
        self.assertEqual(len(first), len(third))
        places = {}
        for p in third:
            places.setdefault(tuple(round(c) for c in p), []).append(p)
        moved = [(x, y + lift_of_bar(0.8, x), z) for x, y, z in first]
        self.assertGreater(max(math.dist(a, b) for a, b in zip(first, moved)), 0.7)
        # Points have kept their faces: each is where the bend took it, or, where its cell reaches
        # over an edge, within a twentieth of the spacing.
        distances = []
        for p in moved:
            near = [q for corner in itertools.product(*({round(c - 0.02), round(c + 0.02)} for c in p))
                    for q in places.get(corner, []) if math.dist(p, q) < 0.02]
            self.assertEqual(len(near), 1, p)
            distances.append(math.dist(p, near[0]))
        self.assertLess(sorted(distances)[len(distances) * 2 // 3], 1e-6)
        self.write("bar.0003.obj", bar(0.8, segments=7))
        self.assert_ok(self.render(scene, "--frames", "1-3", "--cache", "d/", "-o", "d.####.exr",
                                   "--stats", "other.json"))
        self.assertFalse(self.rows("other.json")[3]["bar", "points"], "other faces, other points")
        self.assertEqual(self.bytes_of("d.0002.exr"), self.bytes_of("r.0002.exr"))

    def test_static_scene(self):
        scene = self.write_scene()
        self.assert_ok(self.render(scene, "--frames", "1-2", "-o", "n.####.exr"))
        self.assertNotEqual(self.bytes_of("n.0001.png"), self.bytes_of("n.0002.png"))
        self.assert_ok(self.render(scene, "--frames", "1-2", "--camera-seed", 7, "-o", "s.##.exr"))
        self.assertEqual(self.bytes_of("s.01.png"), self.bytes_of("s.02.png"))
        (head, pixels), (head2, pixels2) = (read_exr(self.folder / f"s.0{n}.exr") for n in (1, 2))
        self.assertEqual(head["channels"], head2["channels"])
        self.assertEqual(pixels, pixels2)
        self.assertEqual({key for key in head if head[key] != head2.get(key)}, {"imageCounter"})
        self.assert_ok(self.render(scene, "--camera-seed", 0, "-o", "zero.exr"))
        self.assert_ok(self.render(scene, "-o", "plain.exr"))
        self.assertEqual(self.bytes_of("zero.exr"), self.bytes_of("plain.exr"))

    def lit(self, frames, **changes):
        """{frame: green irradiance of the points, the lamp turning by a quarter degree a frame}"""
        lamp = {**LAMP, "transform": [{"rotate": {"axis": [0, 1, 0],
                                                  "degrees": keys((0, 0), (8, 2))}}]}
        quality = {"tolerance": 0.1, "bounces": 1, **changes}
        scene = self.write_scene(lights=[lamp, SKY], quality=quality)
        self.assert_ok(self.preprocess(scene, "--frames", f"1-{frames}", "-o", "lit/",
                                       "--export-ply", "lit.##.ply"))
        names, _ = read_ply(self.folder / "lit.01.ply")
        vertices = [read_ply(self.folder / f"lit.0{n}.ply")[1] for n in range(1, frames + 1)]
        for other in vertices[1:]:
            self.assertEqual([v[:3] for v in other], [v[:3] for v in vertices[0]])
        green = names.index("irradiance_g")
        return [[v[green] for v in frame] for frame in vertices]

    def test_nothing_flickers(self):
        """Under a slowly turning lamp, irradiance goes smoothly from frame to frame: all frames
        share their light samples. Independent ones would make second differences in time of
        sqrt(6) times the noise of a point, which two numbers of samples tell (0.023 W/m2 here, and
        second differences 0.00009)."""
        def rms(values):
            return math.sqrt(sum(v * v for v in values) / len(values))
        frames = self.lit(8, irradianceSamples=16)
        other = self.lit(1, irradianceSamples=15)[0]
        noise = rms([a - b for a, b in zip(frames[0], other)]) / math.sqrt(2)
        second = rms([a - 2 * b + c for f, g, h in zip(frames, frames[1:], frames[2:])
                      for a, b, c in zip(f, g, h)])
        self.assertGreater(rms([a - b for a, b in zip(frames[0], frames[7])]), noise / 10)
        self.assertLess(second, 0.05 * math.sqrt(6) * noise,
                        f"second differences {second:.3g} W/m2, noise of a point {noise:.3g} W/m2")

    def test_resume(self):
        scene = self.write_scene(camera={"position": keys((1, [0, 3, 26]), (5, [8, 3, 24]))})
        command = (scene, "--frames", "1-5", "--cache", "c/", "-o", "r.%04d.exr", "--resume",
                   "--stats", "stats.json")
        self.assert_ok(self.render(*command))
        whole = {path.name: path.read_bytes() for path in self.folder.glob("r.*")}
        (self.folder / "r.0002.exr").write_bytes(whole["r.0002.exr"][:-100])
        (self.folder / "r.0003.exr").unlink()
        (self.folder / "r.0004.png").unlink()
        shutil.copy(self.folder / "r.0001.exr", self.folder / "r.0005.exr")  # whole, but of another
        self.assert_ok(self.render(*command))
        self.assertEqual(self.skipped(), [True, False, False, False, False])
        for name, content in whole.items():
            self.assertEqual(self.bytes_of(name), content, name)
        for size in (0, 40, len(whole["r.0003.png"]) - 1):  # a preview counts as well
            (self.folder / "r.0003.png").write_bytes(whole["r.0003.png"][:size])
            self.assert_ok(self.render(*command))
            self.assertEqual(self.skipped(), [True, True, False, True, True], size)
            self.assertEqual(self.bytes_of("r.0003.png"), whole["r.0003.png"])
        # Another scene of the same name has other pictures.
        self.write_scene(lights=[SKY])
        self.assert_ok(self.render(*command))
        self.assertFalse(any(self.skipped()))

    def test_resume_after_the_reference_frame_changed(self):
        """Points of all frames are placed on it, so that all pictures are others."""
        scene = self.bend((1, 2, 3))
        command = (scene, "--frames", "2-3", "-o", "r.####.exr", "--stats", "stats.json")
        self.assert_ok(self.render(*command))
        self.assert_ok(self.render(*command, "--resume"))
        self.assertEqual(self.skipped(), [True, True])
        self.write("bar.0001.obj", bar(-1))
        self.assert_ok(self.render(*command, "--resume"))
        self.assertEqual(self.skipped(), [False, False])

    def test_cache_only(self):
        scene = self.write_scene()
        self.assert_refused(4, r"none.*no such folder", self.render, scene, "--cache", "none/",
                            "--cache-only", "-o", "a.exr")
        self.assert_ok(self.preprocess(scene, "-o", "c/"))
        self.assert_ok(self.render(scene, "--cache", "c", "--cache-only", "-o", "a.exr"))
        other = self.write_scene("other.json", lights=[SKY])
        (self.folder / "c").rename(self.folder / "kept")
        result = self.render(other, "--cache", "kept", "--cache-only", "-o", "b.exr")
        self.assertEqual(result.code, BAD_INPUT, str(result))
        self.assertRegex(result.err, r'no irradiance for "ball" in frame 1: the lights')
        self.assertFalse((self.folder / "b.exr").exists())

    def test_damaged_stages_are_named_and_made_anew(self):
        scene = self.write_scene()
        self.assert_ok(self.render(scene, "--cache", "c/", "-o", "a.exr"))
        stages = [p for p in (self.folder / "c").iterdir() if p.suffix != ""]
        self.assertEqual(len(stages), 3)
        whole = {p: p.read_bytes() for p in stages}
        for path in stages:
            for at in (3, 1000, len(whole[path]) - 1):
                damaged = bytearray(whole[path])
                damaged[at] ^= 4
                path.write_bytes(damaged)
                if path.suffix == ".ssi":
                    self.assert_refused(
                        BAD_INPUT, 'no irradiance for "ball" in frame 1: its file there cannot be',
                        self.render, scene, "--cache", "c/", "--cache-only", "-o", "c.exr")
                if path.suffix == ".ssp":  # asked for when its irradiance is not there
                    next(p for p in stages if p.suffix == ".ssi").unlink()
                result = self.assert_ok(self.render(scene, "--cache", "c/", "-o", "b.exr"))
                self.assertIn(path.name, " ".join(result.lines("WARN")))
                self.assertEqual(self.bytes_of("a.exr"), self.bytes_of("b.exr"))
                for p in stages:
                    self.assertEqual(p.read_bytes(), whole[p], p.name)

    def test_explain(self):
        scene = self.write_scene()
        self.assertIn("ball: points made: the cache has none of it",
                      self.preprocess(scene, "-o", "c/", "--explain").out)
        self.assertIn("ball: irradiance reused",
                      self.preprocess(scene, "-o", "c/", "--explain").out)
        other = self.write_scene("other.json", lights=[SKY])
        out = self.preprocess(other, "-o", "c/", "--explain").out
        self.assertIn("ball: points reused", out)
        self.assertIn("ball: irradiance made: the lights are others", out)

    def test_frames_of_single_files(self):
        scene = self.write_scene(lights=[{**LAMP, "radiance": keys((1, 10), (2, 20))}, SKY])
        self.assert_refused(USAGE, "####", self.preprocess, scene, "--frames", "1-2", "-o", "a.ssc")
        self.assert_refused(USAGE, "####", self.render, scene, "--frames", "1-2", "-o", "a.exr")
        self.assert_ok(self.preprocess(scene, "--frames", "1-2", "-o", "a.##.ssc"))
        self.assert_ok(self.render(scene, "--frames", "1-2", "--cache", "a.##.ssc", "-o", "a.##.exr"))
        self.assert_ok(self.render(scene, "--frames", "1-2", "-o", "b.##.exr"))
        for n in (1, 2):
            self.assertEqual(self.bytes_of(f"a.0{n}.exr"), self.bytes_of(f"b.0{n}.exr"))
        self.assert_refused(BAD_INPUT, "the lights are others", self.render, scene, "--frames", 2,
                            "--cache", "a.01.ssc", "-o", "c.exr")

    def test_estimate_of_frames(self):
        """Counts stages that frames share once, and makes nothing."""
        def estimate(scene, frames):
            return json.loads(self.assert_ok(self.preprocess(
                scene, "--frames", frames, "-o", "none/", "--print-estimate", "--json")).out)
        lamp = {**LAMP, "transform": [{"rotate": {"axis": [0, 1, 0],
                                                  "degrees": keys((1, 0), (10, 90))}}]}
        lit = self.write_scene("lit.json", lights=[lamp, SKY])
        bent = self.bend((1, 2, 3))
        for scene in (lit, bent):
            one, all_three = estimate(scene, "1"), estimate(scene, "1-3")
            self.assertEqual(one["points"], all_three["points"])
            self.assertEqual(one["memoryBytes"], all_three["memoryBytes"])
        self.write("bar.0003.obj", bar(0.8, segments=7))  # points of its own
        self.assertGreater(estimate(bent, "1-3")["points"], 1.9 * one["points"])
        self.assertFalse((self.folder / "none").exists())
        # At least what lies in the cache, and not many times that.
        self.assert_ok(self.preprocess(bent, "--frames", "1", "-o", "c/"))
        stored = sum(path.stat().st_size for path in (self.folder / "c").glob("*.ss*"))
        self.assertGreater(one["memoryBytes"], stored)
        self.assertLess(one["memoryBytes"], 5 * stored)

    def test_estimate_and_progress(self):
        scene = self.write_scene()
        estimate = json.loads(self.preprocess(scene, "--print-estimate", "--json").out)
        self.assert_ok(self.preprocess(scene, "-o", "a.ssc", "--stats", "s.json"))
        stats = json.loads((self.folder / "s.json").read_text())
        points = stats["counts"]["points"]
        self.assertAlmostEqual(estimate["points"] / points, 1, delta=0.25)
        self.assertGreater(estimate["seconds"], 0)
        place = {"frame": 1, "position": 1, "frames": 1}
        for how, is_line in (("json", lambda line: "fraction" in json.loads(line)
                              and place.items() <= json.loads(line).items()),
                             ("none", lambda line: False)):
            result = self.assert_ok(self.preprocess(scene, "-o", "a.ssc", "--progress", how))
            others = [line for line in result.err.splitlines()
                      if not line.startswith(("INFO", "WARN"))]
            self.assertEqual(len(others) > 0, how == "json", result.err)
            self.assertTrue(all(map(is_line, others)), result.err)
        self.assert_refused(USAGE, "plain, json or none", self.preprocess, scene, "-o", "a.ssc",
                            "--progress", "loud")


if __name__ == "__main__":
    main()
