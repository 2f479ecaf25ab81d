#!/usr/bin/env python3
"""Makes the candle's wax (wax.ply), its wick (wick.ply) and its flame (flame.raw) beside itself.

All lengths in mm; y is up, the rim of the wax at 0. The same files every time.
"""

import math
import pathlib
import random
import struct

HERE = pathlib.Path(__file__).resolve().parent

RADIUS, HEIGHT = 21.0, 62.0
POOL_DEPTH, POOL_RADIUS = 5.5, 16.5   # of the hollow that the flame has melted
AROUND = 160

WICK_RADIUS = 0.75

# The flame's box, centred on x = z = 0, and its lattice.
FLAME_WIDTH, FLAME_BOTTOM, FLAME_TOP = 16.0, -3.5, 34.0
NODES = (29, 53, 29)


def smooth(a, b, x):
    t = min(1.0, max(0.0, (x - a) / (b - a)))
    return t * t * (3 - 2 * t)


class Runs:
    """Wax that ran down the side: (angle, width, length, thickness) each."""

    def __init__(self):
        rng = random.Random(7)
        self.runs = []
        for angle in (0.35, 1.25, 1.62, 2.7, 3.9, 4.45, 5.5):
            self.runs.append((angle, rng.uniform(0.07, 0.12), rng.uniform(14, 42),
                              rng.uniform(1.8, 3.0)))

    def bulge(self, angle, y):
        """How far the side stands out at an angle and a height (0 at the rim, down to -HEIGHT)."""
        out = 0.0
        for centre, width, length, thick in self.runs:
            d = math.remainder(angle - centre, 2 * math.pi)
            # A run is thin above and ends in a drop.
            drop = math.exp(-((y + length) / 3.2) ** 2)
            body = smooth(-length - 1.0, -length + 2.0, y) * (0.55 + 0.25 * math.sin(y * 0.21))
            w = width * (1 + 0.55 * drop)
            out += thick * max(body, drop) * math.exp(-(d / w) ** 2)
        return out


def rim(angle):
    """Height of the rim: not level."""
    return 1.1 * math.sin(angle + 0.6) + 0.6 * math.sin(2 * angle + 2.0) + 0.25 * math.sin(5 * angle)


def profile():
    """(radius, height, share of the rim's unevenness, whether on the side), from axis to axis."""
    points = []
    for i in range(1, 22):                                   # the pool, from its middle out
        r = POOL_RADIUS * i / 21
        points.append((r, -POOL_DEPTH * (1 - smooth(7.0, POOL_RADIUS + 1.5, r)), smooth(8, 17, r), False))
    for i in range(1, 13):                                   # over the rounded rim
        a = math.pi * i / 12
        middle, half = (POOL_RADIUS + RADIUS) / 2, (RADIUS - POOL_RADIUS) / 2
        points.append((middle - half * math.cos(a), -0.35 + 1.3 * math.sin(a), 1.0, i > 8))
    for i in range(1, 56):                                   # down the side
        y = -0.35 - (HEIGHT - 1.6) * i / 55
        points.append((RADIUS, y, max(0.0, 1 + y / 12), True))
    points.append((RADIUS - 0.4, -HEIGHT + 0.4, 0.0, True))  # the foot
    points.append((RADIUS - 1.2, -HEIGHT, 0.0, True))
    points.append((RADIUS / 2, -HEIGHT, 0.0, False))
    return points


def revolve(points, place):
    """Vertices and faces of a closed surface of revolution; place(point, angle) -> (x, y, z)."""
    vertices, faces = [], []
    for point in points:
        for k in range(AROUND):
            vertices.append(place(point, 2 * math.pi * k / AROUND))
    for ring in range(len(points) - 1):
        for k in range(AROUND):
            a, b = ring * AROUND + k, ring * AROUND + (k + 1) % AROUND
            c, d = a + AROUND, b + AROUND
            faces += [(a, d, b), (a, c, d)]
    for ring, turn in ((0, False), (len(points) - 1, True)):
        start = ring * AROUND
        y = sum(vertices[start + k][1] for k in range(AROUND)) / AROUND
        vertices.append((0.0, y, 0.0))
        for k in range(AROUND):
            a, b = start + k, start + (k + 1) % AROUND
            faces.append((len(vertices) - 1, b, a) if turn else (len(vertices) - 1, a, b))
    return vertices, faces


