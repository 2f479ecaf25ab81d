#!/usr/bin/env bash
# Every test of the project. Installs what is missing, builds what has changed, runs:
#   release build and all its tests, the benchmark's plumbing among them; clang-format; all tests
#   under the address and undefined-behaviour sanitizers; both programs under the thread sanitizer.
# --quick leaves out all but the first; --full adds every parallel module under the thread
# sanitizer, 200 kills of each program, a Slurm farm on this machine, and clang-tidy. Exit code 0
# only if everything passed.
set -uo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../scenes/setup.sh"

case ${1-} in
    '') scope=default ;;
    --quick | --full) scope=${1#--} ;;
    *)
        echo "usage: tests/run.sh [--quick | --full]" >&2
        exit 2
        ;;
esac

summary=() failed=0

# step NAME COMMAND...: runs a step, notes its seconds and whether it passed.
step() {
    local name=$1 began=$SECONDS verdict=passed
    shift
    echo "== $name"
    "$@" || { verdict=FAILED failed=1; }
    summary+=("$(printf '%-24s %-7s %5d s' "$name" "$verdict" $((SECONDS - began)))")
}

# Prints ctest's last lines; when it fails, also all that is not about a test that passed.
run_ctest() {
    local preset=$1 log=$SSS_ROOT/build/$1-tests.log
    shift
    if (cd "$SSS_ROOT" && ctest --preset "$preset" -j "$(nproc)" "$@") </dev/null >"$log" 2>&1; then
        tail -n 15 "$log"
    else
        grep -vE '^ *Start |\.+ +Passed +[0-9.]+ sec$' "$log"
        return 1
    fi
}

build_and_test() {
    sss_build "$@" && run_ctest "$1"
}

# All but what the thread sanitizer is for.
check_memory() {
    sss_build asan && run_ctest asan -E '^cli\.threads$'
}

# What runs in parallel, in brief: both programs with three threads, and the module that has them.
check_threads() {
    sss_build tsan preprocess render sss_base_test && run_ctest tsan -L threads
}

check_format() {
    (cd "$SSS_ROOT" && find libsss preprocess render tests -name '*.h' -o -name '*.cpp' |
        sort | xargs clang-format --dry-run --Werror)
}

export TSAN_OPTIONS="suppressions=$SSS_ROOT/tests/tsan.supp ${TSAN_OPTIONS-}"

packages=("${SSS_PACKAGES[@]}" "${SSS_TEST_PACKAGES[@]}")
[[ $scope == full ]] && packages+=("${SSS_FARM_PACKAGES[@]}")
sss_install "${packages[@]}" || exit 1
step "release" build_and_test release
if [[ $scope != quick ]]; then
    step "clang-format" check_format
    step "address sanitizer" check_memory
    step "thread sanitizer" check_threads
fi
if [[ $scope == full ]]; then
    step "all parallel modules" build_and_test tsan parallel_tests
    step "200 kills" /usr/bin/python3 "$SSS_ROOT/tests/cli/kill_test.py" 200
    step "farm" /usr/bin/python3 "$SSS_ROOT/tests/cli/farm_test.py"
    step "clang-tidy" /usr/bin/python3 "$SSS_ROOT/tests/tidy.py" "$SSS_ROOT" "$SSS_ROOT/build/release"
fi

echo "== summary"
printf '%s\n' "${summary[@]}"
printf '%-24s %-7s %5d s\n' "all" "$( ((failed)) && echo FAILED || echo passed)" "$SECONDS"
exit "$failed"
