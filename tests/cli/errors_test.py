#!/usr/bin/env python3
"""Whatever is wrong with the input or the command ends with one sentence and the documented code,
before anything is written."""

import json

from harness import BAD_INPUT, IO, OK, RESOURCES, STRICT, TETRAHEDRON, USAGE, CliTest, main


class Usage(CliTest):
    def test_nothing_given(self):
        for run in (self.preprocess, self.render):
            self.assert_refused(USAGE, "scene|required", run)

    def test_no_output(self):
        scene = self.write_scene()
        for run in (self.preprocess, self.render):
            self.assert_refused(USAGE, "-o", run, scene)

    def test_unknown_option_is_named(self):
        scene = self.write_scene()
        for run in (self.preprocess, self.render):
            self.assert_refused(USAGE, "--spcaing", run, scene, "-o", "out", "--spcaing", "1")

    def test_values_that_make_no_sense(self):
        scene = self.write_scene()
        for option, value in (("--spacing", "-1"), ("--spacing", "nan"), ("--tolerance", "0"),
                              ("--tolerance", "2"), ("--threads", "many"), ("--threads", "100000"),
                              ("--seed", "-1"), ("--max-points", "0"), ("--meters-per-unit", "0")):
            with self.subTest(option=option, value=value):
                self.assert_refused(USAGE, option, self.preprocess, scene, "-o", "out.ssc",
                                    option, value)
        for option, value in (("--samples", "0"), ("--size", "10"), ("--size", "0x10"),
                              ("--size", "10x10x10"), ("--tolerance", "-0.1")):
            with self.subTest(option=option, value=value):
                self.assert_refused(USAGE, option, self.render, scene, "-o", "out.exr",
                                    option, value)


class Scenes(CliTest):
    def refused(self, code, pattern, scene, *options):
        self.assert_refused(code, pattern, self.preprocess, scene, "-o", "out.ssc", *options)
        if not options:
            self.assert_refused(code, pattern, self.render, scene, "-o", "out.exr")

    def test_missing_file(self):
        self.refused(IO, r"none\.json.*No such file", "none.json")

    def test_a_folder(self):
        (self.folder / "folder").mkdir()
        self.refused(IO, r"folder.*directory", "folder")

    def test_empty_file(self):
        self.refused(BAD_INPUT, r"empty\.json", self.write("empty.json", ""))

    def test_broken_json_gives_line_and_column(self):
        self.refused(BAD_INPUT, r"broken\.json:2:\d+", self.write("broken.json", '{\n "camera": [1,, 2]}'))

    def test_misspelt_key_gives_the_nearest_name(self):
        scene = self.write_scene(quality={"tolerence": 0.1})
        self.refused(BAD_INPUT, r'scene\.json:\d+:\d+.*tolerence.*"tolerance"', scene)

    def test_units_are_required(self):
        scene = self.write_scene(metersPerUnit=None)
        self.refused(BAD_INPUT, "metersPerUnit", scene)
        self.assert_ok(self.preprocess(scene, "-o", "out.ssc", "--meters-per-unit", "0.001"))

    def test_negative_coefficients(self):
        scene = self.write_scene(materials={"stone": {
            "type": "translucent", "sigmaAPerMm": [0.002, -0.004, 0.007], "sigmaSPrimePerMm": 2}})
        self.refused(BAD_INPUT, r"scene\.json:\d+:\d+.*sigmaAPerMm.*-0\.004", scene)

    def test_unknown_medium_gives_the_nearest_name(self):
        scene = self.write_scene(materials={"stone": {"type": "translucent", "medium": "Marbel"}})
        self.refused(BAD_INPUT, r'Marbel.*"Marble"', scene)


