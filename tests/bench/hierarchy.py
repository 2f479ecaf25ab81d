"""The sum alone: cost against number of points, and error over time beside the classic way."""

import os
import pathlib

import curves
import programs
from programs import SOURCE

SCENES = {
    "bunny-marble": ("bunny, marble", "scenes/bunny/bunny.json"),
    "bunny-skimmilk": ("bunny, skim milk", "scenes/bench/bunny-skimmilk.json"),
    "ketchup-slab": ("slab, ketchup", "scenes/bench/ketchup-slab.json"),
    "igea-skin": ("Igea, skin", "scenes/bench/igea-skin.json"),
}
# Errors of 99.9 % of the receivers to which times are given.
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
            points = [(entry["error"]["p999"], entry["seconds"]) for entry in method["curve"]]
            method["timeTo"] = {str(target): curves.time_to(points, target) for target in TARGETS}
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
