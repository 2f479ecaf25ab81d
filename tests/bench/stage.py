"""A scene in the size of a part of the benchmark, and its pictures."""

import json

import programs
from programs import BIN


class Stage:
    """Pictures are made once. `part` ("pictures", "models") names folder and size; `change` is what
    the part does to every scene."""

    def __init__(self, name, path, scale, options, part, change=lambda scene: None):
        self.name, self.path, self.scale, self.options = name, path, scale, options
        self.size = scale[f"{part[:-1]}Size"]
        self.change = change
        self.folder = options.out / part / name
        self.scene = self.derived("scene")
        self.made = {}

    def derived(self, name, change=lambda scene: None):
        def sized(scene):
            scene["film"].update(width=self.size, height=self.size, precision="float")
            self.change(scene)
            change(scene)
        return programs.derived_scene(self.path, self.folder / f"{name}.json", sized)

    def render(self, label, scene, samples, seed, *more, again=False):
        """{file, png, cpu, stats, command} of a picture."""
        file = self.folder / f"{label}-{samples}-{seed}.exr"
        if again or file not in self.made:
            stats = file.with_suffix(".stats.json")
            command = [BIN / "sss-render", scene, "-o", file, "--samples", samples, "--seed", seed,
                       "--quiet", *more]
            spent = programs.cost([*command, "--stats", stats])
            self.made[file] = {"file": file, "png": file.with_suffix(".png"), "cpu": spent["cpu"],
                               "stats": json.loads(stats.read_text()),
                               "command": programs.shown(command)}
        return self.made[file]

    def preprocess(self, scene, target, seed):
        """The CPU seconds of pass 1 and what it says of its body."""
        stats = self.folder / f"{target.stem}.stats.json"
        spent = programs.cost([BIN / "sss-preprocess", scene, "-o", target, "--seed", seed,
                               "--quiet", "--stats", stats])
        return spent["cpu"], json.loads(stats.read_text())["values"]["bodies"][0]
