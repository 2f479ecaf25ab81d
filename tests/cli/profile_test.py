#!/usr/bin/env python3
"""--profile and --list-materials: what is printed is the profile, to the digits promised."""

import collections
import csv
import io
import json
import math

from harness import BAD_INPUT, IO, SANITIZED, SHARED, USAGE, CliTest, main

# The shared table's names: model, boundary.
MODELS = {
    "dipole": ("dipole", "polynomial"), "dipole_exactF": ("dipole", "exact"),
    "better_dipole": ("better_dipole", "polynomial"),
    "better_dipole_exactC": ("better_dipole", "exact"),
    "nd_mfp_diff": ("normalized_diffusion", "polynomial"),
    "nd_mfp_perp": ("normalized_diffusion_perpendicular", "polynomial"),
    "nd_dmfp": ("normalized_diffusion_dmfp", "polynomial"),
    "multipole_R": ("multipole", "polynomial"),
    "multipole_T": ("multipole_transmittance", "polynomial"),
    "pbd_ms_converged": ("photon_beam", "polynomial"),
    "pbd_ss_converged": ("photon_beam_single", "polynomial"),
}
MARBLE_G = "sigma_a=0.0041,sigma_s_prime=2.62,eta=1.5"
# Rows of the table with few parameters are of measured media, by name and channel.
MEASURED = {"Ketchup", "Marble", "Skimmilk", "Skin1"}
TABLE_RESIDUE = 1e-24  # the table's own, of series and tails cut at 25 digits of the peak


class Printed:
    """What --profile --csv printed: head (name to text), columns (name to numbers)."""

    def __init__(self, text):
        lines = text.splitlines()
        self.head = dict(line[2:].split(" ", 1) for line in lines if line.startswith("#"))
        rows = list(csv.DictReader(io.StringIO("\n".join(
            line for line in lines if not line.startswith("#")))))
        self.columns = {name: [float(row[name]) for row in rows] for name in rows[0]}
        self.text = [line for line in lines if not line.startswith("#")]

    def totals(self):
        return [float(x) for x in self.head["total"].split()]


class ProfileTest(CliTest):
    def profile(self, material, *options):
        result = self.assert_ok(self.render("--profile", material, "--csv", *options))
        self.assertEqual(result.err, "")
        return Printed(result.out)

    def near(self, value, expected, relative, where):
        limit = relative * abs(expected) + TABLE_RESIDUE
        self.assertLessEqual(abs(value - expected), limit, f"{where}: {value} for {expected}")


class Golden(ProfileTest):
    def setUp(self):
        super().setUp()
        if SANITIZED:
            self.skipTest("a program for each row: the unit tests check the same tables")

    def shared(self, name):
        path = SHARED / "golden" / name
        if not path.exists():
            self.skipTest("no shared folder")
        with path.open() as file:
            return list(csv.DictReader(file))

    @staticmethod
    def arguments(row):
        """The command's (material, options), or None if the row's parameters are no medium's."""
        model, boundary = MODELS[row["model"]]
        options = ["--model", model, "--boundary", boundary]
        values = dict(part.split("=") for part in row["params"].split(";") if "=" in part)
        if "d" in values:
            options += ["--thickness", values["d"]]
        if row["material"] in MEASURED:
            return row["material"], options
        if "sigma_a" not in values:
            return None
        keys = ("sigma_prime_s", "sigma_s", "sigma_a", "eta", "g")
        return ",".join(f"{k}={values[k]}" for k in keys if k in values), options

    def test_profiles(self):
        groups = collections.defaultdict(list)
        for row in self.shared("profiles.csv"):
            if row["model"] in MODELS and self.arguments(row):
                material, options = self.arguments(row)
                groups[(material, *options)].append(row)
        checked = 0
        for (material, *options), rows in groups.items():
            radii = sorted({row["r_mm"] for row in rows}, key=float)
            printed = self.profile(material, *options, "--radii", ",".join(radii))
            index = {r: i for i, r in enumerate(radii)}
            relative = 1e-8 if "pbd" in rows[0]["model"] else 1e-10
            peak = max(abs(float(row["R_d_mm^-2"])) for row in rows)
            for row in rows:
                channel = row["channel"] if row["channel"] in "RGB" else "R"
                i, expected = index[row["r_mm"]], float(row["R_d_mm^-2"])
                if abs(expected) < 1e-30 * peak:
                    continue
                where = f"{row['model']} {row['material']} {channel} r = {row['r_mm']}"
                self.near(printed.columns["R_d_" + channel][i], expected, relative, where)
                tail = row["tail_int_r_to_inf_2pi_r_R"]
                if tail:
                    total = printed.totals()["RGB".index(channel)]
                    inside = printed.columns["cumulative_" + channel][i]
                    self.assertAlmostEqual(total - inside, float(tail), delta=1e-9, msg=where)
                checked += 1
        self.assertGreater(checked, 1500)

    def test_totals(self):
        checked = 0
        for row in self.shared("totals.csv"):
            if row["model"] not in MODELS or not self.arguments(row):
                continue
            material, options = self.arguments(row)
            printed = self.profile(material, *options, "--radii", "1")
            channel = "RGB".index(row["channel"]) if row["channel"] in "RGB" else 0
            self.near(printed.totals()[channel], float(row["total"]), 1e-10, str(row))
            checked += 1
        self.assertGreater(checked, 100)


