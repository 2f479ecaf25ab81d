"""Whole pictures: every method's error over CPU time.

Pictures of one seed and number of samples share their camera rays, whatever the integrator (but
`volume`): what differs between them is the method. README.md says what each figure means.
"""

import hashlib
import json
import math
import time

import curves
import hierarchy
import programs
from programs import BIN, SOURCE
from stage import Stage
from truth import Truth

TARGETS = (0.02, 0.01)
LAYER = "diffusion"
# Methods and their references share camera rays, so that they have one seed; `volume`, whose error
# is its spread, has its own from here on.
SEED, VOLUME_SEEDS = 1, 11


def measure(scale, options):
    print("pictures", flush=True)
    measured = []
    for name in scale["pictureScenes"]:
        title, path = hierarchy.SCENES[name]
        path = hierarchy.with_mesh(SOURCE / path, options.out / "scenes" / f"{name}.json")
        if path is None:
            print(f"  {title}: left out, its mesh is neither beside the scene nor in SSS_MESHES")
            continue
        began = time.monotonic()
        measured.append(measure_scene(Stage(name, path, scale, options, "pictures"), title))
        print(f"  {title}: {time.monotonic() - began:.0f} s", flush=True)
    return measured


class Reference:
    """The planar model converged: dense points, well lit, at a tolerance far below what is
    measured. The cache is kept on disk."""

    def __init__(self, stage, spacing):
        self.stage, scale = stage, stage.scale
        # Rounded down to quarter octaves, so that a slightly changed default finds it again.
        wanted = spacing / math.sqrt(scale["pictureDenser"])
        self.quality = {"spacingMm": 2 ** (math.floor(4 * math.log2(wanted)) / 4),
                        "irradianceSamples": scale["pictureLight"],
                        "tolerance": scale["pictureTruth"], "seed": SEED}
        self.scene = stage.derived("reference", lambda s: s["quality"].update(self.quality))
        content = json.loads(self.scene.read_text())
        for key in ("film", "camera"):
            content.pop(key)
        key = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]
        self.cache = stage.options.cache / f"pictures-{key}.ssc"
        if stage.options.fresh or not self.cache.exists():
            programs.cost([BIN / "sss-preprocess", self.scene, "-o", self.cache, "--quiet"])

    def picture(self, samples):
        return self.stage.render("reference", self.scene, samples, SEED, "--cache", self.cache)

    def pixel_variance(self, samples):
        """Of what the camera rays alone do to a pixel, over the mean squared: against the picture
        with the most samples. Of that one and beyond, by the number of samples."""
        *_, second, most = self.stage.scale["pictureSamples"]

        def square(n):
            return programs.compare(self.picture(n)["file"], self.picture(most)["file"],
                                    LAYER)["relativeRmse"] ** 2
        own = square(second) * second / most
        return own * most / samples if samples >= most else square(samples) + own


def measure_scene(stage, title):
    scale = stage.scale
    runs = [cached_run(stage, tolerance) for tolerance in scale["pictureTolerances"]]
    finest = runs[-1]
    reference = Reference(stage, finest["body"]["spacingMm"])
    truth = Truth(stage, VOLUME_SEEDS, scale["volumeSamples"], 4, scale["volumeSeconds"],
                  scale["volumeSeeds"])
    methods = [cached(stage, runs, reference), *classic(stage, runs, reference),
               bssrdf(stage, reference), volume(truth, reference)]
    for method in methods:
        points = [(entry["error"], entry["seconds"]) for entry in method["curve"]]
        method["timeTo"] = {}
        for target in TARGETS:
            seconds, beyond = (curves.time_with_noise(points, target) if method["noise"]
                               else (curves.time_to(points, target), False))
            method["timeTo"][str(target)] = {"seconds": seconds, "extrapolated": beyond}
    return {
        "name": stage.name, "title": title, "size": scale["pictureSize"],
        "pixels": methods[0]["curve"][0]["pixels"],
        "reference": {**reference.quality, "pixelNoise": {
            str(n): math.sqrt(reference.pixel_variance(n)) for n in scale["pictureSamples"]}},
        "methods": methods,
        "truth": truth.describe(),
        "sideBySide": side_by_side(stage, methods, reference),
    }


def entry(setting, seconds, found, picture):
    """A point of a curve."""
    return {"setting": setting, "seconds": seconds, "error": found["relativeRmse"],
            "bias": found["bias"], "maximum": found["maximum"], "flip": found["flip"],
            "pixels": found["pixels"], "file": picture["file"].name, "command": picture["command"]}


def cached_run(stage, tolerance):
    """Both passes at a tolerance, the cheapest of some runs."""
    scene = stage.derived(f"tolerance-{tolerance}",
                          lambda s: s["quality"].update(tolerance=tolerance, seed=SEED))
    cache = stage.folder / f"tolerance-{tolerance}.ssc"
    samples = stage.scale["pictureSamples"][0]
    best = None
    for _ in range(stage.scale["pictureRuns"]):
        first, body = stage.preprocess(scene, cache, SEED)
        picture = stage.render(f"cached-{tolerance}", scene, samples, SEED, "--cache", cache,
                               again=True)
        if best is None or first + picture["cpu"] < best["first"] + best["picture"]["cpu"]:
            best = {"tolerance": tolerance, "scene": scene, "cache": cache, "body": body,
                    "first": first, "picture": picture}
    return best


