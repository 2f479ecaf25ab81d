#!/usr/bin/env bash
# Installs what is missing, builds, and runs the benchmark with the options of run.py.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../../scenes/setup.sh"
packages=("${SSS_PACKAGES[@]}" "${SSS_BENCH_PACKAGES[@]}")
[[ " $* " != *" --peer"* ]] || packages+=("${SSS_PEER_PACKAGES[@]}")
sss_install "${packages[@]}"
sss_build release preprocess render sss_bench
PYTHONDONTWRITEBYTECODE=1 exec /usr/bin/python3 "$SSS_ROOT/tests/bench/run.py" "$@"
