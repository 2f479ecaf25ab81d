"""What the two programs make of hard meshes and too little memory, as rows of a report."""

import itertools
import json
import math
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))

from hard_meshes import BOX, BOX_RENDERS, CORNERS, FACES, HARD_MESHES, REFUSED, grid, obj
from harness import BIN, SHARED
from images import exr_header, read_exr_values, write_even_exr

BAD_INPUT, RESOURCES = 3, 5
TIMEOUT_SECONDS = 900
# Under a white sky nothing is brighter than the sky, but for what the tolerance lets diffusion add.
SKY, TOLERANCE = 1, 0.2


class Row:
    """As numbers/report.h: how far the worst of the cases was off, against what it may be."""

    def __init__(self, subject, name, limit=0):
        self.subject, self.name, self.limit = subject, name, limit
        self.cases, self.worst, self.worst_at = 0, 0, ""

    def add(self, figure, where=""):
        self.cases += 1
        if figure > self.worst:
            self.worst, self.worst_at = figure, where

    def expect(self, complaint):
        """`complaint` is empty if all is well."""
        self.add(1 if complaint else 0, complaint)

    def json(self):
        return {"subject": self.subject, "name": self.name, "cases": self.cases,
                "worst": min(self.worst, 1e300), "limit": self.limit, "worstAt": self.worst_at,
                "passed": self.cases > 0 and self.worst <= self.limit}


def run_measured(folder, program, *arguments):
    """(exit code, standard error, peak bytes of memory) of a program."""
    with tempfile.TemporaryFile() as words:
        process = subprocess.Popen([str(BIN / program), *map(str, arguments)], cwd=folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=words)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        words.seek(0)
        return process.returncode, words.read().decode(errors="replace"), 1024 * usage.ru_maxrss


def run(folder, program, *arguments, address_space=None):
    """(exit code, standard error) of a program; `address_space`: bytes it may map."""
    def limit():
        if address_space is not None:
            resource.setrlimit(resource.RLIMIT_AS, (address_space, address_space))
    done = subprocess.run([str(BIN / program), *map(str, arguments)], cwd=folder, preexec_fn=limit,
                          stdin=subprocess.DEVNULL, capture_output=True, timeout=TIMEOUT_SECONDS)
    return done.returncode, done.stderr.decode(errors="replace")


def scene(objects, spacing=None, sky=None, **more):
    light = {"type": "environment", "map": sky} if sky else {"type": "environment", "radiance": SKY}
    quality = {"tolerance": TOLERANCE, "bounces": 0, "irradianceSamples": 4}
    if spacing:
        quality["spacingMm"] = spacing
    return json.dumps({
        "metersPerUnit": 0.001,
        "camera": {"position": [11, 9, 33], "lookAt": [0, 0, 0], "fovDegrees": 40},
        # As many samples as keep the chance of single scattering through a fin within the tolerance.
        "film": {"width": 12, "height": 12, "samples": 16, "filter": "box"},
        "quality": quality,
        "materials": {"stone": {"type": "translucent", "medium": "Marble"}},
        "objects": objects, "lights": [light], **more})


def mesh_object(file="mesh.obj", height=10, **more):
    return {"name": "thing", "mesh": str(file), "material": "stone",
            "transform": [{"fit": {"height": height, "centre": [0, 0, 0]}}], **more}


def complaint_of_refusal(code, words, pattern):
    """Empty if a run ended with one sentence, and one of the documented codes."""
    errors = [line for line in words.splitlines() if line.startswith("ERROR")]
    if code not in (BAD_INPUT, RESOURCES):
        return f"exit code {code}: {words[-300:]}"
    if len(errors) != 1 or not re.search(pattern, errors[0]):
        return f"not said clearly: {words[-300:]}"
    return ""


def whole(sentence):
    """The pattern of an ERROR line that says this and nothing else; NUMBER stands for the machine's own."""
    return rf"^ERROR +[0-9.]+s sss-\w+ {re.escape(sentence)}$".replace("NUMBER", "[0-9.e+]+")


def picture(folder):
    """(empty if the cache of scene.json renders to something within its bounds, its values of R, G, B)."""
    code, words = run(folder, "sss-render", "scene.json", "--cache", "a.ssc", "-o", "a.exr",
                      "--stats", "stats.json", "--no-keep")
    if code != 0:
        return f"sss-render ended with {code}: {words[-300:]}", []
    counts = json.loads((folder / "stats.json").read_text())["counts"]
    if counts["nan"]:
        return f"{counts['nan']} samples were not finite", []
    layers = read_exr_values(folder / "a.exr")
    values = layers["R"] + layers["G"] + layers["B"]
    if not 0 <= min(values) <= max(values) <= SKY + TOLERANCE or sum(values) > SKY * len(values):
        return f"values from {min(values)} to {max(values)}, {sum(values) / len(values)} on average", []
    return "", values


