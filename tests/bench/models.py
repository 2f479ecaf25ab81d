"""What the profiles are wrong by: whole pictures against radiative transfer (`volume`)."""

import itertools
import math

import programs

# As the renderer shows them: with single scattering, the light shared out consistently.
MODELS = {
    "dipole": "dipole", "better_dipole": "better dipole", "photon_beam": "photon beam diffusion",
    "normalized_diffusion": "normalized diffusion", "tabulated": "half-space by Monte Carlo",
}


class Truth:
    """Pictures of `volume` by some seeds; its means and its noise."""

    def __init__(self, stage, first_seed):
        self.stage, self.first_seed = stage, first_seed
        self.compared = {}
        fewest, most = stage.scale["volumeSamples"]
        self.samples = [fewest]
        # As many as the CPU time allows for all seeds.
        while (4 * self.samples[-1] <= most
               and 4 * self.seconds(self.samples[-1]) * stage.scale["volumeSeeds"]
               < stage.scale["volumeSeconds"]):
            self.samples.append(4 * self.samples[-1])

    def pictures(self, samples):
        """All seeds with the most samples, two with fewer."""
        seeds = self.stage.scale["volumeSeeds"] if samples == self.samples[-1] else 2
        return [self.render(samples, k) for k in range(seeds)]

    def seconds(self, samples):
        return self.render(samples, 0)["cpu"]

    def render(self, samples, k):
        return self.stage.render("volume", self.stage.scene, samples, self.first_seed + k,
                                 "--integrator", "volume")

    def apart(self, samples, layer):
        """{(i, j): mean square difference} and [mean] of the seeds' pictures."""
        if (samples, layer) not in self.compared:
            files = [picture["file"] for picture in self.pictures(samples)]
            squares, means = {}, {}
            for i, j in itertools.combinations(range(len(files)), 2):
                found = programs.compare(files[i], files[j], layer)
                squares[i, j] = (found["relativeRmse"] * found["referenceMean"]) ** 2
                means[j] = found["referenceMean"]
                means[i] = found["referenceMean"] * (1 + found["bias"])
            self.compared[samples, layer] = squares, [means[i] for i in range(len(files))]
        return self.compared[samples, layer]

    def variance(self, samples, layer, without=None):
        """Of a pixel: half of the mean square between two seeds, `without` one of them."""
        squares = [square for pair, square in self.apart(samples, layer)[0].items()
                   if without not in pair]
        return sum(squares) / len(squares) / 2

    def mean(self, samples, layer):
        means = self.apart(samples, layer)[1]
        return sum(means) / len(means)

    def describe(self):
        most = self.samples[-1]
        mean, error = mean_and_error(self.apart(most, "")[1])
        return {"samples": most, "seeds": len(self.pictures(most)), "mean": mean,
                "meanStandardError": error, "seconds": self.seconds(most),
                "command": self.pictures(most)[0]["command"]}


def mean_and_error(values):
    mean = sum(values) / len(values)
    spread = sum((value - mean) ** 2 for value in values) / (len(values) - 1)
    return mean, math.sqrt(spread / len(values))


def measure(stage, truth, reference):
    """Of every model: {mean, rms} difference over the object, over the mean of `volume`."""
    samples = stage.scale["modelSamples"]
    pixel = reference.pixel_variance(samples)
    rows = [("dipole-alone", "dipole, no single scattering", reference.picture(samples))]
    for profile in stage.scale["models"]:
        def with_single(scene, name=profile):
            for material in scene["materials"].values():
                material.update(profile=name, singleScattering=True)
            scene["quality"].update(tolerance=stage.scale["modelTolerance"])
        scene = stage.derived(f"model-{profile}", with_single)
        rows.append((profile, MODELS[profile], stage.render(f"model-{profile}", scene, samples, 1)))
    rows.append(("brdf", "diffuse limit: no spread",
                 stage.render("model-brdf", stage.scene, samples, 1, "--integrator", "brdf")))
    return [{"name": name, "label": label, "command": picture["command"],
             **difference(picture["file"], truth, pixel)} for name, label, picture in rows]


def difference(file, truth, pixel):
    """Mean and RMS of (model - truth) over the object's pixels, over the truth's mean, and their
    standard errors by the truth's seeds. The noise of both is taken off the RMS: the truth's by the
    spread of its seeds, the model's by its pixel sampling."""
    most = truth.samples[-1]
    scale = truth.mean(most, "")
    means, squares = [], []
    for picture in truth.pictures(most):
        found = programs.compare(picture["file"], file)
        means.append(-found["bias"] * found["referenceMean"] / scale)
        squares.append((found["relativeRmse"] * found["referenceMean"] / scale) ** 2)
    count = len(squares)

    def own(without=None):
        kept = [square for k, square in enumerate(squares) if k != without]
        return (sum(kept) / len(kept) - truth.variance(most, "", without) / scale ** 2 - pixel)

    # The spread of what is left without one seed each [Efron's jackknife].
    left = [own(k) for k in range(count)]
    middle = sum(left) / count
    spread = math.sqrt(sum((value - middle) ** 2 for value in left) * (count - 1) / count)
    rms = math.sqrt(max(own(), 0.0))
    mean, mean_error = mean_and_error(means)
    # Of a root; near zero the root of the spread itself.
    return {"mean": mean, "meanStandardError": mean_error, "rms": rms,
            "rmsStandardError": min(spread / (2 * rms), math.sqrt(spread)) if rms else
            math.sqrt(spread)}