def cached(stage, runs, reference):
    expected = reference.picture(stage.scale["pictureSamples"][0])["file"]
    curve = []
    for run in runs:
        found = programs.compare(run["picture"]["file"], expected, LAYER)
        curve.append({**entry(run["tolerance"], run["first"] + run["picture"]["cpu"], found,
                              run["picture"]),
                      "firstPass": run["first"], "secondPass": run["picture"]["cpu"],
                      "points": run["body"]["points"]})
    return {"name": "cached", "label": "cached, both passes", "setting": "tolerance",
            "noise": False, "samples": stage.scale["pictureSamples"][0], "curve": curve}


def classic(stage, runs, reference):
    """Brute force and the classic octree, one sum a camera sample as the peers do it: pass 1 and
    the rays as they are, sums at some hundred of the places seen. Of the octree, over every cloud
    and by every solid angle, what nothing beats in time and error."""
    samples = stage.scale["pictureSamples"][0]
    rays = stage.render("rays", stage.scene, samples, SEED, "--integrator", "brdf")["cpu"]
    brute, angles = [], []
    for run in runs:
        found = programs.bench(
            "picture", run["scene"], cache=run["cache"], truth_scene=reference.scene,
            truth_cache=reference.cache, receivers=stage.scale["pictureReceivers"], rounds=1,
            tolerances=stage.scale["pictureAngles"])
        by_name = {method["name"]: method["curve"] for method in found["methods"]}
        sums = run["picture"]["stats"]["counts"]["diffusionEvaluations"]

        def point(measured, setting, run=run, sums=sums):
            return {"setting": setting, "cloud": run["tolerance"],
                    "seconds": run["first"] + rays + sums * measured["seconds"],
                    "error": measured["error"]["rmsOfMean"],
                    "bias": measured["error"]["biasOfMean"],
                    "secondsPerSum": measured["seconds"], "sums": sums}

        brute.append(point(by_name["brute-force"][0], run["tolerance"]))
        angles += [point(measured, measured["setting"]) for measured in by_name["solid-angle"]]
    common = {"noise": False, "samples": samples}
    return [
        {"name": "solid-angle", "label": "classic octree, solid angle", "setting": "solid angle",
         **common, "curve": unbeaten(angles)},
        {"name": "brute-force", "label": "sum over all points", "setting": "points' tolerance",
         **common, "curve": brute},
    ]


def unbeaten(points):
    """Those that take less time than all that err less, by rising time."""
    kept = []
    for point in sorted(points, key=lambda point: point["seconds"]):
        if not kept or point["error"] < kept[-1]["error"]:
            kept.append(point)
    return kept


def bssrdf(stage, reference):
    curve = []
    for samples in stage.scale["pictureSamples"]:
        picture = stage.render("bssrdf", stage.scene, samples, SEED, "--integrator", "bssrdf")
        found = programs.compare(picture["file"], reference.picture(samples)["file"], LAYER)
        curve.append(entry(samples, picture["cpu"], found, picture))
    return {"name": "bssrdf", "label": "bssrdf, by samples", "setting": "samples",
            "noise": True, "curve": curve}


def volume(truth, reference):
    """Its error is its spread over seeds, less what the camera rays alone make of it."""
    curve = []
    for samples in truth.samples:
        total = truth.variance(samples, LAYER) / truth.mean(samples, LAYER) ** 2
        pixel = reference.pixel_variance(samples)
        picture = truth.pictures(samples)[0]
        curve.append({"setting": samples, "seconds": truth.seconds(samples),
                      "error": math.sqrt(max(0.0, total - pixel)),
                      "withPixelNoise": math.sqrt(total), "file": picture["file"].name,
                      "command": picture["command"]})
    return {"name": "volume", "label": "volume, by samples", "setting": "samples",
            "noise": True, "curve": curve}


NOTES = {
    "cached": "Both with the same {samples} camera samples a pixel.",
    "bssrdf": "Both with the same {samples} camera samples a pixel.",
    "volume": "Here the reference is the dipole's, converged: noise and the model's error.",
}


def side_by_side(stage, methods, reference):
    """[{label, picture, reference, errorImage}]: of each method its best picture."""
    shown = []
    for method in methods:
        best = method["curve"][-1]
        if "file" not in best:
            continue
        samples = method.get("samples", best["setting"])
        most = max(stage.scale["pictureSamples"])
        expected = reference.picture(samples if method["name"] != "volume" else most)
        file = stage.folder / best["file"]
        errors = file.with_suffix(".error.png")
        programs.compare(file, expected["file"], LAYER, error_image=errors)
        shown.append({"name": method["name"], "label": method["label"],
                      "setting": f"{method['setting']} {best['setting']:g}",
                      "error": best["error"], "seconds": best["seconds"],
                      "note": NOTES[method["name"]].format(samples=samples),
                      "picture": place(stage, file.with_suffix(".png")),
                      "reference": place(stage, expected["png"]),
                      "errorImage": place(stage, errors)})
    return shown


def place(stage, path):
    return str(path.relative_to(stage.options.out))