class Columns(ProfileTest):
    def test_cumulative_is_the_integral_and_ends_at_the_total(self):
        radii = [1e-9 * 1.02 ** i for i in range(1400)]
        printed = self.profile(MARBLE_G, "--model", "better_dipole",
                               "--radii", ",".join(map(repr, radii)))
        self.assertEqual(printed.columns["r_mm"], radii)
        value = printed.columns["R_d_G"]
        inside = printed.columns["cumulative_G"]
        total = inside[0]
        for i in range(1, len(radii)):
            ratio = math.log(radii[i] / radii[i - 1])  # trapezium in log r
            total += ratio * math.pi * (radii[i] ** 2 * value[i] + radii[i - 1] ** 2 * value[i - 1])
            self.assertGreaterEqual(inside[i], inside[i - 1] * (1 - 1e-9))
            self.assertAlmostEqual(total, inside[i], delta=2e-4 * inside[i])
        self.assertAlmostEqual(inside[-1], printed.totals()[1], delta=2e-3)

    def test_default_radii_and_both_layouts(self):
        printed = self.profile("Marble")
        self.assertEqual(printed.text[0], "r_mm,R_d_R,R_d_G,R_d_B,cumulative_R,cumulative_G,"
                                          "cumulative_B")
        paths = [float(x) for x in printed.head["mean_free_path_mm"].split()]
        self.assertAlmostEqual(printed.columns["r_mm"][0], 1e-3 * min(paths), delta=1e-12)
        self.assertAlmostEqual(printed.columns["r_mm"][-1], 1e2 * max(paths), delta=1e-9)
        aligned = self.assert_ok(self.render("--profile", "Marble")).out
        rows = [line.split() for line in aligned.splitlines() if not line.startswith("#")]
        self.assertEqual([",".join(row) for row in rows], printed.text)
        self.assertEqual(len({len(line) for line in aligned.splitlines()
                              if not line.startswith("#")}), 1)
        # 17 significant digits
        self.assertRegex(rows[1][1], r"^\d\.\d{16}e[+-]\d\d$")

    def test_at_zero(self):
        finite = self.profile(MARBLE_G, "--radii", "0")
        self.assertTrue(0 < finite.columns["R_d_R"][0] < math.inf)
        self.assertEqual(finite.columns["cumulative_R"][0], 0)
        singular = self.profile(MARBLE_G, "--radii", "0", "--model", "normalized_diffusion")
        self.assertEqual(singular.columns["R_d_R"][0], math.inf)
        self.assertEqual(singular.columns["cumulative_R"][0], 0)

    def test_every_radius_gives_numbers(self):
        radii = [5e-324, 1e-300, 1e-200, 1e-155, 1e-20, 1e-3, 1, 1e20, 1e160, 1.7e308]
        for model, medium, more in (
                ("dipole", "Marble", ()), ("better_dipole", "sigma_a=0,sigma_s=1e-9", ()),
                ("photon_beam", "Marble", ()), ("photon_beam_single", "sigma_a=1,sigma_s=1e9", ()),
                ("normalized_diffusion", "sigma_a=1e-300,sigma_s=1", ()),
                ("multipole", "Marble", ("--thickness", "1e-3"))):
            printed = self.profile(medium, "--model", model, "--radii",
                                   ",".join(map(repr, radii)), *more)
            for c, total in zip("RGB", printed.totals()):
                value, inside = printed.columns["R_d_" + c], printed.columns["cumulative_" + c]
                self.assertEqual(value, sorted(value, reverse=True), model)  # NaN is nowhere sorted
                self.assertEqual(inside, sorted(inside), model)
                self.assertTrue(value[-1] == 0 and math.isfinite(value[4]), model)
                self.assertAlmostEqual(inside[-1], total, delta=1e-9 * total, msg=model)

    def test_thin_slabs_are_smooth(self):
        radii = [10 ** (-7 + i / 20) for i in range(160)]
        printed = self.profile("sigma_a=0.1,sigma_s=0.9,eta=1.3", "--model",
                               "multipole_transmittance", "--thickness", "1.0001", "--radii",
                               ",".join(map(repr, radii)))
        inside = printed.columns["cumulative_R"]
        for a, b in zip(inside, inside[1:]):
            # No faster than the area, which a decreasing profile cannot outrun.
            self.assertTrue(a <= b <= a * 10 ** 0.1 * (1 + 1e-9), f"{a} {b}")

    def test_a_color_is_returned(self):
        for model in ("dipole", "better_dipole", "photon_beam", "normalized_diffusion"):
            printed = self.profile("color=0.9/0.5/0.01,mfp=2,eta=1.4", "--model", model,
                                   "--radii", "1")
            for total, color in zip(printed.totals(), (0.9, 0.5, 0.01)):
                self.assertAlmostEqual(total, color, delta=1e-6)
            self.assertEqual([float(x) for x in printed.head["mean_free_path_mm"].split()],
                             [2.0, 2.0, 2.0])
        slab = self.profile("color=0.5/0.3/0.01,mfp=1", "--model", "multipole", "--thickness", "2",
                            "--radii", "1")
        for total, color in zip(slab.totals(), (0.5, 0.3, 0.01)):
            self.assertAlmostEqual(total, color, delta=1e-6)

    def test_the_papers_polynomials_have_their_range(self):
        material = "sigma_a=0.001,sigma_s=1,eta=3"
        papers = ("--model", "better_dipole", "--boundary", "polynomial", "--radii", "1")
        self.assertIn("0.5 to 2.4", self.profile(material, *papers).head["note:"])
        self.assertNotIn("note:", self.profile(material, "--radii", "1").head)

    def test_equal_ways_to_name_a_medium(self):
        self.write_scene(materials={"stone": {"type": "translucent", "medium": "Marble"}, "wax": {
            "type": "translucent", "sigmaAPerMm": [0.0021, 0.0041, 0.0071], "eta": 1.5,
            "sigmaSPrimePerMm": [2.19, 2.62, 3.0], "profile": "better_dipole"}})
        numbers = "sigma_a=0.0021/0.0041/0.0071;sigma_prime_s=2.19/2.62/3.0;eta=1.5;g=0"
        first = self.profile("Marble").text
        for name in ("marble", "scene.json:stone", numbers):
            self.assertEqual(self.profile(name).text, first, name)
        better = self.profile(numbers, "--model", "better_dipole").text
        self.assertEqual(self.profile("scene.json:wax").text, better)
        self.assertEqual(self.profile("scene.json:wax", "--model", "dipole").text, first)

    def test_shader_names_of_a_scene(self):
        self.write_scene(metersPerUnit=0.01, materials={
            "wax": {"type": "translucent", "subsurface_color": [0.9, 0.5, 0.1],
                    "subsurface_radius": 0.2, "subsurface_scatter_anisotropy": 0.5},
            "skin": {"type": "translucent", "base_color": 0.6, "subsurface_scale": 0.1,
                     "subsurface_radius": [1, 0.5, 0.25], "profile": "better_dipole"}},
            objects=[{"shape": "sphere", "radius": 5, "material": "wax"}])
        for name, colors, paths, eta in (("wax", (0.9, 0.5, 0.1), (2, 1, 0.5), 1.5),
                                         ("skin", (0.6, 0.6, 0.6), (1, 0.5, 0.25), 1.4)):
            printed = self.profile("scene.json:" + name, "--radii", "1")
            self.assertEqual(float(printed.head["eta"]), eta)
            absorption = [float(x) for x in printed.head["sigma_a_mm^-1"].split()]
            scattering = [float(x) for x in printed.head["sigma_s_mm^-1"].split()]
            for c in range(3):
                self.assertAlmostEqual(printed.totals()[c], colors[c], delta=1e-6)
                self.assertAlmostEqual(1 / (absorption[c] + scattering[c]), paths[c], delta=1e-12)


