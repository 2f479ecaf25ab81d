#!/usr/bin/env python3
"""Tries what people should not feed a renderer, and sums up what survived as a table and as JSON.

run.py [--quick | --full] [--only PART... | --kept | --list] [--record]; run.sh builds first. Parts that
are not run stand in the table as they were last measured. Exit code 0 only if all that was run
survived."""

import argparse
import json
import os
import pathlib
import platform
import re
import sys

from harness import SOURCE
from parts import all_parts, kept_part, run_part

# The table of the last recorded run stands in README.md between these two lines.
BEGIN, END = "<!-- written by run.py --record -->\n", "<!-- end -->\n"


def machine():
    """Words on where this was run."""
    names = re.findall(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{names[0].strip() if names else platform.machine()}, {os.cpu_count()} threads"


def measured_at(part):
    return f"{part['date']}, {part['commit']}"


def table_line(row, at):
    mark = "survived" if row["passed"] else "**FAILED**"
    where = "" if row["passed"] else row["worstAt"].replace("|", "/").replace("\n", " ")
    cells = [mark, row["subject"], row["name"], f"{row['cases']:,}", f"{row['worst']:.3g}",
             f"{row['limit']:g}", where]
    return "| " + " | ".join(cells + ([at] if at else [])) + " |"


def markdown(found, missing, scope):
    """The table of all parts, with when each was measured if that was not at once, and which were not."""
    rows = [(row, part) for part in found for row in part["rows"]]
    survived = sum(1 for row, _ in rows if row["passed"])
    moments = {measured_at(part) for part in found}
    at_once = len(moments) == 1
    minutes = sum(part["seconds"] for part in found) / 60
    when = f"{moments.pop()}, " if at_once else ""
    lines = [f"`tests/stress/run.sh {scope}`, {when}{machine()}, {minutes:.0f} minutes: "
             f"{survived} of {len(rows)} survived.", "",
             "| | subject | what | cases | worst | limit | |" + ("" if at_once else " measured |"),
             "|---|---|---|---:|---:|---:|---|" + ("" if at_once else "---|")]
    lines += [table_line(row, "" if at_once else measured_at(part)) for row, part in rows]
    if missing:
        lines += ["", f"Not measured: {', '.join(missing)}."]
    return "\n".join(lines) + "\n"


def record(table):
    readme = SOURCE / "tests/stress/README.md"
    before, rest = readme.read_text().split(BEGIN)
    readme.write_text(before + BEGIN + table + END + rest.split(END)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="numbers, meshes and memory in brief")
    parser.add_argument("--full", action="store_true", help="all of README.md; needs the builds of run.sh")
    chosen = parser.add_mutually_exclusive_group()
    chosen.add_argument("--only", action="extend", nargs="+", default=[], metavar="PART")
    chosen.add_argument("--kept", action="store_true", help="run nothing: the table of what was measured")
    chosen.add_argument("--list", action="store_true", help="print the names of the parts")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "build/stress")
    parser.add_argument("--record", action="store_true", help="put the table into README.md")
    options = parser.parse_args()
    full = options.full and not options.quick
    scope = "--full" if full else "--quick"
    parts = {name: rows_of for name, (only_full, rows_of) in all_parts().items() if full or not only_full}
    if options.list:
        print("\n".join(parts))
        return
    for name in options.only:
        if name not in parts:
            parser.error(f'no part "{name}" with {scope}; there are {", ".join(parts)}')
    out = (options.out / scope[2:]).resolve()
    out.mkdir(parents=True, exist_ok=True)

    failed = 0
    for name in [] if options.kept else options.only or parts:
        part = run_part(name, parts[name], full, out)
        failed += sum(1 for row in part["rows"] if not row["passed"])
    found = [part for part in (kept_part(name, out) for name in parts) if part]
    missing = [name for name in parts if name not in {part["part"] for part in found}]
    table = markdown(found, missing, scope)
    (options.out / "summary.json").write_text(json.dumps(found, indent=1) + "\n")
    (options.out / "summary.md").write_text(table)
    if missing:
        print(f"not measured yet: {', '.join(missing)}")
    if options.record:
        record(table)
    print(f"{failed} of what was run failed; {options.out / 'summary.md'}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
