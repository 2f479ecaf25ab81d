"""The whole scene: what a translucent frame costs beside its Lambertian twin, and its error."""

import hashlib
import json
import math
import statistics
import tempfile

import programs
from programs import BIN, SOURCE

BUNNY = SOURCE / "scenes/bunny"
TURNTABLE = SOURCE / "scenes/turntable"


def measure(scale, options):
    print("frame", flush=True)
    scenes = make_scenes(scale, options.out / "scenes")
    programs_run = run_programs(scale, scenes, options.out)
    cache = options.out / "bunny.ssc"
    points = programs_run["preprocess"]["stats"]["values"]["bodies"][0]
    reference = make_reference(scale, scenes["bunny"], points["spacingMm"], options)
    accuracy = programs.bench("frame", scenes["bunny"], cache=cache, reference=reference["file"],
                              receivers=scale["frameReceivers"],
                              irradiance_samples=scale["irradianceSamples"])
    render = programs_run["render"]["stats"]["counts"]
    return {
        "programs": programs_run,
        "turntable": run_turntables(scale, options.out),
        "accuracy": accuracy,
        "exitance": programs.bench("exitance", scenes["bunny"], rounds=scale["runs"]),
        "reference": {key: reference[key] for key in
                      ("points", "spacingMm", "irradianceSamples", "seedsApart")},
        "counts": {
            "points": points["points"],
            "nodes": points["nodes"],
            "sites": render["exitanceSites"],
            "receivers": render["sumReceivers"],
            "interactionsPerReceiver": (render["localInteractions"] + render["nodeInteractions"]
                                        + render["pointInteractions"])
            / max(render["sumReceivers"], 1),
            "lookups": render["diffusionEvaluations"],
        },
    }


def resize(scale, scene):
    if scale["pixels"]:
        scene["film"].update(width=scale["pixels"], height=scale["pixels"])
    if scale["frameTolerance"]:
        scene["quality"]["tolerance"] = scale["frameTolerance"]


def make_scenes(scale, folder):
    """The bunny, seen from elsewhere, from there with all effects, and its Lambertian twin."""
    def smaller(scene):
        resize(scale, scene)

    def moved(scene):
        smaller(scene)
        scene["camera"]["position"] = [35, 12, 125]

    def with_all(scene):
        moved(scene)
        scene["materials"]["marble"].update(surfaceReflection=True, singleScattering=True,
                                            roughness=0.3)

    made = {}
    for name, source, change in (("bunny", "bunny", smaller), ("moved", "bunny", moved),
                                 ("all", "bunny", with_all), ("lambertian", "lambertian", smaller)):
        made[name] = programs.derived_scene(BUNNY / f"{source}.json", folder / f"{name}.json",
                                            change)
    return made


