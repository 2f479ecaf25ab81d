#!/usr/bin/env python3
"""clang-tidy over the sources of the library and the programs, once per content.

    tidy.py SOURCE_DIR BUILD_DIR

A file that passed is not checked again until it, a project header it includes, its compile command
or .clang-tidy changes: an empty stamp named by the hash of them all stays in BUILD_DIR/tidy.
BUILD_DIR must have been built with Ninja, whose record of the includes is used.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
STAMPS = BUILD / "tidy"


def entries():
    """The compile commands of the sources to check."""
    checked = tuple(f"{ROOT}/{folder}/" for folder in ("libsss", "preprocess", "render"))
    with open(BUILD / "compile_commands.json") as file:
        return [entry for entry in json.load(file) if entry["file"].startswith(checked)]


def project_headers():
    """{object file: project files it was made from}, from Ninja's record."""
    text = subprocess.run(["ninja", "-C", BUILD, "-t", "deps"], check=True, capture_output=True,
                          text=True).stdout
    files, current = {}, None
    for line in text.splitlines():
        if line and not line.startswith(" "):
            current = files.setdefault(line.split(":")[0], [])
        elif line.strip():
            path = (BUILD / line.strip()).resolve()
            if path.is_relative_to(ROOT) and not path.is_relative_to(BUILD):
                current.append(path)
    return files


def key(entry, headers, common):
    """The hash of everything that the verdict depends on."""
    digest = hashlib.sha256(common)
    digest.update(entry["command"].encode())
    output = re.search(r" -o (\S+\.o) ", entry["command"]).group(1)
    if output not in headers:
        sys.exit(f"{output} is not built: build first, so that its includes are known")
    for path in sorted({pathlib.Path(entry["file"]), *headers[output]}):
        digest.update(f"\0{path.relative_to(ROOT)}\0".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def check(entry):
    """(file, what clang-tidy said or "" if it passed)."""
    run = subprocess.run(["clang-tidy", "--quiet", "-p", BUILD, entry["file"]],
                         capture_output=True, text=True)
    return entry["file"], "" if run.returncode == 0 else run.stdout + run.stderr


def main():
    version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True).stdout
    common = version + (ROOT / ".clang-tidy").read_bytes()
    headers = project_headers()
    STAMPS.mkdir(exist_ok=True)
    todo = {}
    everything = entries()
    for entry in everything:
        stamp = STAMPS / key(entry, headers, common)
        if not stamp.exists():
            todo[entry["file"]] = entry, stamp
    failures = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for file, words in pool.map(check, [entry for entry, _ in todo.values()]):
            if words:
                failures += 1
                print(words)
            else:
                todo[file][1].touch()
    print(f"clang-tidy: {len(everything)} files, {len(everything) - len(todo)} unchanged since they "
          f"passed, {failures} with findings")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
