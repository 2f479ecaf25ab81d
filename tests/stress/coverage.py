#!/usr/bin/env python3
"""Share of the library's lines that the tests run, by gcov over a build by the preset "coverage".

coverage.py BUILD OUT"""

import json
import pathlib
import subprocess
import sys

from harness import SOURCE
from programs import Row

LIBRARY = SOURCE / "libsss"
# Where a line was compiled into several objects it counts as run if any of them ran it.
LEAST_SHARE = 0.9


def lines_of(build):
    """{file: {line: times run}} of the library's own sources."""
    files = {}
    notes = sorted(str(path) for path in build.rglob("*.gcda"))
    for first in range(0, len(notes), 20):
        done = subprocess.run(["gcov", "--json-format", "--stdout", *notes[first:first + 20]],
                              cwd=build, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        for text in done.stdout.decode().splitlines():
            for file in json.loads(text)["files"] if text.startswith("{") else ():
                path = (build / file["file"]).resolve()
                if LIBRARY not in path.parents:
                    continue
                counts = files.setdefault(str(path.relative_to(LIBRARY)), {})
                for line in file["lines"]:
                    number = line["line_number"]
                    counts[number] = max(counts.get(number, 0), line["count"])
    return files


def all_rows(build, out):
    files = lines_of(build)
    row = Row("coverage", "share of the library's lines that no test runs", 1 - LEAST_SHARE)
    run = sum(sum(1 for count in counts.values() if count) for counts in files.values())
    row.cases = sum(len(counts) for counts in files.values())
    row.worst = 1 - run / row.cases if row.cases else 1
    few = []
    for name, counts in sorted(files.items()):
        if not counts:
            continue  # a header of which nothing was compiled
        share = sum(1 for count in counts.values() if count) / len(counts)
        missed = [number for number, count in sorted(counts.items()) if not count]
        if share < LEAST_SHARE:
            few.append(f"{100 * share:5.1f} %  {name}  not run: {missed}")
    (out / "coverage.txt").write_text(
        f"{100 * (1 - row.worst):.2f} % of {row.cases} lines in {len(files)} files\n"
        + "".join(line + "\n" for line in few))
    print(f"coverage {100 * (1 - row.worst):.2f} %, {len(few)} files below 90 %: {out / 'coverage.txt'}")
    yield row


def main():
    out = pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    for row in all_rows(pathlib.Path(sys.argv[1]).resolve(), out):
        sys.exit(0 if row.json()["passed"] else 1)


if __name__ == "__main__":
    main()
