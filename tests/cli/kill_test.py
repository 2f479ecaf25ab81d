#!/usr/bin/env python3
"""Kills at random moments, and full disks: an animation goes on where it stopped, nothing that was
whole is lost, and nothing that is not is taken for whole.

usage: kill_test.py [KILLS]     of each program; 12 unless told otherwise
"""

import fcntl
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time

from harness import BIN, IO, OK, CliTest, main

KILLS = 12


def keys(*pairs):
    return {"keys": [{"frame": f, "value": v} for f, v in pairs]}


class Kills(CliTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write_scene(
            objects=[{"name": "box", "shape": "box", "size": [7, 8, 6], "material": "stone"}],
            lights=[{"type": "environment", "radiance": 0.2},
                    {"type": "point", "intensity": 9,
                     "position": keys((1, [-20, 20, 10]), (4, [20, 20, 10]))}])
        self.assert_ok(self.preprocess(self.scene, "--frames", "1-4", "-o", "good/"))
        started = time.monotonic()
        self.assert_ok(self.render(self.scene, "--frames", "1-4", "--cache", "good/",
                                   "-o", "good.####.exr"))
        self.seconds = time.monotonic() - started
        self.random = random.Random(7)

    def stages(self, folder):
        """What counts as a stage, by name; exitance grows, and is compared by its pictures."""
        return {path.name: path.read_bytes() for path in (self.folder / folder).iterdir()
                if path.suffix in (".ssp", ".ssi")}

    def check_stages(self, folder):
        whole = self.stages("good")
        for name, content in self.stages(folder).items():
            self.assertEqual(content, whole[name], f"{name} is not what it is called")

    def check_pictures(self, prefix, least=0):
        there = sorted(self.folder.glob(f"{prefix}.*.exr")) + sorted(
            self.folder.glob(f"{prefix}.*.png"))
        for path in there:
            good = self.folder / path.name.replace(prefix, "good", 1)
            self.assertEqual(path.read_bytes(), good.read_bytes(), path.name)
        self.assertGreaterEqual(len(there), least)

    def kill(self, number, *command):
        process = subprocess.Popen(list(map(str, command)), cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE)
        time.sleep(self.random.random() * self.seconds * 1.2)
        process.send_signal(number)
        error = process.communicate()[1].decode()
        wanted = {signal.SIGKILL: -9, signal.SIGTERM: 143, signal.SIGINT: 130}[number]
        # Before its first line a program has no handlers: then the signal itself ends it.
        self.assertIn(process.returncode, (OK, wanted, -number), error)
        return process.returncode

    def some_signal(self):
        return self.random.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT))

    def test_preprocess(self):
        for i in range(KILLS):
            if i % 4 == 0:
                shutil.rmtree(self.folder / "c", ignore_errors=True)
            self.kill(self.some_signal(), BIN / "sss-preprocess", self.scene, "--frames", "1-4",
                      "-o", "c/")
            if (self.folder / "c").exists():
                self.check_stages("c")
        self.assert_ok(self.preprocess(self.scene, "--frames", "1-4", "-o", "c/"))
        self.assertEqual(self.stages("c"), self.stages("good"))

    def test_animation(self):
        command = (self.scene, "--frames", "1-4", "--cache", "c/", "-o", "r.####.exr", "--resume")
        for i in range(KILLS):
            if i % 4 == 0:
                shutil.rmtree(self.folder / "c", ignore_errors=True)
                for path in self.folder.glob("r.*"):
                    path.unlink()
            self.kill(self.some_signal(), BIN / "sss-render", *command)
            if (self.folder / "c").exists():
                self.check_stages("c")
            self.check_pictures("r")
        self.assert_ok(self.render(*command, "--stats", "stats.json"))
        self.check_pictures("r", 8)
        self.assert_ok(self.render(*command, "--stats", "stats.json"))
        frames = json.loads((self.folder / "stats.json").read_text())["values"]["frames"]
        self.assertTrue(all(frame["skipped"] for frame in frames))

    def test_temporaries_are_gone_after_a_signal(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            self.kill(number, BIN / "sss-render", self.scene, "--frames", "1-4", "--cache", "t/",
                      "-o", "t.####.exr")
        self.assertEqual([p for p in self.folder.rglob("*.tmp-*")], [])

    def test_what_a_killed_writer_left(self):
        """Goes when the folder is opened next, unless its writer is alive or may be elsewhere."""
        folder = self.folder / "k"
        folder.mkdir()
        young, old, held = (folder / f"points-0.ssp.tmp-{n}-1" for n in (1, 2, 3))
        for path in (young, old, held):
            path.write_bytes(b"half")
        for path in (old, held):
            os.utime(path, (0, 0))
        with held.open("r+b") as file:
            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            self.assert_ok(self.preprocess(self.scene, "-o", "k/"))
        self.assertEqual(sorted(folder.glob("*.tmp-*")), [young, held])
        os.utime(young, (0, 0))
        self.assert_ok(self.render(self.scene, "--cache", "k/", "--cache-only", "-o", "a.exr"))
        self.assertEqual(sorted(folder.glob("*.tmp-*")), [young, held], "looking removes nothing")
        self.assert_ok(self.preprocess(self.scene, "-o", "k/"))
        self.assertEqual(list(folder.glob("*.tmp-*")), [])

    def check_full(self, folder, **limits):
        """Nothing fits: pass 1 fails with a sentence, and leaves no stage; pass 2 does without."""
        result = self.preprocess(self.scene, "--frames", "1-2", "-o", f"{folder}/", **limits)
        self.assertEqual(result.code, IO, str(result))
        self.assertEqual(len(result.lines("ERROR")), 1, str(result))
        self.check_stages(folder)
        self.assertEqual([p for p in (self.folder / folder).glob("*.tmp-*")], [])

    def test_files_that_may_not_grow(self):
        for limit in (0, 1, 4096, 20000):
            self.check_full("full", file_limit=limit)
        self.assert_ok(self.preprocess(self.scene, "--frames", "1-4", "-o", "full/"))
        self.assertEqual(self.stages("full"), self.stages("good"))

    def test_full_disk(self):
        place = self.folder / "disk"
        place.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=192k", "none", str(place)],
                                 capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("may not mount a tmpfs here")
        self.addCleanup(subprocess.run, ["umount", "-l", str(place)], check=True)
        (place / "ballast").write_bytes(b"x" * 150000)
        self.check_full("disk")
        result = self.assert_ok(self.render(self.scene, "--frames", "1-4", "--cache", "disk/",
                                            "-o", "r.####.exr"))
        self.assertIn("not kept", result.err)
        self.check_pictures("r", 8)
        self.check_stages("disk")
        # A picture that does not fit leaves the old one.
        for path in place.iterdir():
            path.unlink()
        shutil.copy(self.folder / "good.0001.exr", place / "p.exr")
        before = (place / "p.exr").read_bytes()
        result = self.render(self.scene, "-o", "disk/p.exr", "--no-png", "--size", "200x200")
        self.assertEqual(result.code, IO, str(result))
        self.assertEqual((place / "p.exr").read_bytes(), before)


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1].isdigit():
        KILLS = int(sys.argv.pop(1))
    main()
