#!/usr/bin/env bash
# One command from a fresh Debian 12 to a picture: installs what is missing, builds, runs both
# passes over the marble bunny and says where the results lie and what each phase cost.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

sss_install "${SSS_PACKAGES[@]}"
sss_build release preprocess render

cd "$SSS_ROOT"
scene=scenes/bunny/demo.json out=out/demo bin=build/release/bin
mkdir -p "$out"
"$bin/sss-preprocess" "$scene" -o "$out/bunny.ssc" --stats "$out/preprocess.json"
"$bin/sss-render" "$scene" --cache "$out/bunny.ssc" -o "$out/bunny.exr" --stats "$out/render.json"

# Six frames of an animation, with a cache of stages; a second run would find them all done.
"$bin/sss-render" scenes/moving-light/moving-light.json --frames 1-24x4 --cache "$out/light/" \
    --resume -o "$out/light.####.exr"
if command -v ffmpeg >/dev/null; then
    ffmpeg -loglevel error -y -framerate 4 -pattern_type glob -i "$out/light.*.png" "$out/light.gif"
fi

/usr/bin/python3 - "$SSS_ROOT/$out" <<'PYTHON'
import json, os, sys

out = sys.argv[1]
print("\nSeconds")
for name in ("preprocess", "render"):
    with open(f"{out}/{name}.json") as file:
        stats = json.load(file)
    for phase, seconds in stats["seconds"].items():
        print(f"  {name:<11} {phase:<20} {seconds:8.2f}")
    print(f"  {name:<11} {'peak memory':<20} {stats['peakMemoryBytes'] / 2**20:8.0f} MiB")
print("Results")
for label, name in (("picture", "bunny.exr"), ("preview", "bunny.png"), ("cache", "bunny.ssc"),
                    ("frames", "light.0001.png")):
    path = os.path.join(out, name)
    print(f"  {label:<8} {path}  ({os.path.getsize(path) / 1000:.0f} kB)")
PYTHON
