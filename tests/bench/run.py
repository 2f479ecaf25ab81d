#!/usr/bin/env python3
"""The benchmark: what translucency costs and what error it has, always side by side.

    run.py [--smoke | --quick | --full] [--only frame,scaling,hierarchy,pictures,models]
           [--out DIR] [--fresh] [--peer mitsuba]

Needs a release build (sss-preprocess, sss-render, sss-bench; SSS_BIN_DIR, or build/release/bin);
run.sh beside this file makes one first. Writes DIR/report.html, DIR/bench.json, CSV tables,
the README's tables as tables.md and, with Debian's python3-matplotlib, charts. README.md beside
this file says what each figure means.
"""

import argparse
import datetime
import json
import os
import pathlib
import sys

import figures
import frame
import hierarchy
import machine
import models
import peer
import pictures
import report
import tables
from programs import BIN, SOURCE, BenchError

SCALES = {
    # Plumbing only: does everything run and write what it should?
    "smoke": {
        "frameTolerance": 0.5, "pixels": 64, "runs": 1, "turntableFrames": 2, "turntableRuns": 1,
        "denser": 2, "irradianceSamples": 32,
        "referenceSamples": 32, "frameReceivers": 128,
        "points": [1e4], "tolerances": [0.1, 0.01], "receivers": 64, "rounds": 1,
        "scenes": ["ketchup-slab"], "hierarchyTolerance": 0.5,
        "pictureScenes": ["ketchup-slab"], "pictureSize": 32, "pictureRuns": 1,
        "pictureTolerances": [0.5, 0.1], "pictureSamples": [2, 8], "pictureDenser": 2,
        "pictureLight": 32, "pictureTruth": 0.05, "pictureReceivers": 128,
        "pictureAngles": [0.1, 0.01], "volumeSamples": [8, 32], "volumeSeconds": 1e9,
        "volumeSeeds": 3,
        "modelScenes": ["ketchup-slab"], "modelSize": 16, "models": ["dipole", "shape"],
        "modelSamples": 8, "modelTolerance": 0.5, "modelVolumeSamples": [32, 64],
        "modelVolumeSeconds": 1e9, "modelVolumeSeeds": 3,
    },
    # Some minutes: rough figures, reference 4 times as dense.
    "quick": {
        "frameTolerance": 0, "pixels": 0, "runs": 3, "turntableFrames": 3, "turntableRuns": 2,
        "denser": 4, "irradianceSamples": 64,
        "referenceSamples": 64, "frameReceivers": 768,
        "points": [1e4, 3e4, 1e5], "tolerances": [0.1, 0.01, 0.001, 0.0001], "receivers": 512,
        "rounds": 2, "scenes": list(hierarchy.SCENES), "hierarchyTolerance": 0.1,
        "pictureScenes": list(hierarchy.SCENES), "pictureSize": 96, "pictureRuns": 1,
        "pictureTolerances": [0.1, 0.03, 0.01], "pictureSamples": [4, 32, 256], "pictureDenser": 3,
        "pictureLight": 48, "pictureTruth": 0.003, "pictureReceivers": 384,
        "pictureAngles": [0.3, 0.1, 0.03, 0.01], "volumeSamples": [4, 16384],
        "volumeSeconds": 24, "volumeSeeds": 4,
        "modelScenes": list(models.SCENES)[:6], "modelSize": 32,
        "models": ["dipole", "better_dipole", "photon_beam", "shape"], "modelSamples": 1024,
        "modelTolerance": 0.03, "modelVolumeSamples": [64, 16384], "modelVolumeSeconds": 90,
        "modelVolumeSeeds": 6,
    },
    # All of it. The reference's many points average their own noise out, so that few light samples
    # are enough: "of the reference" says how well.
    "full": {
        "frameTolerance": 0, "pixels": 0, "runs": 5, "turntableFrames": 24, "turntableRuns": 2,
        "denser": 16, "irradianceSamples": 64,
        "referenceSamples": 24, "frameReceivers": 1024,
        "points": [1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7],
        "tolerances": [0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001], "receivers": 1024,
        "rounds": 3, "scenes": list(hierarchy.SCENES), "hierarchyTolerance": 0,
        "pictureScenes": list(hierarchy.SCENES), "pictureSize": 256, "pictureRuns": 2,
        "pictureTolerances": [0.1, 0.03, 0.01, 0.003], "pictureSamples": [16, 64, 256],
        "pictureDenser": 4, "pictureLight": 48, "pictureTruth": 0.001, "pictureReceivers": 768,
        "pictureAngles": [0.3, 0.1, 0.03, 0.01, 0.003, 0.001], "volumeSamples": [16, 16384],
        "volumeSeconds": 300, "volumeSeeds": 6,
        "modelScenes": list(models.SCENES), "modelSize": 48, "models": list(models.MODELS),
        "modelSamples": 1024, "modelTolerance": 0.01, "modelVolumeSamples": [64, 65536],
        "modelVolumeSeconds": 1500, "modelVolumeSeeds": 8,
    },
}
PARTS = ("frame", "scaling", "hierarchy", "pictures", "models")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for scale in SCALES:
        parser.add_argument(f"--{scale}", dest="scale", action="store_const", const=scale)
    parser.add_argument("--only", help="parts, separated by commas [all, but of --quick without models]")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "out/bench")
    parser.add_argument("--cache", type=pathlib.Path, default=SOURCE / "build/bench-cache",
                        help="where costly references are kept")
    parser.add_argument("--fresh", action="store_true", help="make the references again")
    parser.add_argument("--peer", choices=["mitsuba"], help="install Mitsuba 3 under build/ and "
                        "put its volpathmis beside volume; for --full")
    parser.set_defaults(scale="quick")
    options = parser.parse_args()
    parts = [part for part in PARTS if part != "models" or options.scale != "quick"]
    options.parts = options.only.split(",") if options.only else parts
    for part in options.parts:
        if part not in PARTS:
            parser.error(f'no part "{part}": {", ".join(PARTS)}')
    return options


