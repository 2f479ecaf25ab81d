#!/usr/bin/env python3
"""Runs the fuzzers of the readers in turn until they have made so many executions in all, also over
several runs; inputs that they stumble over stay in OUT/found until they are taken away.

fuzzing.py BIN OUT EXECUTIONS, with BIN the folder of a build by the preset "fuzz"."""

import json
import os
import pathlib
import re
import subprocess
import sys
import time

from programs import Row

HERE = pathlib.Path(__file__).resolve().parent
TARGETS = ("scene", "cache", "exitance", "obj", "ply", "off", "stl", "exr")
MESHES = ("obj", "ply", "off", "stl")
# A cache is as large as its points; everything else may be wrong in little.
LONGEST = {"cache": 32768, "exitance": 32768}
EXECUTIONS = 10 ** 7
# What only the report of a finding needs, which can be run once more, is left out.
QUICK = "symbolize=0:malloc_context_size=0:max_malloc_fill_size=0"
# A turn of one reader; what it has found interesting is where its next turn starts. One that is slow,
# with less than half of an equal share so far, has longer ones.
SECONDS_A_TURN, SECONDS_IF_BEHIND = 60, 120
# By the wall: at the lowest priority on a busy machine a second may take a minute.
HANGS_AFTER_SECONDS = 120
MOST_SECONDS = 3 * 3600


def fuzz(target, bin_folder, out, seconds):
    """Executions of one reader; what it stumbles over is left in the folder "found"."""
    kept, found = out / "corpus" / target, out / "found" / target
    kept.mkdir(parents=True, exist_ok=True)
    found.mkdir(parents=True, exist_ok=True)
    command = [str(bin_folder / f"sss-fuzz-{target}"),
               f"-max_total_time={seconds}", f"-timeout={HANGS_AFTER_SECONDS}",
               f"-report_slow_units={HANGS_AFTER_SECONDS}", "-rss_limit_mb=2048",
               "-malloc_limit_mb=600", f"-max_len={LONGEST.get(target, 4096)}",
               "-print_final_stats=1", f"-artifact_prefix={found}/", "-print_funcs=0"]
    if target == "scene" or target in MESHES:
        command.append(f"-dict={HERE / 'fuzz' / ('scene' if target == 'scene' else 'mesh')}.dict")
    environment = {**os.environ, "ASAN_OPTIONS": QUICK, "UBSAN_OPTIONS": "symbolize=0"}
    done = subprocess.run(command + [str(kept), str(HERE / "corpus" / target)], env=environment,
                          stdin=subprocess.DEVNULL, capture_output=True, check=False)
    words = done.stderr.decode(errors="replace")
    (out / f"fuzz-{target}.log").write_text(words)
    count = re.search(r"number_of_executed_units: (\d+)", words)
    return int(count.group(1)) if count else 0


class Tally:
    """Executions of each reader so far, kept in a file so that a run that was stopped goes on."""

    def __init__(self, file, least):
        self.file = file
        self.executions = dict.fromkeys(TARGETS, 0)
        if file.exists():
            self.executions |= json.loads(file.read_text())
        if self.total() >= least:  # a whole run's: this is the next one
            self.executions = dict.fromkeys(TARGETS, 0)

    def total(self):
        return sum(self.executions.values())

    def turn_seconds(self, target):
        behind = self.executions[target] < self.total() / len(TARGETS) / 2
        return SECONDS_IF_BEHIND if behind else SECONDS_A_TURN

    def add(self, target, count):
        self.executions[target] += count
        self.file.write_text(json.dumps(self.executions) + "\n")


def all_rows(bin_folder, out, least=EXECUTIONS):
    tally = Tally(out / "fuzzing-executions.json", least)
    began = time.monotonic()
    while tally.total() < least and time.monotonic() - began < MOST_SECONDS:
        before = tally.total()
        for target in sorted(TARGETS, key=tally.executions.get):
            tally.add(target, fuzz(target, bin_folder, out, tally.turn_seconds(target)))
        print(f"fuzzing: {tally.total():,} executions of {least:,}", flush=True)
        if tally.total() == before:
            break  # not one of them runs
    for target in TARGETS:
        row = Row("fuzzing", f"{target}: no crash, hang, leak or wrong answer")
        findings = sorted((out / "found" / target).iterdir())
        row.cases, row.worst = tally.executions[target], len(findings)
        row.worst_at = ", ".join(str(path) for path in findings)
        yield row
    row = Row("fuzzing", f"all readers: executions that are missing of {least:,}")
    row.cases = tally.total()
    row.worst = max(0, least - row.cases)
    row.worst_at = f"{row.cases} in all"
    yield row


def main():
    bin_folder, out, least = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    failed = False
    for row in all_rows(bin_folder, out, least):
        result = row.json()
        failed |= not result["passed"]
        print(result["name"], result["cases"], "executions", result["worstAt"], flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