def tube(centres, radii, around=24):
    """A closed tube along a bent line."""
    vertices, faces = [], []
    for (x, y, z), r in zip(centres, radii):
        for k in range(around):
            a = 2 * math.pi * k / around
            vertices.append((x + r * math.cos(a), y, z + r * math.sin(a)))
    for ring in range(len(centres) - 1):
        for k in range(around):
            a, b = ring * around + k, ring * around + (k + 1) % around
            faces += [(a, a + around, b + around), (a, b + around, b)]
    for ring, turn in ((0, False), (len(centres) - 1, True)):
        vertices.append(centres[ring])
        for k in range(around):
            a, b = ring * around + k, ring * around + (k + 1) % around
            faces.append((len(vertices) - 1, b, a) if turn else (len(vertices) - 1, a, b))
    return vertices, faces


def write_ply(path, vertices, faces):
    with open(path, "wb") as file:
        file.write(("ply\nformat binary_little_endian 1.0\n"
                    f"element vertex {len(vertices)}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    f"element face {len(faces)}\n"
                    "property list uchar int vertex_indices\nend_header\n").encode())
        for vertex in vertices:
            file.write(struct.pack("<3f", *vertex))
        for face in faces:
            file.write(struct.pack("<B3i", 3, *face))


def make_wax():
    runs = Runs()

    def place(point, angle):
        r, y, uneven, side = point
        y += uneven * rim(angle)
        if side:
            r += runs.bulge(angle, y) * smooth(-HEIGHT, -HEIGHT + 4, y)
        return r * math.cos(angle), y, -r * math.sin(angle)

    write_ply(HERE / "wax.ply", *revolve(profile(), place))


def wick_centre(y):
    """The wick leans, and bends over at its end."""
    bend = smooth(1.0, 7.5, y)
    return (0.25 * (y + POOL_DEPTH) * 0.15 + 1.6 * bend * bend, y, 0.3 * bend)


def make_wick():
    heights = [-POOL_DEPTH - 1.5 + 0.5 * i for i in range(28)]
    heights = [y for y in heights if y <= 6.5]
    radii = [WICK_RADIUS * (1 + 0.12 * math.sin(5 * y)) for y in heights]
    radii[-1] *= 0.6
    write_ply(HERE / "wick.ply", *tube([wick_centre(y) for y in heights], radii))


def flame(x, y, z):
    """Density of the flame, and the three factors of its light."""
    base, top = -1.5, 31.0
    h = (y - base) / (top - base)
    if h <= 0 or h >= 1:
        return 0.0, 0.0, 0.0, 0.0
    # A drop: widest at a quarter of its height, drawn out to a tip that leans a little.
    half = 6.6 * math.sin(math.pi * min(1.0, h ** 0.56)) ** 0.9 * (1 - 0.35 * h)
    lean = 0.8 + 1.3 * h * h * math.sin(2.2 * h)
    r = math.hypot(x - lean, z) / max(half, 1e-3)
    if r >= 1:
        return 0.0, 0.0, 0.0, 0.0
    edge = (1 - r * r) ** 2
    # Soot glows yellow-white in the upper part, above the dark zone around the wick; it thins out
    # and cools to orange at the tip and the edge. At the foot burns a blue cup.
    dark = 1 - 0.85 * (1 - smooth(0.0, 0.85, r)) * (1 - smooth(0.24, 0.42, h))
    soot = edge * dark * smooth(0.08, 0.36, h) * (1 - smooth(0.8, 1.0, h))
    cool = smooth(0.35, 1.0, h) * 0.5 + 0.5 * smooth(0.3, 1.0, r)
    blue = (1 - smooth(0.06, 0.30, h)) * smooth(0.25, 0.75, r) * (1 - smooth(0.8, 1.0, r))
    red = soot + 0.012 * blue
    green = soot * (0.62 - 0.26 * cool) + 0.03 * blue
    blue = soot * (0.24 - 0.20 * cool) + 0.10 * blue
    return soot, red, green, blue


def around_node(x, y, z):
    """The mean over a cell around a node, so that the lattice does not show."""
    dx, dy = FLAME_WIDTH / (NODES[0] - 1), (FLAME_TOP - FLAME_BOTTOM) / (NODES[1] - 1)
    values = [flame(x + a * dx, y + b * dy, z + c * dx)
              for a in (-0.33, 0, 0.33) for b in (-0.33, 0, 0.33) for c in (-0.33, 0, 0.33)]
    return [sum(v) / len(values) for v in zip(*values)]


def make_flame():
    nx, ny, nz = NODES
    values = bytearray()
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                values += struct.pack("<4f", *around_node(
                    FLAME_WIDTH * (i / (nx - 1) - 0.5),
                    FLAME_BOTTOM + (FLAME_TOP - FLAME_BOTTOM) * j / (ny - 1),
                    FLAME_WIDTH * (k / (nz - 1) - 0.5)))
    (HERE / "flame.raw").write_bytes(values)


if __name__ == "__main__":
    make_wax()
    make_wick()
    make_flame()