def farthest(one, other):
    return max(abs(a - b) for a, b in zip(one, other, strict=True))


def complaint_of_mesh(folder, text, outcome, pattern, of_box):
    """Empty if what should come of a mesh does; `of_box`: the values of the box's picture, or empty before
    there are any, and then they are put there."""
    (folder / "mesh.obj").write_text(text)
    (folder / "scene.json").write_text(scene([mesh_object()]))
    (folder / "a.ssc").unlink(missing_ok=True)
    code, words = run(folder, "sss-preprocess", "scene.json", "-o", "a.ssc")
    if outcome == REFUSED:
        left = "; a file was left" if (folder / "a.ssc").exists() else ""
        return complaint_of_refusal(code, words, whole(pattern)) + left
    if code != 0:
        return f"sss-preprocess ended with {code}: {words[-300:]}"
    if not re.search(pattern, words, re.IGNORECASE):
        return f"nothing said of it: {words[-300:]}"
    complaint, values = picture(folder)
    if complaint or outcome != BOX_RENDERS:
        return complaint
    of_box[:] = of_box or values
    far = farthest(values, of_box)
    return f"up to {far} from the box" if far > SAME_PICTURE else ""


# A few units in the last place of half floats.
SAME_PICTURE = 4e-3


def hard_meshes(folder):
    row = Row("meshes", "hard meshes: within bounds, as the box where they are it, or refused in its words")
    of_box = []
    for name, (text, outcome, pattern) in HARD_MESHES.items():
        complaint = complaint_of_mesh(folder, text, outcome, pattern, of_box)
        row.expect(complaint and f"{name}: {complaint}")
    yield row


def touching_bodies(folder):
    """Two boxes that share a face: as one body they are the box without that face, and as two no light
    crosses it, so that they are darker there."""
    row = Row("meshes", "two touching bodies: in one group as one box, in two darker at the seam")
    (folder / "half.obj").write_text(obj(*BOX))
    (folder / "both.obj").write_text(obj([(2 * x, y, z) for x, y, z in CORNERS], FACES))
    values = {}
    for name, mesh, places, more in (("one box", "both", (-10,), {}),
                                     ("one group", "half", (-10, 0), {"group": "g"}),
                                     ("two bodies", "half", (-10, 0), {})):
        objects = [{"name": f"part {i}", "mesh": f"{mesh}.obj", "material": "stone",
                    "transform": [{"translate": [place, -5, -5]}], **more}
                   for i, place in enumerate(places)]
        (folder / "scene.json").write_text(scene(objects))
        code, words = run(folder, "sss-preprocess", "scene.json", "-o", "a.ssc")
        complaint, values[name] = (f"ended with {code}: {words[-300:]}", []) if code else picture(folder)
        row.expect(complaint and f"{name}: {complaint}")
    if all(values.values()):
        far = farthest(values["one group"], values["one box"])
        row.expect(f"a group is up to {far} from one box" if far > TOLERANCE / 2 else "")
        brighter = max(two - one for one, two in zip(values["one group"], values["two bodies"]))
        darker = sum(values["two bodies"]) / sum(values["one group"])
        row.expect("" if brighter <= TOLERANCE / 2 and 0.9 < darker < 1 else
                   f"two bodies are up to {brighter} brighter, {darker} times as bright on average")
    yield row


def is_sanitized():
    """Sanitizers map terabytes: nothing can be learnt from limits of the address space."""
    return b"__asan_init" in (BIN / "sss-preprocess").read_bytes()


def limited_row(subject, name):
    """(row, whether it can be tried): under a sanitizer it says that it was not."""
    if is_sanitized():
        row = Row(subject, name + " (not tried: a sanitizer's build)")
        row.expect("")
        return row, False
    return Row(subject, name), True


def least_address_space():
    """What the programs take to start, with their shared libraries."""
    least = 32 << 20
    while run(".", "sss-preprocess", "--version", address_space=least)[0] != 0:
        least += 4 << 20
    return least