class Refused(ProfileTest):
    def refused(self, code, pattern, *arguments):
        result = self.assert_refused(code, pattern, self.render, *arguments)
        self.assertEqual(result.out, "")

    def test_names(self):
        self.refused(USAGE, 'marbel.*did you mean "Marble"', "--profile", "marbel")
        self.refused(USAGE, 'beter_dipole.*"better_dipole"', "--profile", "Marble", "--model",
                     "beter_dipole")
        self.refused(USAGE, 'sigma_b.*"sigma_', "--profile", "sigma_b=1,sigma_s=1")
        scene = self.write_scene()
        self.refused(USAGE, 'ston.*"stone"', "--profile", scene + ":ston")
        self.refused(IO, r"none\.json.*No such file", "--profile", "none.json:stone")
        self.refused(USAGE, "not translucent", "--profile", self.write_scene(
            "paint.json", materials={"stone": {"type": "lambertian", "reflectance": 1}}) + ":stone")

    def test_media_that_are_none(self):
        for text, pattern in (("sigma_a=-1,sigma_s=1", "sigma_a = -1"), ("sigma_a=x,sigma_s=1", '"x"'),
                              ("sigma_a=1", "one way"), ("sigma_a=1,sigma_s=1,color=0.5", "one way"),
                              ("sigma_a=1/2,sigma_s=1", "2 values"), ("g=1,sigma_a=1,sigma_s=1", "g = 1"),
                              ("sigma_a=1,sigma_a=1", "twice"), ("color=1.5,mfp=1", "color = 1.5")):
            with self.subTest(text):
                self.refused(USAGE, pattern, "--profile", text)
        self.refused(BAD_INPUT, "neither absorbs nor scatters", "--profile", "sigma_a=0,sigma_s=0")

    def test_models_that_are_not_defined_for_the_medium(self):
        self.refused(BAD_INPUT, "does not absorb", "--profile", "Spectralon", "--model",
                     "normalized_diffusion_dmfp")
        self.refused(BAD_INPUT, "above .*returns without absorption", "--profile",
                     "color=0.99,mfp=1,eta=3", "--model", "photon_beam_single")
        self.refused(BAD_INPUT, "a slab of 2 mm returns without absorption", "--profile",
                     "color=0.9,mfp=1", "--model", "multipole", "--thickness", "2")
        self.refused(BAD_INPUT, "above 0.959644.*eta 1.3.*single and multiple", "--profile",
                     "color=0.97,mfp=1", "--model", "photon_beam")
        self.refused(BAD_INPUT, "do not reach", "--profile", "color=0.5,mfp=1,eta=3", "--model",
                     "better_dipole", "--boundary", "polynomial")
        self.refused(BAD_INPUT, "mean free path of 5e.199 mm", "--profile",
                     "sigma_a=1e-200,sigma_s=1e-200")
        self.refused(USAGE, "--thickness", "--profile", "Marble", "--model", "multipole")
        self.refused(USAGE, "--thickness", "--profile", "Marble", "--thickness", "1")

    def test_options(self):
        for value in ("-1", "1,,2", "nan", "1;2", "1,inf"):
            self.refused(USAGE, "--radii", "--profile", "Marble", "--radii=" + value)
        self.refused(USAGE, "--boundary.*exact", "--profile", "Marble", "--boundary", "exakt")
        for option in (["--csv"], ["--radii", "1"], ["--json"]):
            self.refused(USAGE, option[0], self.write_scene(), "-o", "out.exr", *option)


