#!/usr/bin/env python3
"""Tries what people should not feed a renderer, and sums up what survived as a table and as JSON.

run.py [--quick | --full] [--out FOLDER]; run.sh builds first. Exit code 0 only if all survived."""

import argparse
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import time

import coverage
import fuzzing
import memory_check
import programs
from harness import BIN, SOURCE


def numbers(full, out):
    """The rows of sss-stress, which measures inside the library."""
    file = out / "numbers.json"
    file.unlink(missing_ok=True)
    subprocess.run([str(BIN / "sss-stress"), "--full" if full else "--quick", "--json", str(file)],
                   stdin=subprocess.DEVNULL, check=False)
    if not file.exists():
        return [{"subject": "numbers", "name": "sss-stress ends by itself", "cases": 1, "worst": 1,
                 "limit": 0, "worstAt": "it did not", "passed": False}]
    return json.loads(file.read_text())


def tests_passed(log):
    """What run.sh wrote of the tests of the coverage build: a line that fails is no line run well."""
    row = programs.Row("coverage", "tests that fail in the coverage build")
    found = re.search(r"(\d+) tests failed out of (\d+)",
                      log.read_text(errors="replace") if log.exists() else "")
    row.cases = int(found.group(2)) if found else 0
    row.worst = int(found.group(1)) if found else 1
    row.worst_at = str(log)
    yield row


def print_row(row):
    print(f"{'ok    ' if row['passed'] else 'FAILED'} {row['subject']:9} {row['name']}: "
          f"{row['cases']} cases {row['worstAt'] if not row['passed'] else ''}", flush=True)


def machine():
    """Words on where this was run."""
    names = re.findall(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{names[0].strip() if names else platform.machine()}, {os.cpu_count()} threads"


def markdown(rows, scope):
    survived = sum(1 for row in rows if row["passed"])
    lines = [f"`tests/stress/run.sh {scope}`, {time.strftime('%Y-%m-%d')}, {machine()}: "
             f"{survived} of {len(rows)} survived.", "",
             "| | subject | what | cases | worst | limit | |", "|---|---|---|---:|---:|---:|---|"]
    for row in rows:
        mark = "survived" if row["passed"] else "**FAILED**"
        where = "" if row["passed"] else row["worstAt"].replace("|", "/").replace("\n", " ")
        lines.append(f"| {mark} | {row['subject']} | {row['name']} | {row['cases']:,} | "
                     f"{row['worst']:.3g} | {row['limit']:g} | {where} |")
    return "\n".join(lines) + "\n"


# The table of the last run stands in README.md between these two lines.
BEGIN, END = "<!-- written by run.py --record -->\n", "<!-- end -->\n"


def record(table):
    readme = SOURCE / "tests/stress/README.md"
    before, rest = readme.read_text().split(BEGIN)
    readme.write_text(before + BEGIN + table + END + rest.split(END)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="numbers, meshes and memory in brief")
    parser.add_argument("--full", action="store_true", help="all of README.md; needs the builds of run.sh")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "build/stress")
    parser.add_argument("--record", action="store_true", help="put the table into README.md")
    options = parser.parse_args()
    full = options.full and not options.quick
    options.out.mkdir(parents=True, exist_ok=True)

    rows = numbers(full, options.out)
    more = [programs.all_rows(full)]
    if full:
        more += [memory_check.all_rows(), fuzzing.all_rows(SOURCE / "build/fuzz/bin", options.out),
                 tests_passed(SOURCE / "build/coverage-tests.log"),
                 coverage.all_rows(SOURCE / "build/coverage", options.out)]
    for found in more:
        for row in found:
            rows.append(row.json())
            print_row(rows[-1])
    (options.out / "summary.json").write_text(json.dumps(rows, indent=1) + "\n")
    (options.out / "summary.md").write_text(markdown(rows, "--full" if full else "--quick"))
    if options.record:
        record(markdown(rows, "--full" if full else "--quick"))
    failed = [row for row in rows if not row["passed"]]
    print(f"{len(rows) - len(failed)} passed, {len(failed)} failed; {options.out / 'summary.md'}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
