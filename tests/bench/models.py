"""What the models of diffusion are wrong by: pictures without surface reflection against radiative
transfer (`volume`), all with the same bounces, so that light that enters again is in all of them."""

import math
import time

import hierarchy
import programs
from programs import SOURCE
from stage import Stage
from truth import Truth, mean_and_error

SCENES = {
    "bunny-marble": hierarchy.SCENES["bunny-marble"],
    "bunny-skimmilk": hierarchy.SCENES["bunny-skimmilk"],
    "spot-marble": ("Spot, marble", "scenes/bench/spot-marble.json"),
    "spot-skimmilk": ("Spot, skim milk", "scenes/bench/spot-skimmilk.json"),
    "igea-marble": ("Igea, marble", "scenes/bench/igea-marble.json"),
    "igea-skimmilk": ("Igea, skim milk", "scenes/bench/igea-skimmilk.json"),
    "igea-skin": hierarchy.SCENES["igea-skin"],
    "ketchup-slab": hierarchy.SCENES["ketchup-slab"],
}
# As the renderer shows them: with single scattering, the light shared out consistently.
MODELS = {
    "dipole": "dipole", "better_dipole": "better dipole", "photon_beam": "photon beam diffusion",
    "normalized_diffusion": "normalized diffusion", "tabulated": "half-space by Monte Carlo",
    "shape": "diffusion on the shape",
}
# Every model has two seeds, whose difference is its noise; those of `volume` are others.
MODEL_SEEDS, VOLUME_SEEDS = (1, 2), 11


def measure(scale, options):
    print("models", flush=True)
    measured = []
    for name in scale["modelScenes"]:
        title, path = SCENES[name]
        path = hierarchy.with_mesh(SOURCE / path, options.out / "scenes" / f"{name}.json")
        if path is None:
            print(f"  {title}: left out, its mesh is neither beside the scene nor in SSS_MESHES")
            continue
        began = time.monotonic()
        measured.append(measure_scene(Stage(name, path, scale, options, "models", comparable),
                                      title))
        print(f"  {title}: {time.monotonic() - began:.0f} s", flush=True)
    return measured


def comparable(scene):
    """All of the light but what the surface reflects; five passages and more bring nothing."""
    for material in scene["materials"].values():
        material.update(singleScattering=True, surfaceReflection=False)
    scene["quality"].update(bounces=4)


def measure_scene(stage, title):
    scale = stage.scale
    truth = Truth(stage, VOLUME_SEEDS, scale["modelVolumeSamples"], 2, scale["modelVolumeSeconds"],
                  scale["modelVolumeSeeds"])

    def alone(scene):
        for material in scene["materials"].values():
            material.update(singleScattering=False)
    rows = [("dipole-alone", "dipole, no single scattering", stage.derived("alone", alone),
             ("--model", "dipole"))]
    rows += [(name, MODELS[name], stage.scene, ("--model", name)) for name in scale["models"]]
    found = []
    for name, label, scene, flags in rows:
        pictures = [stage.render(name, scene, scale["modelSamples"], seed, "--tolerance",
                                 scale["modelTolerance"], *flags) for seed in MODEL_SEEDS]
        found.append({"name": name, "label": label, "command": pictures[0]["command"],
                      "seconds": sum(picture["cpu"] for picture in pictures) / len(pictures),
                      **difference([picture["file"] for picture in pictures], truth)})
    return {"name": stage.name, "title": title, "size": stage.size, "truth": truth.describe(),
            "models": found}


def square_and_mean(picture, reference):
    """Mean square difference over the object's pixels, and the means of both there."""
    found = programs.compare(picture, reference)
    mean = found["referenceMean"]
    return (found["relativeRmse"] * mean) ** 2, mean * (1 + found["bias"]), mean


def difference(files, truth):
    """Mean and RMS of (model - truth) over the object's pixels, over the truth's mean, and their
    standard errors by the truth's seeds. The noise of both is taken off the mean square: half of
    what each differs from itself by, from seed to seed."""
    most = truth.samples[-1]
    scale = truth.mean(most, "")
    own_noise = square_and_mean(*files)[0] / 2
    means, squares = [], []
    for picture in truth.pictures(most):
        pairs = [square_and_mean(picture["file"], file) for file in files]
        means.append(sum(model - real for _, real, model in pairs) / len(pairs) / scale)
        squares.append(sum(square for square, _, _ in pairs) / len(pairs))
    count = len(squares)

    def without_noise(left_out=None):
        kept = [square for k, square in enumerate(squares) if k != left_out]
        return (sum(kept) / len(kept) - truth.variance(most, "", left_out) - own_noise) / scale ** 2

    # The spread of what is left without one seed each [Efron's jackknife].
    left = [without_noise(k) for k in range(count)]
    middle = sum(left) / count
    spread = math.sqrt(sum((value - middle) ** 2 for value in left) * (count - 1) / count)
    rms = math.sqrt(max(without_noise(), 0.0))
    mean, mean_error = mean_and_error(means)
    # Of a root; near zero the root of the spread itself.
    return {"mean": mean, "meanStandardError": mean_error, "rms": rms,
            "rmsStandardError": min(spread / (2 * rms), math.sqrt(spread)) if rms else
            math.sqrt(spread)}