class Materials(ProfileTest):
    def test_json(self):
        media = json.loads(self.assert_ok(self.render("--list-materials", "--json")).out)
        self.assertEqual(len(media), 47)
        by_name = {medium["name"]: medium for medium in media}
        marble = by_name["Marble"]
        self.assertEqual(marble["sigmaAPerMm"], [0.0021, 0.0041, 0.0071])
        self.assertEqual(marble["sigmaSPrimePerMm"], [2.19, 2.62, 3.0])
        self.assertEqual(marble["eta"], 1.5)
        self.assertAlmostEqual(marble["dipoleTotal"][1], 0.7911, delta=1e-4)
        self.assertIn("Jensen", marble["paper"])
        self.assertEqual(marble["warnings"], [])
        self.assertIn("reduced albedo", by_name["Ketchup"]["warnings"][0])
        for medium in media:
            self.assertEqual(medium["unit"], "mm^-1")
            for key in ("sigmaAPerMm", "sigmaSPrimePerMm", "reducedAlbedo", "meanFreePathMm"):
                self.assertEqual(len(medium[key]), 3)

    def test_json_agrees_with_the_shared_table(self):
        path = SHARED / "materials.csv"
        if not path.exists():
            self.skipTest("no shared folder")
        media = {medium["name"]: medium for medium in json.loads(
            self.assert_ok(self.render("--list-materials", "--json")).out)}
        with path.open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["name"] for row in rows}, set(media))
        for row in rows:
            for c, channel in enumerate("RGB"):
                self.assertEqual(media[row["name"]]["sigmaAPerMm"][c],
                                 float(row["sigma_a_" + channel]), row["name"])

    def test_table_names_every_medium_and_reason(self):
        out = self.assert_ok(self.render("--list-materials")).out
        media = json.loads(self.assert_ok(self.render("--list-materials", "--json")).out)
        for medium in media:
            self.assertIn(medium["name"], out)
            self.assertIn(medium["paper"], out)
            for warning in medium["warnings"]:
                self.assertIn(warning, out)


