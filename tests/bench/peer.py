"""--peer mitsuba: an independent judge of `volume`. Mitsuba 3 (from PyPI, in a virtual environment
of its own under build/) renders the same scenes with its `volpathmis`."""

import json
import math
import os
import pathlib
import re
import subprocess
import sys

import pictures
import programs
from programs import BIN, SOURCE, BenchError
from truth import mean_and_error

ENVIRONMENT = SOURCE / "build/mitsuba"
PACKAGES = ("mitsuba==3.*", "numpy")
SCRIPT = SOURCE / "tests/bench/mitsuba_render.py"


def measure(scale, options, scenes):
    """Both renderers' mean radiance of every translucent object of the part `pictures`."""
    print("peer: Mitsuba 3", flush=True)
    try:
        python = install()
    except BenchError as error:
        print(f"  left out: {error}")
        return {"label": "Mitsuba 3 volpathmis", "failed": str(error), "scenes": []}
    return {"label": "Mitsuba 3 volpathmis",
            "scenes": [compare(python, scale, options, scene) for scene in scenes]}


def install():
    python = ENVIRONMENT / "bin/python"
    ready = [python, "-c", "import mitsuba, numpy"]
    if not python.exists() or subprocess.run(ready, capture_output=True).returncode != 0:
        for command in ([sys.executable, "-m", "venv", ENVIRONMENT],
                        [ENVIRONMENT / "bin/pip", "install", "--quiet", *PACKAGES]):
            done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
            if done.returncode != 0:
                raise BenchError(f"{programs.shown(command)} ended with {done.returncode}: "
                                 f"{(done.stderr or done.stdout).strip()[-300:]}")
    return python


def environment():
    """Mitsuba's just-in-time compiler wants LLVM 16 at least, and ends the process with an older
    one: it is told of the newest, or left out."""
    found = {}
    for path in pathlib.Path("/usr/lib").glob("*/libLLVM*.so*"):
        version = re.search(r"libLLVM(?:-|\.so\.)(\d+)", path.name)
        if version:
            found[int(version[1])] = path
    newest = max(found, default=0)
    if newest < 16:
        return "scalar_rgb", os.environ
    return "llvm_ad_rgb", os.environ | {"DRJIT_LIBLLVM_PATH": str(found[newest])}


def compare(python, scale, options, scene):
    print(f"  {scene['title']}", flush=True)
    folder = options.out / "pictures" / scene["name"]
    # Unlike in the other pictures the surface reflects: that light cannot be told apart there.
    path = programs.derived_scene(folder / "scene.json", folder / "peer.json", reflecting)
    samples, seeds = scene["truth"]["samples"], scale["volumeSeeds"]
    files, seconds = [], []
    for seed in range(seeds):
        files.append(folder / f"peer-{samples}-{seed}.exr")
        spent = programs.cost([BIN / "sss-render", path, "-o", files[-1], "--quiet", "--no-png",
                               "--integrator", "volume", "--samples", samples,
                               "--seed", pictures.VOLUME_SEEDS + seed])
        seconds.append(spent["cpu"])
    variant, environ = environment()
    request = {"scene": json.loads(path.read_text()), "media": media(path), "samples": samples,
               "seeds": seeds, "variant": variant, "ours": [str(file) for file in files],
               "picture": str(folder / "peer-mitsuba.exr")}
    done = subprocess.run([python, SCRIPT], input=json.dumps(request), capture_output=True,
                          text=True, env=environ)
    if done.returncode != 0:
        raise BenchError(f"{SCRIPT.name} ended with {done.returncode}: {done.stderr[-2000:]}")
    found = json.loads(done.stdout)
    ours = side(found["ours"], seconds, samples)
    theirs = side(found["peer"], found["seconds"], samples)
    difference, sigmas = [], []
    for channel in range(3):
        apart = theirs["mean"][channel] - ours["mean"][channel]
        error = math.hypot(theirs["standardError"][channel], ours["standardError"][channel])
        difference.append(apart / ours["mean"][channel])
        sigmas.append(apart / error if error else 0.0)
    return {"name": scene["name"], "title": scene["title"], "version": found["version"],
            "variant": variant, "pixels": found["pixels"], "ours": ours, "peer": theirs,
            "difference": difference, "sigmas": sigmas}


def reflecting(scene):
    for material in scene["materials"].values():
        material["surfaceReflection"] = True


def media(path):
    """Coefficients of the measured media, by name."""
    done = subprocess.run([BIN / "sss-render", "--list-materials", "--json"], capture_output=True,
                          text=True, check=True)
    wanted = {material["medium"] for material in json.loads(path.read_text())["materials"].values()}
    listed = json.loads(done.stdout)
    return {medium["name"]: medium for medium in listed if medium["name"] in wanted}


def side(means, seconds, samples):
    """Channel means over the seeds, their standard errors, and the CPU time of one picture."""
    channels = [mean_and_error([mean[c] for mean in means]) for c in range(3)]
    return {"samples": samples, "seeds": len(means), "mean": [mean for mean, _ in channels],
            "standardError": [error for _, error in channels],
            "cpu": sum(seconds) / len(seconds)}
