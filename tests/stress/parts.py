"""The parts of the stress test: each can be run alone, and keeps its rows until it is run again.

A part's rows lie in OUT/SCOPE/PART.json with the commit and date they were measured at, so that a
full run can be made over several evenings."""

import json
import re
import subprocess
import time

import coverage
import fuzzing
import memory_check
import programs
from harness import BIN, SOURCE

FUZZERS, COVERAGE = SOURCE / "build/fuzz/bin", SOURCE / "build/coverage"
COVERAGE_LOG = SOURCE / "build/coverage-tests.log"


def failed_row(subject, name, why):
    return {"subject": subject, "name": name, "cases": 1, "worst": 1, "limit": 0, "worstAt": why,
            "passed": False}


def number_rows(subject, full, out):
    """The rows of one subject of sss-stress, which measures inside the library."""
    file = out / f"sss-stress-{subject}.json"
    file.unlink(missing_ok=True)
    done = subprocess.run([str(BIN / "sss-stress"), "--full" if full else "--quick", "--only", subject,
                           "--json", str(file)], cwd=out, stdin=subprocess.DEVNULL, check=False)
    if not file.exists():
        return [failed_row(subject, "sss-stress ends by itself", f"it ended with {done.returncode}")]
    return json.loads(file.read_text())


def tests_passed(log):
    """What run.sh wrote of the tests of the coverage build: a line that fails is no line run well."""
    row = programs.Row("coverage", "tests that fail in the coverage build")
    found = re.search(r"(\d+) tests failed out of (\d+)",
                      log.read_text(errors="replace") if log.exists() else "")
    row.cases = int(found.group(2)) if found else 0
    row.worst = int(found.group(1)) if found else 1
    row.worst_at = str(log)
    return row


def coverage_rows(out):
    yield tests_passed(COVERAGE_LOG)
    yield from coverage.all_rows(COVERAGE, out)


def python_rows(rows):
    """Rows as JSON, each printed as soon as it is there."""
    found = []
    for row in rows:
        found.append(row.json())
        print(f"{'ok    ' if found[-1]['passed'] else 'FAILED'} {row.subject:9} {row.name}: {row.cases} "
              f"cases {row.worst_at if not found[-1]['passed'] else ''}", flush=True)
    return found


def of_numbers(subject):
    return lambda full, out: number_rows(subject, full, out)


def of_python(rows_of):
    return lambda full, out: python_rows(rows_of(full, out))


def all_parts():
    """{name: (only with --full, function of (full, out) that gives rows)}, in the order of the table."""
    listed = subprocess.run([str(BIN / "sss-stress"), "--list"], stdin=subprocess.DEVNULL,
                            capture_output=True, check=True).stdout.decode().split()
    return {
        **{subject: (False, of_numbers(subject)) for subject in listed},
        "meshes": (False, of_python(lambda full, out: programs.mesh_rows())),
        "limits": (False, of_python(lambda full, out: programs.limit_rows(full))),
        "large-meshes": (True, of_python(lambda full, out: programs.in_a_folder(programs.large_meshes))),
        "ten-million": (True, of_python(lambda full, out: programs.in_a_folder(
            programs.ten_million_points))),
        "valgrind": (True, of_python(lambda full, out: memory_check.all_rows())),
        "fuzzing": (True, of_python(lambda full, out: fuzzing.all_rows(FUZZERS, out))),
        "coverage": (True, of_python(lambda full, out: coverage_rows(out))),
    }


def git(*arguments):
    done = subprocess.run(["git", *arguments], cwd=SOURCE, stdin=subprocess.DEVNULL,
                          capture_output=True, check=False)
    return done.stdout.decode().strip() if done.returncode == 0 else ""


def commit():
    """The commit that is checked out, with a "+" if files differ from it."""
    return (git("rev-parse", "--short=9", "HEAD") + ("+" if git("status", "--porcelain", "-uno") else "")
            or "no commit")


def run_part(name, rows_of, full, out):
    """Runs a part and keeps what it finds; returns that."""
    at, began = commit(), time.monotonic()
    rows = rows_of(full, out)
    part = {"part": name, "commit": at, "date": time.strftime("%Y-%m-%d"),
            "seconds": round(time.monotonic() - began), "rows": rows}
    (out / f"{name}.json").write_text(json.dumps(part, indent=1) + "\n")
    return part


def kept_part(name, out):
    """What a former run of the part has kept, or None."""
    file = out / f"{name}.json"
    return json.loads(file.read_text()) if file.exists() else None