def too_little_memory(folder, steps):
    """Pass 1 under ever less address space: it ends with the code for it, and the old cache stays."""
    row, can_be_tried = limited_row(
        "memory", "sss-preprocess with too little address space: exit 5, old cache whole")
    if not can_be_tried:
        yield row
        return
    (folder / "mesh.obj").write_text(obj(*BOX))
    write_even_exr(folder / "sky.exr", 2048, 1024)
    least = least_address_space()
    for name, text in (("many points", scene([mesh_object()], spacing=0.05)),
                       ("a large sky", scene([mesh_object()], spacing=2, sky="sky.exr"))):
        (folder / "scene.json").write_text(text)
        (folder / "a.ssc").unlink(missing_ok=True)
        code, words = run(folder, "sss-preprocess", "scene.json", "-o", "a.ssc",
                          address_space=3 << 30)
        row.expect(f"{name}, 3 GiB: exit code {code}, {words[-300:]}" if code else "")
        before = sorted(folder.iterdir())
        (folder / "a.ssc").write_bytes(b"old")
        for step in range(steps):
            limit = least + step * (250 << 20) // steps
            code, words = run(folder, "sss-preprocess", "scene.json", "-o", "a.ssc",
                              address_space=limit)
            is_old = (folder / "a.ssc").read_bytes() == b"old"
            refusal = complaint_of_refusal(code, words, "out of memory while|out of memory; use|would need")
            fine = (code == RESOURCES and is_old and not refusal) or (code == 0 and not is_old)
            row.expect("" if fine and sorted(folder.iterdir()) == before
                       else f"{name}, {limit >> 20} MiB: exit code {code}, {words[-300:]}")
            (folder / "a.ssc").write_bytes(b"old")
    yield row


def write_empty(path, size, start=b""):
    """A file of `size` bytes that take no room on the disk."""
    with open(path, "wb") as file:
        file.write(start)
        file.truncate(size)


FEWER_POINTS = "check the scale of the scene (metersPerUnit), raise the tolerance"


def over_the_limit(folder):
    """More points than there is memory for are refused before they are placed."""
    row = Row("memory", "more points than allowed, or than there is memory for: refused with both numbers")
    (folder / "mesh.obj").write_text(obj(*BOX))
    (folder / "scene.json").write_text(scene([mesh_object()], spacing=1e-4))
    for arguments, sentence in (
            ((), "60000000000 points at a spacing of 0.0001 mm; the limit is 20000000; " + FEWER_POINTS
             + ", set --spacing, or raise --max-points"),
            (("--max-points", 10 ** 12), "60000000000 points at a spacing of 0.0001 mm and NUMBER GB of "
             "memory for them; there are NUMBER GB; " + FEWER_POINTS + ", or set --spacing"),
            (("--spacing", 0.5, "--max-points", 100), "2400 points at a spacing of 0.5 mm; the limit is 100; "
             + FEWER_POINTS + ", set --spacing, or raise --max-points")):
        code, words = run(folder, "sss-preprocess", "scene.json", "-o", "b.ssc", *arguments)
        row.expect(complaint_of_refusal(code, words, whole("thing: would need " + sentence))
                   if code == RESOURCES else f"exit code {code}: {words[-300:]}")
    yield row


