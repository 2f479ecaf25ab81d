# Shared by scenes/demo.sh and tests/run.sh, which source it: the packages and the builds.
# Nothing to do means no output. Needs bash.

SSS_ROOT=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

# To build and to run the demo; the presets build the tests too. Debian 12 names.
SSS_PACKAGES=(
    g++ cmake ninja-build ccache python3 glmark2-data
    libembree-dev libopenmesh-dev libflann-dev liblz4-dev libopenexr-dev libpng-dev zlib1g-dev
    libglm-dev libhwy-dev libtbb-dev libcli11-dev libfmt-dev nlohmann-json3-dev libxxhash-dev
    libgtest-dev libbenchmark-dev
)
# For scenes/demo.sh --animation only.
SSS_VIDEO_PACKAGES=(ffmpeg)
# For tests/run.sh only; the last one draws the charts of the benchmark's quickest run.
SSS_TEST_PACKAGES=(clang-format clang-tidy python3-jsonschema python3-matplotlib)
# For tests/run.sh --full only: a render farm of one machine.
SSS_FARM_PACKAGES=(slurm-wlm)
# For tests/stress/run.sh --full only.
SSS_STRESS_PACKAGES=(clang libclang-rt-14-dev valgrind)
# For tests/bench/run.sh only: its plots.
SSS_BENCH_PACKAGES=(python3-matplotlib)
# ... and with --peer mitsuba: its environment, and a newer LLVM than Debian 12's own for its compiler.
SSS_PEER_PACKAGES=(python3-venv libllvm19)

# Installs what is missing of the packages named.
sss_install() {
    local package missing=() as_root=()
    for package in "$@"; do
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
            missing+=("$package")
    done
    ((${#missing[@]})) || return 0
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            echo "Missing packages, and neither root nor sudo to install them. As root, run:" >&2
            echo "  apt-get update && apt-get install ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    echo "Installing ${as_root[*]:+through ${as_root[*]} }${missing[*]}"
    local log=$SSS_ROOT/build/packages.log
    mkdir -p "$SSS_ROOT/build"
    if ! { "${as_root[@]}" apt-get update &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y --no-install-recommends "${missing[@]}"; } \
        </dev/null >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        echo "Installing packages failed; the whole log is $log" >&2
        return 1
    fi
}

# sss_build PRESET [TARGET...]: configures and builds; build/PRESET.log has the compiler's words.
sss_build() {
    local preset=$1 folder=$SSS_ROOT/build/$1 log=$SSS_ROOT/build/$1.log began=$SECONDS
    shift
    mkdir -p "$folder"
    # Ninja runs CMake again for changes in CMake files, but does not know of the presets.
    if [[ ! -f $folder/build.ninja || ! -f $folder/.configured ||
        $SSS_ROOT/CMakePresets.json -nt $folder/.configured ]]; then
        (cd "$SSS_ROOT" && cmake --preset "$preset") </dev/null >"$log" 2>&1 ||
            sss_build_failed "Configuring $preset" "$log" || return 1
        touch "$folder/.configured"
    fi
    ninja -C "$folder" -n "$@" 2>/dev/null | grep -q 'no work to do' && return 0
    echo "Building $preset (log: $log)"
    ninja -C "$folder" "$@" </dev/null >"$log" 2>&1 ||
        sss_build_failed "Building $preset" "$log" || return 1
    echo "Built $preset in $((SECONDS - began)) s"
}

sss_build_failed() {
    tail -n 40 "$2" >&2
    echo "$1 failed; the whole log is $2" >&2
    return 1
}
