"""Radiative transfer (`volume`), what pictures and models are held against."""

import itertools
import math

import programs


class Truth:
    """Pictures of `volume` by some seeds; its means and its noise."""

    def __init__(self, stage, first_seed, samples, step, seconds, seeds):
        """From the fewest of `samples` by factors of `step` to the most, or to as many as all
        `seeds` can have in so many CPU seconds."""
        self.stage, self.first_seed, self.seeds = stage, first_seed, seeds
        self.compared = {}
        fewest, most = samples
        self.samples = [fewest]
        while (step * self.samples[-1] <= most
               and step * self.seconds(self.samples[-1]) * seeds < seconds):
            self.samples.append(step * self.samples[-1])

    def pictures(self, samples):
        """All seeds with the most samples, two with fewer."""
        seeds = self.seeds if samples == self.samples[-1] else 2
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
