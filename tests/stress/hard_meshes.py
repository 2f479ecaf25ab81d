"""Meshes that something is wrong with, written as text; what should come of each."""

import math

# A box of 10 mm, its corners and its twelve triangles, wound outward.
CORNERS = [(x, y, z) for z in (0, 10) for y in (0, 10) for x in (0, 10)]
FACES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
         (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]


def obj(corners, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in corners]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    return "\n".join(lines) + "\n"


def moved(corners, by, scale=1):
    return [tuple(scale * a + b for a, b in zip(corner, by)) for corner in corners]


def joined(*parts):
    corners, faces = [], []
    for more, their in parts:
        faces += [tuple(len(corners) + corner for corner in face) for face in their]
        corners += more
    return obj(corners, faces)


def flipped(faces):
    return [(a, c, b) for a, b, c in faces]


def strip(count, twist):
    """A band around a circle, `twist` half turns in it."""
    corners, faces = [], []
    for i in range(count):
        angle, turn = 2 * math.pi * i / count, math.pi / 2 + twist * math.pi * i / count
        for side in (-2, 2):
            radius = 10 + side * math.cos(turn)
            corners.append((radius * math.cos(angle), side * math.sin(turn),
                            radius * math.sin(angle)))
    for i in range(count - 1):
        faces += [(2 * i, 2 * i + 1, 2 * i + 3), (2 * i, 2 * i + 3, 2 * i + 2)]
    last = 2 * count - 2
    faces += [(last, last + 1, 0), (last, 0, 1)] if twist % 2 else [(last, last + 1, 1), (last, 1, 0)]
    return obj(corners, faces)


def needles():
    """A closed prism, a million times as long as wide, of faces as long as it."""
    corners = [(x * 1e-6, y, z * 1e-6) for x, y, z in CORNERS]
    return obj(corners, FACES)


def fan(count):
    """A closed cone over a polygon of many corners, which is one face."""
    ring = [(5 * math.cos(2 * math.pi * i / count), 0.0, 5 * math.sin(2 * math.pi * i / count))
            for i in range(count)]
    sides = [(i, count, (i + 1) % count) for i in range(count)]
    return obj(ring + [(0.0, 8.0, 0.0)], [tuple(range(count))] + sides)


def grid(side):
    """A closed slab with a wavy top of 2 x side x side triangles."""
    corners = [(10 * i / side, math.sin(i * 0.1) * math.sin(j * 0.13), 10 * j / side)
               for j in range(side + 1) for i in range(side + 1)]
    base = len(corners)
    corners += [(x, -3.0, z) for x, _, z in corners]
    row = side + 1
    faces = []
    for j in range(side):
        for i in range(side):
            a, b, c, d = j * row + i, j * row + i + 1, (j + 1) * row + i, (j + 1) * row + i + 1
            faces += [(a, c, d), (a, d, b), (base + a, base + d, base + c), (base + a, base + b, base + d)]
    for i in range(side):
        for a, b in ((i, i + 1), (side * row + i + 1, side * row + i),
                     ((i + 1) * row, i * row), (i * row + side, (i + 1) * row + side)):
            faces += [(a, b, base + b), (a, base + b, base + a)]
    return obj(corners, faces)


BOX = (CORNERS, FACES)
NO_FACES = "mesh.obj: the mesh has no faces; export a surface, not points or curves"
# What comes of a mesh: a picture, the very picture of BOX, or a refusal.
RENDERS, BOX_RENDERS, REFUSED = "renders", "renders as the box", "refused"

# name: text, what comes of it, what the program must say of it: a pattern among its words, or the whole
# sentence of a refusal.
HARD_MESHES = {
    "box": (obj(*BOX), BOX_RENDERS, ""),
    "open": (obj(CORNERS, FACES[:-2]), RENDERS, "open"),
    "non-manifold": (obj(CORNERS + [(5, 20, 5)], FACES + [(2, 3, 8)]), RENDERS,
                     "three or more|non-manifold"),
    "self-intersecting": (joined(BOX, (moved(CORNERS, (3, 4, 5)), FACES)), RENDERS, ""),
    "inside out": (obj(CORNERS, flipped(FACES)), BOX_RENDERS, "turned|flip"),
    "mixed winding": (obj(CORNERS, FACES[:5] + flipped(FACES[5:])), BOX_RENDERS, "turned|flip"),
    "duplicate faces": (obj(CORNERS, FACES + FACES), BOX_RENDERS, "repeat"),
    "faces without area": (obj(CORNERS, FACES + [(0, 0, 1), (0, 1, 1)]), BOX_RENDERS, "no surface"),
    "collinear faces": (obj(CORNERS + [(5, 0, 0)], FACES + [(0, 8, 1)]), BOX_RENDERS, "no area|no surface"),
    "unreferenced vertices": (obj(CORNERS + [(1e3, 1e3, 1e3)] * 5, FACES), BOX_RENDERS, ""),
    "an unreferenced vertex that is NaN": (
        obj(CORNERS, FACES) + "v nan 0 0\n", REFUSED,
        "mesh.obj: vertex 8 (from 0) is at (nan, 0, 0); 1 of 9 vertices are not finite; repair the mesh in a "
        "mesh editor"),
    "a vertex at 1e38": (obj(CORNERS[:-1] + [(1e38, 10, 10)], FACES), RENDERS, "no area"),
    "a vertex at 1e308": (obj(CORNERS[:-1] + [(1e308, 1e308, 1e308)], FACES), RENDERS, "no area"),
    "needles": (needles(), RENDERS, "thin"),
    "one triangle": (obj([(0, 0, 0), (10, 0, 0), (0, 10, 0)], [(0, 1, 2)]), RENDERS, "open"),
    "an empty file": ("", REFUSED, NO_FACES),
    "no faces": ("v 0 0 0\n", REFUSED, NO_FACES),
    "an index out of range": (
        obj(CORNERS, FACES + [(0, 1, 99)]), REFUSED,
        "mesh.obj: line 21: a face uses vertex 100, but the file has 8; export the mesh again"),
    "nested shells": (joined(BOX, (moved(CORNERS, (3, 3, 3), 0.4), flipped(FACES))), RENDERS, ""),
    "ten shells in each other": (
        joined(*[(moved(CORNERS, (i / 3,) * 3, 1 - i / 15), FACES) for i in range(10)]), RENDERS, ""),
    "touching along an edge": (joined(BOX, (moved(CORNERS, (10, 10, 0)), FACES)), RENDERS, ""),
    "a Moebius strip": (strip(48, 1), RENDERS, "open|sides"),
    "a band": (strip(48, 0), RENDERS, "open"),
    "a face of 1,000 corners": (fan(1000), RENDERS, ""),
    "far from the origin": (obj(moved(CORNERS, (1e7, -1e7, 1e7)), FACES), BOX_RENDERS, ""),
    "all in one place": (obj([(1, 1, 1)] * 8, FACES), REFUSED,
                         "mesh.obj: none of its 12 faces has an area; check the mesh and its scale"),
    "flat": (obj([(x, 0, z) for x, _, z in CORNERS], FACES), REFUSED,
             "scene.json:1:321: \"thing\" cannot be fitted to a height: it is flat in y; rotate it before "
             "the fit, or use a scale"),
}