class Overrides(ProfileTest):
    def test_the_override_is_an_input_of_the_cache(self):
        scene = self.write_scene()
        self.assert_ok(self.preprocess(scene, "-o", "papers.ssc", "--boundary", "polynomial"))
        self.assert_ok(self.render(scene, "--cache", "papers.ssc", "-o", "out.exr", "--boundary",
                                   "polynomial"))
        self.assert_refused(BAD_INPUT, "papers.ssc.*medium", self.render, scene, "--cache",
                            "papers.ssc", "-o", "other.exr")

    def test_the_model_of_a_whole_scene(self):
        scene = self.write_scene()
        for model, solves in (("shape", True), ("dipole", False)):
            self.assert_ok(self.preprocess(scene, "-o", f"{model}.ssc", "--model", model, "--stats",
                                           "stats.json"))
            body = json.loads((self.folder / "stats.json").read_text())["values"]["bodies"][0]
            self.assertEqual("shape" in body, solves, body)
            # Points and light of a cache for the shape serve its profile too.
            self.assert_ok(self.render(scene, "--cache", f"{model}.ssc", "-o",
                                       f"dipole-from-{model}.exr", "--model", "dipole"))
        self.assert_ok(self.render(scene, "--cache", "shape.ssc", "-o", "shape.exr", "--model",
                                   "shape"))
        for model in ("shape", "better_dipole"):
            self.assert_refused(BAD_INPUT, "dipole.ssc.*run sss-preprocess", self.render, scene,
                                "--cache", "dipole.ssc", "-o", "other.exr", "--model", model)

        def picture(name):
            return (self.folder / f"{name}.exr").read_bytes()
        self.assertNotEqual(picture("shape"), picture("dipole-from-dipole"))
        self.assertEqual(picture("dipole-from-shape"), picture("dipole-from-dipole"))
        for program, out in ((self.render, "x.exr"), (self.preprocess, "x.ssc")):
            for model in ("dipol", "multipole"):
                self.assert_refused(USAGE, f'--model.*"{model}".*"dipole"', program, scene, "-o", out,
                                    "--model", model)


if __name__ == "__main__":
    main()
