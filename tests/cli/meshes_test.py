#!/usr/bin/env python3
"""Meshes as people have them render without a crash, with a report of what is wrong with them."""

import json

from harness import SHARED, TETRAHEDRON, CliTest, main
from images import read_png


class Meshes(CliTest):
    def rendered(self, mesh):
        """Renders the mesh at 48 x 48; returns the result after checking the picture."""
        scene = self.write_mesh_scene(mesh, film={"width": 48, "height": 48, "samples": 2,
                                                  "filter": "box"})
        result = self.assert_ok(self.render(scene, "-o", "out.exr", "--stats", "stats.json"))
        width, height, channels, pixels = read_png(self.folder / "out.png")
        self.assertEqual((width, height), (48, 48))
        middle = pixels[(24 * 48 + 24) * channels:][:3]
        self.assertTrue(all(value > 0 for value in middle), f"black at the centre: {middle}")
        stats = json.loads((self.folder / "stats.json").read_text())
        self.assertEqual(stats["counts"]["nan"], 0)
        return result

    def shared(self, name):
        path = SHARED / "meshes" / name
        if not path.exists():
            self.skipTest(f"{path} is not here")
        result = self.rendered(path)
        self.assertRegex(result.err, r"\d+ triangles")
        return result

    def test_suzanne(self):
        self.assertRegex(self.shared("suzanne.obj").err, "open")

    def test_teapot(self):
        self.shared("teapot.obj")

    def test_igea(self):
        self.shared("igea.ply")

    def test_spot(self):
        self.shared("spot.obj")

    def test_closed_is_not_called_open(self):
        result = self.rendered(self.write("good.obj", TETRAHEDRON))
        self.assertEqual(result.lines("WARN"), [])

    def test_what_is_wrong_is_reported(self):
        duplicate = TETRAHEDRON + "f 1 3 2\n"
        for name, text, pattern in (
                ("open.obj", TETRAHEDRON.replace("f 1 4 3\n", ""), "open"),
                ("duplicate.obj", duplicate, "repeats an earlier"),
                ("degenerate.obj", TETRAHEDRON + "f 1 1 2\n", "1 face.*no surface.*left out"),
                ("flipped.obj", TETRAHEDRON.replace("f 1 3 2", "f 1 2 3"), "flip|turned|winding"),
                ("inside-out.obj", "\n".join(
                    "f {0} {2} {1}".format(*line.split()[1:]) if line.startswith("f") else line
                    for line in TETRAHEDRON.splitlines()) + "\n", "flip|turned|inside")):
            with self.subTest(mesh=name):
                result = self.rendered(self.write(name, text))
                self.assertRegex(" ".join(result.lines("WARN")).lower(), pattern)


if __name__ == "__main__":
    main()