class Meshes(CliTest):
    def refused(self, code, pattern, name):
        scene = self.write_mesh_scene(name)
        self.assert_refused(code, pattern, self.preprocess, scene, "-o", "out.ssc")
        self.assert_refused(code, pattern, self.render, scene, "-o", "out.exr")

    def test_missing_file(self):
        self.refused(IO, r"none\.obj", "none.obj")

    def test_empty_files(self):
        for kind in ("obj", "ply", "stl", "off"):
            with self.subTest(kind=kind):
                self.refused(BAD_INPUT, rf"empty\.{kind}", self.write(f"empty.{kind}", ""))

    def test_no_faces(self):
        self.refused(BAD_INPUT, r"points\.obj.*(face|triangle)",
                     self.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"))

    def test_only_faces_without_area(self):
        self.refused(BAD_INPUT, r"flat\.obj",
                     self.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"))

    def test_nan_vertices(self):
        for number in ("nan", "inf", "1e400"):
            with self.subTest(number=number):
                self.refused(BAD_INPUT, r"bad\.obj",
                             self.write("bad.obj", TETRAHEDRON.replace("10 0 0", f"10 {number} 0")))

    def test_unknown_format(self):
        self.refused(BAD_INPUT, r"mesh\.xyz", self.write("mesh.xyz", TETRAHEDRON))

    def test_the_tetrahedron_itself_is_fine(self):
        scene = self.write_mesh_scene(self.write("good.obj", TETRAHEDRON))
        self.assert_ok(self.preprocess(scene, "-o", "out.ssc"))


class Caches(CliTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write_scene()
        self.assert_ok(self.preprocess(self.scene, "-o", "good.ssc"))
        self.whole = (self.folder / "good.ssc").read_bytes()

    def refused(self, pattern, cache, scene=None, code=BAD_INPUT):
        return self.assert_refused(code, pattern, self.render, scene or self.scene,
                                   "--cache", cache, "-o", "out.exr")

    def test_missing(self):
        self.refused(r"none\.ssc.*No such file", "none.ssc", code=IO)
        self.assert_refused(IO, r"none\.ssc", self.preprocess, "--info", "none.ssc")

    def test_truncated(self):
        for size in (0, 7, 40, 64, len(self.whole) // 2, len(self.whole) - 1):
            with self.subTest(size=size):
                (self.folder / "cut.ssc").write_bytes(self.whole[:size])
                self.refused(r"cut\.ssc.*(truncated|empty)", "cut.ssc")
                self.assert_refused(BAD_INPUT, "truncated|empty", self.preprocess, "--info",
                                    "cut.ssc")

    def damage(self, *places):
        damaged = bytearray(self.whole)
        for place in places:
            damaged[place] ^= 0x20
        (self.folder / "bad.ssc").write_bytes(damaged)

    def test_damaged(self):
        """Only what is needed is read; what is damaged in it is named, and ends the run."""
        self.assert_ok(self.render(self.scene, "--cache", "good.ssc", "-o", "good.exr", "--no-png",
                                   "--no-keep"))
        picture = (self.folder / "good.exr").read_bytes()
        for place in range(0, len(self.whole), len(self.whole) // 9):
            with self.subTest(place=place):
                self.damage(place)
                self.assert_refused(BAD_INPUT, r"bad\.ssc", self.preprocess, "--info", "bad.ssc")
                result = self.render(self.scene, "--cache", "bad.ssc", "-o", "bad.exr", "--no-png",
                                     "--no-keep")
                if result.code == BAD_INPUT:
                    self.assertRegex(result.lines("ERROR")[0], r"bad\.ssc.*(damaged|not a cache)")
                    self.assertNotIn("bad.exr", self.files())
                else:
                    self.assert_ok(result)
                    self.assertEqual((self.folder / "bad.exr").read_bytes(), picture)
                    (self.folder / "bad.exr").unlink()

    def test_damage_found_while_rendering(self):
        info = json.loads(self.preprocess("--info", "good.ssc", "--json").out)
        offsets = []
        at = 64
        for section in info["sections"]:
            if section["kind"] == "irrad":
                offsets = range(at, at + section["bytes"], 1000)
            at += (section["bytes"] + 63) // 64 * 64
        self.damage(*offsets)
        self.refused(r"bad\.ssc.*section 'irrad' of body 0 is damaged", "bad.ssc")

    def test_something_else(self):
        self.refused(r"scene\.json.*not a cache", self.scene)

    def test_of_another_scene(self):
        ball = {"name": "ball", "shape": "sphere", "radius": 5, "material": "stone"}
        lamp = {"type": "environment", "radiance": 0.3}
        for pattern, changes in (
                ("mesh|object|shape|geometry", {"objects": [{**ball, "radius": 6}]}),
                ("medium|material", {"materials": {"stone": {"type": "translucent",
                                                             "medium": "Skin1"}}}),
                ("light", {"lights": [lamp]})):
            with self.subTest(changes=changes):
                self.refused(rf"good\.ssc.*({pattern})", "good.ssc",
                             self.write_scene("other.json", **changes))

    def test_of_another_camera_is_good(self):
        other = self.write_scene("other.json", camera={"position": [3, 0, 20]},
                                 film={"width": 8, "height": 8, "samples": 1})
        self.assert_ok(self.render(other, "--cache", "good.ssc", "-o", "out.exr"))


class Outputs(CliTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write_scene()

    def test_unwritable_places(self):
        (self.folder / "folder.exr").mkdir()
        (self.folder / "device.exr").symlink_to("/dev/null")
        for place in ("none/out.exr", "folder.exr", "device.exr", "scene.json/out.exr"):
            with self.subTest(place=place):
                self.assert_refused(IO, "cannot", self.preprocess, self.scene, "-o", place)
                self.assert_refused(IO, "cannot", self.render, self.scene, "-o", place)

    def test_a_picture_is_called_exr(self):
        self.assert_refused(USAGE, r"out\.jpg.*\.exr", self.render, self.scene, "-o", "out.jpg")

    def test_unwritable_extras(self):
        self.assert_refused(IO, "none/p.ply", self.preprocess, self.scene, "-o", "out.ssc",
                            "--export-ply", "none/p.ply")
        self.assert_refused(IO, "none/s.json", self.preprocess, self.scene, "-o", "out.ssc",
                            "--stats", "none/s.json")
        self.assert_refused(IO, "none/s.json", self.render, self.scene, "-o", "out.exr",
                            "--stats", "none/s.json")

    def test_full_disk_keeps_the_old_files(self):
        self.write("out.ssc", "old cache")
        self.write("out.exr", "old picture")
        self.assert_refused(IO, r"out\.ssc.*cannot", self.preprocess, self.scene, "-o", "out.ssc",
                            file_limit=4096)
        self.assert_refused(IO, r"out\.(exr|png).*cannot", self.render, self.scene, "-o", "out.exr",
                            "--size", "64x64", file_limit=4096)

    def test_limits_are_checked_before_the_work(self):
        self.assert_refused(RESOURCES, r"10\b.*--max-points|--max-points.*10\b", self.preprocess,
                            self.scene, "-o", "out.ssc", "--max-points", "10")


class Strict(CliTest):
    def test_warnings_become_code_six_with_the_files_whole(self):
        # Nearly all absorption: far from where diffusion holds.
        scene = self.write_scene(materials={"stone": {
            "type": "translucent", "sigmaAPerMm": 5, "sigmaSPrimePerMm": 1, "eta": 1.3}})
        lax = self.assert_ok(self.preprocess(scene, "-o", "lax.ssc"))
        self.assertRegex(" ".join(lax.lines("WARN")), "diffusion")
        strict = self.preprocess(scene, "-o", "strict.ssc", "--strict")
        self.assertEqual(strict.code, STRICT, str(strict))
        self.assertEqual(len(strict.lines("ERROR")), 1, str(strict))
        self.assertEqual((self.folder / "strict.ssc").read_bytes(),
                         (self.folder / "lax.ssc").read_bytes())

    def test_without_warnings_strict_is_fine(self):
        result = self.assert_ok(self.preprocess(self.write_scene(), "-o", "out.ssc", "--strict"))
        self.assertEqual(result.code, OK)
        self.assertEqual(result.lines("WARN"), [])


if __name__ == "__main__":
    main()
