#!/usr/bin/env bash
# Renders the frames of a scene on a Slurm farm: an array of sss-preprocess, which fills one cache that
# all share, and after it an array of sss-render, which may not make pass 1 again; where pass 1 fails it
# is cancelled. Submitting the same again goes on where it stopped.
#
# usage: submit.sh SCENE.json FRAMES OUTDIR
#   FRAMES as Slurm's --array takes them: 1-24, 1-100:2, 1-24%4 (at most 4 at once)
#   OUTDIR is on a disk that all nodes see; the cache is OUTDIR/cache, pictures OUTDIR/NNNN.exr
# SSS_BIN names the folder of the programs [build/release/bin of this source].
set -euo pipefail

if [[ $# -ne 3 ]]; then
    sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0" >&2
    exit 2
fi
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
bin=$(cd -- "${SSS_BIN:-$here/../../build/release/bin}" && pwd)
scene=$(realpath -- "$1") frames=$2
mkdir -p "$3/cache" "$3/log"
out=$(realpath -- "$3")

export SSS_SCENE=$scene SSS_OUT=$out SSS_BIN=$bin
pass1=$(sbatch --parsable --array="$frames" --job-name=sss-pass1 --output="$out/log/pass1-%a.txt" \
    --export=ALL "$here/pass1.sbatch")
pass2=$(sbatch --parsable --array="$frames" --job-name=sss-pass2 --output="$out/log/pass2-%a.txt" \
    --export=ALL --dependency="afterok:${pass1%%;*}" --kill-on-invalid-dep=yes "$here/pass2.sbatch")
echo "pass 1 is job ${pass1%%;*}, pass 2 job ${pass2%%;*}; pictures will be in $out"