def main():
    options = arguments()
    for program in ("sss-preprocess", "sss-render", "sss-bench"):
        if not (BIN / program).exists():
            raise BenchError(f"{BIN / program} is missing; run tests/bench/run.sh instead, or name "
                             "the folder in SSS_BIN_DIR")
    options.out.mkdir(parents=True, exist_ok=True)
    options.cache.mkdir(parents=True, exist_ok=True)
    scale = SCALES[options.scale]
    result = {"about": {
        "scale": options.scale,
        "date": datetime.datetime.now().astimezone().isoformat(timespec="minutes"),
        "command": " ".join([os.path.relpath(sys.argv[0], SOURCE), *sys.argv[1:]]),
        **machine.describe(),
    }}
    if "frame" in options.parts:
        result["frame"] = frame.measure(scale, options)
    if "scaling" in options.parts:
        result["scaling"] = hierarchy.scaling(scale)
    if "hierarchy" in options.parts:
        result["scenes"] = hierarchy.scenes(scale, options)
    if "pictures" in options.parts:
        result["pictures"] = pictures.measure(scale, options)
        if options.peer:
            result["peer"] = peer.measure(scale, options, result["pictures"])
    if "models" in options.parts:
        result["models"] = models.measure(scale, options)
    (options.out / "bench.json").write_text(json.dumps(result, indent=1) + "\n")
    tables.write(result, options.out)
    draw(result, options.out)
    (options.out / "tables.md").write_text(figures.markdown(result))
    report.write(result, options.out)
    print(tables.summary(result))
    print(figures.text(result))
    print(f"wrote {options.out}, for reading report.html")


def draw(result, folder):
    try:
        import charts
    except ImportError as error:
        print(f"no plots: {error.name} is missing (apt-get install python3-matplotlib)")
        return
    charts.draw(result, folder)


if __name__ == "__main__":
    try:
        main()
    except BenchError as error:
        sys.exit(f"ERROR {error}")
