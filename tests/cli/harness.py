"""Runs sss-preprocess and sss-render as processes, for the tests beside this file.

The programs are looked for in the folder SSS_BIN_DIR, or in build/release/bin.
"""

import copy
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SHARED = SOURCE.parent / "shared"
BIN = pathlib.Path(os.environ.get("SSS_BIN_DIR", SOURCE / "build/release/bin"))
TIMEOUT_SECONDS = 300
# Whether the programs run under a sanitizer, several times slower.
SANITIZED = os.environ.get("SSS_SANITIZED") == "1"

# Exit codes, as documented.
OK, INTERNAL, USAGE, BAD_INPUT, IO, RESOURCES, STRICT = range(7)

# Small and quick: a ball of marble, 10 mm across, under a lamp and a sky.
SCENE = {
    "metersPerUnit": 0.001,
    "camera": {"position": [0, 3, 26], "lookAt": [0, 0, 0], "fovDegrees": 28},
    "film": {"width": 24, "height": 16, "samples": 2, "filter": "box"},
    "quality": {"tolerance": 0.1, "bounces": 1},
    "materials": {"stone": {"type": "translucent", "medium": "Marble", "roughness": 0.3}},
    "objects": [{"name": "ball", "shape": "sphere", "radius": 5, "material": "stone"}],
    "lights": [
        {"type": "rectangle", "centre": [-20, 20, 10], "lookAt": [0, 0, 0],
         "width": 10, "height": 10, "radiance": 10},
        {"type": "environment", "radiance": 0.2},
    ],
}

TETRAHEDRON = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


class Result:
    """How a program ended: code, out and err (text)."""

    def __init__(self, command, code, out, err):
        self.command, self.code, self.out, self.err = command, code, out, err

    def lines(self, level):
        return [line for line in self.err.splitlines() if line.startswith(level)]

    def __str__(self):
        return f"{' '.join(map(str, self.command))}\nexit code {self.code}\n{self.out}{self.err}"


class CliTest(unittest.TestCase):
    """A fresh folder a test (self.folder), which is also the working directory of the programs."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="sss-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_program(self, program, *arguments, file_limit=None):
        """Runs to the end. `file_limit`: no file may grow beyond so many bytes, as on a full disk."""
        def limit():
            if file_limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (file_limit, file_limit))
        command = [str(BIN / program), *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, stdin=subprocess.DEVNULL, preexec_fn=limit,
                              capture_output=True, timeout=TIMEOUT_SECONDS)
        return Result(command, done.returncode, done.stdout.decode(), done.stderr.decode())

    def preprocess(self, *arguments, **limits):
        return self.run_program("sss-preprocess", *arguments, **limits)

    def render(self, *arguments, **limits):
        return self.run_program("sss-render", *arguments, **limits)

    def interrupt(self, number, program, *arguments):
        """Starts a program, sends it a signal at its first word, and waits for its end."""
        command = [str(BIN / program), *map(str, arguments)]
        with subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            first = process.stderr.readline()
            process.send_signal(number)
            out, err = process.communicate(timeout=TIMEOUT_SECONDS)
        return Result(command, process.returncode, out.decode(), (first + err).decode())

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def write_scene(self, name="scene.json", **changes):
        """Writes SCENE with top-level keys replaced (None: removed); returns its name."""
        scene = {**copy.deepcopy(SCENE), **changes}
        scene = {key: value for key, value in scene.items() if value is not None}
        return self.write(name, json.dumps(scene, indent=2))

    def write_mesh_scene(self, mesh, **changes):
        """SCENE with the mesh file instead of the ball, 10 mm high."""
        return self.write_scene(objects=[{
            "name": "thing", "mesh": str(mesh), "material": "stone",
            "transform": [{"fit": {"height": 10, "centre": [0, 0, 0]}}]}], **changes)

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def assert_ok(self, result):
        self.assertEqual(result.code, OK, str(result))
        self.assertEqual(result.lines("ERROR"), [], str(result))
        return result

    def assert_refused(self, code, pattern, run, *arguments, **limits):
        """The run ends with `code` and one ERROR line matching `pattern`, and changes no file."""
        before = {name: (self.folder / name).read_bytes() for name in self.files()
                  if (self.folder / name).is_file()}
        names = self.files()
        result = run(*arguments, **limits)
        self.assertEqual(result.code, code, str(result))
        errors = result.lines("ERROR")
        self.assertEqual(len(errors), 1, str(result))
        self.assertRegex(errors[0], re.compile(pattern, re.IGNORECASE), str(result))
        self.assertEqual(result.err.splitlines()[-1], errors[0], str(result))
        self.assertNotIn("terminate called", result.err)
        self.assertEqual(self.files(), names, "files came or went")
        for name, content in before.items():
            self.assertEqual((self.folder / name).read_bytes(), content, f"{name} was changed")
        return result


def main():
    for program in ("sss-preprocess", "sss-render"):
        if not (BIN / program).exists():
            raise SystemExit(f"{BIN / program} is missing: build it, or set SSS_BIN_DIR")
    signal.signal(signal.SIGINT, signal.default_int_handler)
    unittest.main(verbosity=2)
