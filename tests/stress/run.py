#!/usr/bin/env python3
"""Tries what people should not feed a renderer, and sums up what survived as a table and as JSON.

run.py [--quick | --full] [--out FOLDER]; run.sh builds first. Exit code 0 only if all survived."""

import argparse
import json
import os
import pathlib
import subprocess
import sys

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


def print_row(row):
    print(f"{'ok    ' if row['passed'] else 'FAILED'} {row['subject']:9} {row['name']}: "
          f"{row['cases']} cases {row['worstAt'] if not row['passed'] else ''}", flush=True)


def markdown(rows):
    lines = ["| | subject | what | cases | worst | limit | |", "|---|---|---|---:|---:|---:|---|"]
    for row in rows:
        mark = "survived" if row["passed"] else "**FAILED**"
        where = "" if row["passed"] else row["worstAt"].replace("|", "/").replace("\n", " ")
        lines.append(f"| {mark} | {row['subject']} | {row['name']} | {row['cases']:,} | "
                     f"{row['worst']:.3g} | {row['limit']:g} | {where} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="numbers, meshes and memory in brief")
    parser.add_argument("--full", action="store_true", help="all of README.md; needs the builds of run.sh")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "build/stress")
    options = parser.parse_args()
    full = options.full and not options.quick
    options.out.mkdir(parents=True, exist_ok=True)

    rows = numbers(full, options.out)
    more = [programs.all_rows(full)]
    if full:
        more += [memory_check.all_rows(), fuzzing.all_rows(SOURCE / "build/fuzz/bin", options.out, 60),
                 coverage.all_rows(SOURCE / "build/coverage", options.out)]
    for found in more:
        for row in found:
            rows.append(row.json())
            print_row(rows[-1])
    (options.out / "summary.json").write_text(json.dumps(rows, indent=1) + "\n")
    (options.out / "summary.md").write_text(markdown(rows))
    failed = [row for row in rows if not row["passed"]]
    print(f"{len(rows) - len(failed)} passed, {len(failed)} failed; {options.out / 'summary.md'}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
