"""The sum alone: cost against number of points, and error over time beside the classic way."""

import math
import os
import pathlib

import programs
from programs import SOURCE

SCENES = {
    "bunny-marble": ("bunny, marble", "scenes/bunny/bunny.json"),
    "bunny-skimmilk": ("bunny, skim milk", "scenes/bench/bunny-skimmilk.json"),
    "ketchup-slab": ("slab, ketchup", "scenes/bench/ketchup-slab.json"),
    "igea-skin": ("Igea, skin", "scenes/bench/igea-skin.json"),
}
# Errors to which times are given.
TARGETS = (0.1, 0.01, 0.001, 0.0001)


def scaling(scale):
    print("scaling", flush=True)
    return {"tolerance": 0.01, "scene": SCENES["bunny-marble"][0],
            **programs.bench("scaling", SOURCE / SCENES["bunny-marble"][1], points=scale["points"],
                             receivers=min(scale["receivers"], 512), rounds=scale["rounds"],
                             tolerances=[0.01])}


def scenes(scale, options):
    print("hierarchy", flush=True)
    measured = []
    for name in scale["scenes"]:
        title, path = SCENES[name]
        path = with_mesh(SOURCE / path, options.out / "scenes" / f"{name}.json")
        if path is None:
            print(f"  {title}: left out, its mesh is neither beside the scene nor in SSS_MESHES")
            continue
        found = programs.bench("hierarchy", path, tolerances=scale["tolerances"],
                               receivers=scale["receivers"], rounds=scale["rounds"],
                               pass_one_tolerance=scale["hierarchyTolerance"])
        for method in found["methods"]:
            method["timeTo"] = {str(target): time_to(method["curve"], target)
                                for target in TARGETS}
        measured.append({"name": name, "title": title, **found})
    return measured


def with_mesh(path, target):
    """The scene with the absolute paths of its meshes; None if one is nowhere."""
    missing = []
    folders = [SOURCE.parent / "shared/meshes"]
    if "SSS_MESHES" in os.environ:
        folders.insert(0, pathlib.Path(os.environ["SSS_MESHES"]))

    def find(scene):
        for item in scene["objects"]:
            if "mesh" not in item:
                continue
            beside = pathlib.Path(item["mesh"])
            there = [place for place in (beside, *(folder / beside.name for folder in folders))
                     if place.exists()]
            if there:
                item["mesh"] = str(there[0].resolve())
            else:
                missing.append(beside)

    made = programs.derived_scene(path, target, find)
    return None if missing else made


def time_to(curve, target):
    """Seconds a receiver until 99.9 % of them are within `target`: straight lines between the
    measured points on a log-log plot; None beyond the smallest error. A curve that is better
    everywhere costs what its cheapest point costs."""
    points = sorted((max(entry["error"]["p999"], 1e-12), entry["seconds"]) for entry in curve)
    if points[0][0] > target:
        return None
    within = [point for point in points if point[0] <= target]
    beyond = [point for point in points if point[0] > target]
    best = min(seconds for _, seconds in within)
    if not beyond:
        return best
    (e0, s0), (e1, s1) = within[-1], beyond[0]
    share = math.log(target / e0) / math.log(e1 / e0)
    return min(best, s0 * (s1 / s0) ** share)
