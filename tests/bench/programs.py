"""Runs the programs and says what they cost."""

import json
import os
import pathlib
import subprocess
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("SSS_BIN_DIR", SOURCE / "build/release/bin")).resolve()


class BenchError(Exception):
    """One sentence for the user."""


def cost(command):
    """Runs a command to its end: {cpu, user, system, wall} in seconds, {memory} in bytes."""
    command = [str(part) for part in command]
    with tempfile.TemporaryFile() as errors:
        began = time.monotonic()
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=errors)
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.monotonic() - began
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            errors.seek(0)
            raise BenchError(f"{' '.join(command)} ended with {child.returncode}: "
                             f"{errors.read().decode(errors='replace').strip()}")
    return {"cpu": usage.ru_utime + usage.ru_stime, "user": usage.ru_utime,
            "system": usage.ru_stime, "wall": wall, "memory": usage.ru_maxrss * 1024}


def shown(command):
    """A command as a user types it in the project's folder."""
    return " ".join(os.path.relpath(part, SOURCE) if os.path.isabs(str(part)) else str(part)
                    for part in command)


def bench(subject, *rest, **options):
    """What sss-bench measures: its JSON. Options with underscores for dashes; lists by commas."""
    command = [BIN / "sss-bench", subject, *rest]
    for name, value in options.items():
        text = ",".join(map(repr, value)) if isinstance(value, list) else str(value)
        command += [f"--{name.replace('_', '-')}", text]
    print("  " + shown(command), flush=True)
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise BenchError(f"sss-bench {subject} ended with {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def compare(picture, reference, layer="", mask="A", error_image=None):
    """How far `picture` is from `reference` where the reference's mask is: what sss-render
    --compare says, {relativeRmse, bias, maximum, flip, referenceMean, pixels}."""
    command = [BIN / "sss-render", "--compare", picture, reference, "--json", "--mask", mask]
    if layer:
        command += ["--layer", layer]
    if error_image:
        command += ["--error-image", error_image]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise BenchError(f"comparing {picture} ended with {done.returncode}: {done.stderr.strip()}")
    return {name: value["mean"] if isinstance(value, dict) else value
            for name, value in json.loads(done.stdout).items()}


def derived_scene(path, target, change=lambda scene: None):
    """Copies a scene file, its mesh paths made absolute, after `change` has had its way."""
    scene = json.loads(path.read_text())
    scene.pop("$schema", None)
    for item in scene["objects"]:
        if "mesh" in item:
            item["mesh"] = str((path.parent / item["mesh"]).resolve())
    change(scene)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps(scene, indent=1) + "\n")
    return target
