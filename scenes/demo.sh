#!/usr/bin/env bash
# One command from a fresh Debian 12 to a picture: installs what is missing, builds, runs both
# passes over the marble bunny and says where the results lie and what each phase cost.
#
# --animation also renders the turntable and the moving light, 24 small frames each, as GIFs.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

packages=("${SSS_PACKAGES[@]}") animation=0
case ${1-} in
    '') ;;
    --animation) animation=1 packages+=("${SSS_VIDEO_PACKAGES[@]}") ;;
    *)
        echo "usage: scenes/demo.sh [--animation]" >&2
        exit 2
        ;;
esac

sss_install "${packages[@]}"
sss_build release preprocess render

cd "$SSS_ROOT"
scene=scenes/bunny/demo.json out=out/demo bin=build/release/bin
mkdir -p "$out"
"$bin/sss-preprocess" "$scene" -o "$out/bunny.ssc" --stats "$out/preprocess.json"
"$bin/sss-render" "$scene" --cache "$out/bunny.ssc" -o "$out/bunny.exr" --stats "$out/render.json"

# Frames of an animation, with a cache of stages; a second run finds them all done.
# frames SCENE LIST OPTION...: out/demo/SCENE.NNNN.png
frames() {
    local name=$1 list=$2
    shift 2
    "$bin/sss-render" "scenes/$name/$name.json" --frames "$list" --cache "$out/$name/" --resume \
        -o "$out/$name.####.exr" "$@"
}

# gif SCENE: of its frames, with the 256 colours that suit them.
gif() {
    ffmpeg -loglevel error -y -framerate 12 -i "$out/$1.%04d.png" \
        -vf "split[a][b];[a]palettegen[p];[b][p]paletteuse" "$out/$1.gif"
    echo "Animation: $out/$1.gif"
}

if ((animation)); then
    frames moving-light 1-24
    frames turntable 1-24 --size 192x192 --samples 4
    gif moving-light
    gif turntable
else
    frames moving-light 1-24x4
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
                    ("frames", "moving-light.0001.png")):
    path = os.path.join(out, name)
    print(f"  {label:<8} {path}  ({os.path.getsize(path) / 1000:.0f} kB)")
PYTHON
