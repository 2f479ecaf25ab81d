#!/usr/bin/env python3
"""Fails on an include that points the wrong way, or a third-party header outside its file.

Both tables, "who may include whom" and "where each third-party library is hidden", are read from
libsss/README.md, so that the page cannot go stale.

    layering_test.py SOURCE_DIR
"""

import pathlib
import re
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1]).resolve()

# How the headers of each library of the README's table are spelt.
HEADERS = {
    "GLM": r"glm/",
    "fmt": r"fmt/",
    "oneTBB": r"(tbb|oneapi)/",
    "xxHash": r"xxhash",
    "nlohmann-json": r"nlohmann/",
    "Embree": r"embree\d*/",
    "OpenMesh": r"OpenMesh/",
    "FLANN": r"flann/",
    "Highway": r"hwy/",
    "OpenEXR": r"(OpenEXR|Imath)/|((Imf|Iex|Imath)\w*|half)\.h",
    "libpng": r"(libpng\d*/)?png\.h",
    "zlib": r"zlib\.h",
    "CLI11": r"CLI/",
}
# Headers of the C library and of Linux; standard C++ headers have no dot.
SYSTEM = re.compile(r"(sys/\w+|fcntl|unistd|limits|malloc|pthread|sched|signal|stdlib|poll)\.h|"
                    r"[a-z_0-9]+")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
# The programs stand on top of the library and beside each other.
PROGRAMS = ("preprocess", "render")


def table_rows(page, title):
    """The rows, as lists of cells, of the first table under the heading `title`."""
    section = re.search(r"^## " + re.escape(title) + r"\n(.*?)(?=^## |\Z)", page,
                        re.MULTILINE | re.DOTALL)
    if not section:
        raise ValueError(f'libsss/README.md has no section "{title}"')
    lines = [line for line in section.group(1).splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


class Rules:
    def __init__(self, root):
        page = (root / "libsss/README.md").read_text()
        self.allowed = {module: set(below.replace("-", "").split()) for module, below
                        in table_rows(page, "Who may include whom")}
        self.homes = {library: home for library, home, _
                      in table_rows(page, "Where each third-party library is hidden")}

    def may_hold(self, library, file):
        """Whether `file`, as the README spells it ("base/vec.h"), may include the library."""
        homes = [home.strip() for home in self.homes[library].split(",")]
        return file in homes or ("anywhere in .cpp files" in homes and file.endswith(".cpp"))


def library_of(header):
    return next((name for name, spelling in HEADERS.items() if re.match(spelling, header)), None)


def sources(root):
    """(path, module, name in the README's tables) of every source of the library and programs."""
    for folder in ("libsss/sss", *PROGRAMS):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            inside = path.relative_to(root / "libsss/sss" if folder == "libsss/sss" else root)
            yield path, inside.parts[0], inside.as_posix()


def problems(root):
    """One sentence for every include that breaks a rule."""
    rules = Rules(root)
    found = []
    for path, module, name in sources(root):
        if module not in rules.allowed and module not in PROGRAMS:
            found.append(f"{name}: module {module} is missing from libsss/README.md")
            continue
        for quote, header in INCLUDE.findall(path.read_text()):
            problem = check(rules, root, path, module, name, quote, header)
            if problem:
                found.append(f"{path.relative_to(root)}: {problem}")
    return found


def check(rules, root, path, module, name, quote, header):
    """What is wrong with one include, or None."""
    if header.startswith("sss/"):
        target = header.split("/")[1]
        if not (root / "libsss" / header).is_file():
            return f'"{header}" does not exist'
        if module in PROGRAMS or target == module or target in rules.allowed[module]:
            return None
        return f'{module} must not include "{header}"'
    if quote == '"':
        # A program includes its own headers by their names; the library spells the whole path.
        if module in PROGRAMS and (path.parent / header).is_file():
            return None
        return f'"{header}": spell it "sss/MODULE/FILE.h"'
    library = library_of(header)
    if library:
        return None if rules.may_hold(library, name) else f"<{header}>: {library} is hidden in " + \
            rules.homes[library]
    return None if SYSTEM.fullmatch(header) else f"<{header}> belongs to no library of the README"


class Layering(unittest.TestCase):
    def test_every_include_points_down(self):
        self.assertEqual(problems(ROOT), [])

    def test_the_tables_fit_the_tree(self):
        rules = Rules(ROOT)
        modules = {p.name for p in (ROOT / "libsss/sss").iterdir() if p.is_dir()}
        self.assertEqual(set(rules.allowed), modules)
        self.assertEqual(set(rules.homes), set(HEADERS))
        for module, below in rules.allowed.items():
            for other in below:
                self.assertNotIn(module, rules.allowed[other], f"{module} and {other} form a cycle")


class SelfTest(unittest.TestCase):
    """The test finds what it is for: each case plants one violation in a copy of the tables."""

    def planted(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "libsss/sss/base").mkdir(parents=True)
            shutil.copy(ROOT / "libsss/README.md", root / "libsss/README.md")
            for header in ("base/vec.h", "cloud/octree.h", "light/light.h", "geom/bvh.h"):
                path = root / "libsss/sss" / header
                path.parent.mkdir(exist_ok=True)
                path.write_text("")
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
            return problems(root)

    def test_allowed(self):
        for name, text in [("libsss/sss/cloud/a.cpp", '#include "sss/base/vec.h"\n#include <vector>'),
                           ("libsss/sss/cloud/a.cpp", "#include <fmt/core.h>"),
                           ("libsss/sss/base/hash.cpp", "#include <xxhash.h>"),
                           ("libsss/sss/base/a.cpp", "#include <sys/stat.h>"),
                           ("render/main.cpp", '#include "sss/cloud/octree.h"')]:
            self.assertEqual(self.planted(name, text), [], text)

    def test_upward(self):
        self.assertIn("base must not", self.planted("libsss/sss/base/a.h",
                                                    '#include "sss/cloud/octree.h"')[0])

    def test_sideways(self):
        self.assertIn("light must not", self.planted("libsss/sss/light/a.cpp",
                                                     '  #  include "sss/cloud/octree.h"')[0])

    def test_third_party_outside_its_file(self):
        for name, header in [("libsss/sss/cloud/a.cpp", "embree3/rtcore.h"),
                             ("libsss/sss/base/hash.h", "xxhash.h"),
                             ("libsss/sss/cloud/a.h", "fmt/core.h"),
                             ("libsss/sss/geom/a.h", "glm/glm.hpp"),
                             ("libsss/sss/scene/a.cpp", "ImfHeader.h"),
                             ("libsss/sss/app/a.cpp", "CLI/CLI.hpp")]:
            self.assertIn("is hidden in", self.planted(name, f"#include <{header}>")[0], header)

    def test_unknown_library(self):
        self.assertIn("no library", self.planted("libsss/sss/base/a.cpp", "#include <boost/any.hpp>")[0])

    def test_relative_and_missing(self):
        self.assertIn("spell it", self.planted("libsss/sss/base/a.cpp", '#include "vec.h"')[0])
        self.assertIn("does not exist", self.planted("libsss/sss/base/a.cpp",
                                                     '#include "sss/base/none.h"')[0])

    def test_program_beside_program(self):
        self.assertIn("spell it", self.planted("render/main.cpp", '#include "../preprocess/options.h"')[0])

    def test_module_without_a_row(self):
        self.assertIn("missing from", self.planted("libsss/sss/attic/a.h", "")[0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
