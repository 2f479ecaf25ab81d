#!/usr/bin/env bash
# Makes the candle's wax, wick and flame, and renders it: out/candle/candle.png.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../setup.sh"

sss_install "${SSS_PACKAGES[@]}"
sss_build release render

cd "$SSS_ROOT"
mkdir -p out/candle
/usr/bin/python3 scenes/candle/make.py
build/release/bin/sss-render scenes/candle/candle.json -o out/candle/candle.exr
echo "Picture: $SSS_ROOT/out/candle/candle.png"
