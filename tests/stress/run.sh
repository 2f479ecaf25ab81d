#!/usr/bin/env bash
# Installs what is missing, builds, and tries everything in README.md; the summary is
# build/stress/summary.md and .json. --quick (a minute): numbers, meshes and memory in brief. --full
# adds the large ones, valgrind, ten million inputs by the fuzzers and the coverage of all tests
# (hours). --only PART... runs just those (--list names them), --kept none of them: the summary shows
# the others as they were last measured. --record puts the table into README.md.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../../scenes/setup.sh"

full=0 only=0 wanted=()
for option in "$@"; do
    case $option in
        --quick) full=0 only=0 ;;
        --full) full=1 only=0 ;;
        --only) only=1 ;;
        --record) only=0 ;;
        --kept | --list) only=0 wanted+=("$option") ;;
        *)
            if ((!only)); then
                echo "usage: tests/stress/run.sh [--quick | --full] [--only PART... | --kept | --list]" \
                    "[--record]" >&2
                exit 2
            fi
            wanted+=("$option")
            ;;
    esac
done

# is_wanted PART: whether a full run comes to it.
is_wanted() {
    ((full)) && { ((!${#wanted[@]})) || [[ " ${wanted[*]} " == *" $1 "* ]]; }
}

sss_install "${SSS_PACKAGES[@]}"
sss_build release preprocess render sss_stress
if is_wanted valgrind || is_wanted fuzzing; then
    sss_install "${SSS_STRESS_PACKAGES[@]}"
fi
if is_wanted fuzzing; then
    sss_build fuzz fuzzers
fi
if is_wanted coverage; then
    sss_install "${SSS_TEST_PACKAGES[@]}"
    sss_build coverage
    find "$SSS_ROOT/build/coverage" -name '*.gcda' -delete
    (cd "$SSS_ROOT" && GCOV_ERROR_FILE=/dev/null ctest --test-dir build/coverage -j "$(nproc)" --timeout 1800) \
        </dev/null >"$SSS_ROOT/build/coverage-tests.log" 2>&1 || true  # a row of the table says so
fi
export PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$SSS_ROOT/tests/cli
exec /usr/bin/python3 "$SSS_ROOT/tests/stress/run.py" "$@"