def run_programs(scale, scenes, out):
    """Every program once a round, in turn, so that all see the same disturbances."""
    cache, full_cache, shape_cache = (out / f"{name}.ssc" for name in ("bunny", "all", "shape"))
    on_shape = ["--model", "shape"]
    render = [BIN / "sss-render", "--quiet", "--no-png"]
    commands = {
        "preprocess": ("pass 1", [BIN / "sss-preprocess", scenes["bunny"], "-o", cache, "--quiet"]),
        "render": ("pass 2", [*render, scenes["bunny"], "--cache", cache, "-o", out / "bunny.exr"]),
        "moved": ("further frame, camera moved",
                  [*render, scenes["moved"], "--cache", cache, "-o", out / "moved.exr"]),
        "movedShape": ("further frame, camera moved, diffusion on the shape",
                       [*render, scenes["moved"], "--cache", shape_cache, *on_shape,
                        "-o", out / "moved-shape.exr"]),
        "lambertian": ("Lambertian twin",
                       [*render, scenes["lambertian"], "-o", out / "lambertian.exr"]),
        "all": ("further frame, all effects",
                [*render, scenes["all"], "--cache", full_cache, "-o", out / "all.exr"]),
    }
    programs.cost([BIN / "sss-preprocess", scenes["all"], "-o", full_cache, "--quiet"])
    programs.cost([BIN / "sss-preprocess", scenes["bunny"], *on_shape, "-o", shape_cache, "--quiet"])
    runs = {name: [] for name in commands}
    stats = {}
    for _ in range(scale["runs"]):
        # The first frame of a cache finds no exitance kept, further ones that of the first.
        for kept in (cache, full_cache, shape_cache):
            kept.with_name(kept.name + ".exitance").unlink(missing_ok=True)
        programs.cost([*render, scenes["bunny"], "--cache", shape_cache, *on_shape,
                       "-o", out / "first.exr"])
        programs.cost([*render, scenes["bunny"], "--cache", full_cache, "-o", out / "first.exr"])
        for name, (_, command) in commands.items():
            file = out / f"{name}.stats.json"
            runs[name].append(programs.cost([*command, "--stats", file]))
            found = json.loads(file.read_text())
            # The phases of the run that cost least.
            if runs[name][-1]["cpu"] == min(run["cpu"] for run in runs[name]):
                stats[name] = found
    return {name: {
        "label": label,
        "cpuMin": min(run["cpu"] for run in runs[name]),
        "cpuMedian": statistics.median(run["cpu"] for run in runs[name]),
        "wallMin": min(run["wall"] for run in runs[name]),
        "memory": max(run["memory"] for run in runs[name]),
        "runs": runs[name],
        "stats": stats[name],
    } for name, (label, _) in commands.items()}


def run_turntables(scale, out):
    """CPU seconds of the turntable's frames and of its twin's, in turn; least of the runs of each
    frame. The caches of a run are its own, so that every first frame makes pass 1."""
    frames = {"marble": [], "lambertian": []}
    for run in range(scale["turntableRuns"]):
        for name, source in (("marble", "turntable"), ("lambertian", "lambertian")):
            scene = programs.derived_scene(TURNTABLE / f"{source}.json",
                                           out / f"scenes/turntable-{name}.json",
                                           lambda scene: resize(scale, scene))
            stats = out / f"turntable-{name}.stats.json"
            with tempfile.TemporaryDirectory(dir=out) as folder:
                cache = ["--cache", f"{folder}/cache/"] if name == "marble" else []
                programs.cost([BIN / "sss-render", "--quiet", "--no-png", scene, *cache,
                               "--frames", f"1-{scale['turntableFrames']}",
                               "-o", f"{folder}/####.exr", "--stats", stats])
            found = [frame["cpuSeconds"]
                     for frame in json.loads(stats.read_text())["values"]["frames"]]
            frames[name] = list(map(min, frames[name] or found, found))
    later = {name: statistics.mean(seconds[1:]) for name, seconds in frames.items()}
    return {"cpuSeconds": frames, "later": later,
            "ratio": later["marble"] / later["lambertian"]}


def make_reference(scale, scene, spacing, options):
    """Brute force over a cloud `denser` times as dense at least, its irradiance converged; kept on
    disk. Spacings are rounded down to quarter octaves, so that a slightly changed default finds
    it again."""
    wanted = spacing / math.sqrt(scale["denser"])
    fine = 2 ** (math.floor(4 * math.log2(wanted)) / 4)
    settings = {"spacing": fine, "irradiance_samples": scale["referenceSamples"],
                "receivers": scale["frameReceivers"]}
    content = json.loads(scene.read_text())
    key = hashlib.sha256(json.dumps([content, settings, 1], sort_keys=True).encode())
    file = options.cache / f"reference-{key.hexdigest()[:16]}.json"
    if options.fresh or not file.exists():
        made = programs.bench("reference", scene, **settings)
        file.write_text(json.dumps(made))
    return {**json.loads(file.read_text()), "file": file}