def over_the_memory(folder):
    """What is too large for the memory there is, is refused with both figures before it is taken."""
    row, can_be_tried = limited_row(
        "memory", "films, meshes, skies, grids, bodies over the memory: refused with both numbers")
    if not can_be_tried:
        yield row
        return
    gib = 1 << 30
    box = {"shape": "box", "size": [4, 4, 4], "material": "stone"}
    large = {"shape": "box", "size": [400, 400, 400], "material": "stone"}
    balls = [{"shape": "sphere", "radius": 0.01, "material": "stone",
              "transform": [{"translate": [i * 0.1, 0, 0]}]} for i in range(3000)]
    fog = [{"shape": "box", "size": [9, 9, 9], "sigmaSPerMm": 1,
            "grid": {"file": "fog.raw", "dimensions": [2048, 1024, 1024]}}]
    write_empty(folder / "sparse.obj", 30 * gib)
    write_empty(folder / "sky.exr", 1 << 20, exr_header(16384, 16384))
    write_empty(folder / "fog.raw", 8 * gib)
    for limit, program, text, sentence in (
            (10 * gib, "sss-render", scene([box], film={"width": 32768, "height": 32768}),
             "film: a picture of 32768 x 32768 pixels in 7 layers would need NUMBER GB of memory; there are "
             "10.7 GB; make \"width\" and \"height\" smaller, or ask for fewer \"layers\""),
            (10 * gib, "sss-preprocess", scene([mesh_object("sparse.obj")]),
             "sparse.obj: a mesh file of 32.2 GB would need 64.4 GB of memory; there are 10.7 GB; simplify "
             "the mesh, or split it into several objects"),
            (2 * gib, "sss-preprocess", scene([box], sky="sky.exr"),
             "sky.exr: 16384 x 16384 pixels with 3 channels would need 3.22 GB of memory; there are 2.15 GB; "
             "scale it down"),
            (2 * gib, "sss-preprocess", scene([box], volumes=fog),
             "fog.raw: a grid of 2048 x 1024 x 1024 nodes of 1 floats would need 8.59 GB of memory; there are "
             "2.15 GB; use a coarser grid"),
            (5 * gib, "sss-preprocess",
             scene([large, {**large, "transform": [{"translate": [900, 0, 0]}]}], spacing=0.35),
             "scene.json: the 15673470 points of its 2 bodies would need NUMBER GB of memory; there are "
             "5.37 GB; " + FEWER_POINTS + ", or set --spacing"),
            (gib // 2, "sss-preprocess", scene(balls),
             "scene.json: the 2176000 triangles of its first 17 objects of 3000 would need NUMBER GB of memory; "
             "there are 0.537 GB; use fewer objects, or meshes with fewer triangles")):
        (folder / "scene.json").write_text(text)
        output = "b.exr" if program == "sss-render" else "b.ssc"
        code, words = run(folder, program, "scene.json", "-o", output, address_space=limit)
        row.expect(complaint_of_refusal(code, words, whole(sentence)) if code == RESOURCES
                   else f"exit code {code}: {words[-300:]}")
    for name in ("sparse.obj", "sky.exr", "fog.raw"):
        (folder / name).unlink()
    yield row


def large_meshes(folder):
    """Millions of triangles; the shared meshes, where they are."""
    row = Row("meshes", "2 x 10^6 triangles, and the four shared meshes")
    (folder / "mesh.obj").write_text(grid(700))
    files = [folder / "mesh.obj"] + sorted((SHARED / "meshes").glob("*.*"))
    for file in files:
        height = 1 if file.name == "mesh.obj" else 10
        (folder / "scene.json").write_text(scene([mesh_object(file, height)]))
        code, words = run(folder, "sss-preprocess", "scene.json", "-o", "a.ssc")
        complaint = f"ended with {code}: {words[-300:]}" if code else picture(folder)[0]
        row.expect(complaint and f"{file.name}: {complaint}")
    yield row


# What both together may take: 10^7 points are some 5 GB, 5 x 10^6 triangles some 2.
MOST_BYTES = 24 << 30


def ten_million_points(folder):
    """A mesh of 5 x 10^6 triangles with 10^7 points on it, through both programs."""
    row = Row("memory", "10^7 points on 5 x 10^6 triangles: GiB of the larger program", MOST_BYTES / 2 ** 30)
    (folder / "mesh.obj").write_text(grid(1120))
    (folder / "scene.json").write_text(scene([mesh_object("mesh.obj", 1)], spacing=0.0024))
    for arguments in (("sss-preprocess", "scene.json", "-o", "a.ssc"),
                      ("sss-render", "scene.json", "--cache", "a.ssc", "-o", "a.exr", "--no-keep")):
        code, words, peak = run_measured(folder, *arguments)
        row.add(peak / 2 ** 30 if code == 0 else math.inf,
                f"{arguments[0]} ended with {code}: {words[-300:]}")
        counted = re.search(r"(\d+) points, spacing", words)
        if arguments[0] == "sss-preprocess":
            points = int(counted.group(1)) if counted else 0
            row.add(0 if points >= 10 ** 7 else math.inf, f"{points} points only")
    yield row


def in_a_folder(*tries):
    """The rows of these, one after the other in one folder of their own."""
    with tempfile.TemporaryDirectory(prefix="sss-stress-") as name:
        for rows_of in tries:
            yield from rows_of(pathlib.Path(name))


def mesh_rows():
    return in_a_folder(hard_meshes, touching_bodies)


def limit_rows(full):
    return in_a_folder(over_the_limit, over_the_memory,
                       lambda folder: too_little_memory(folder, 100 if full else 9))


def main():
    failed = False
    for row in itertools.chain(mesh_rows(), limit_rows(full=False)):
        result = row.json()
        failed |= not result["passed"]
        print("ok    " if result["passed"] else "FAILED", result["subject"], "|", result["name"], "|",
              result["cases"], "cases", result["worstAt"], flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
