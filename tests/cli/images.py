"""Just enough of PNG, EXR and PLY to look at what the programs write, without other packages."""

import struct
import zlib


def read_png(path):
    """(width, height, channels, bytes of all pixels row by row) of an 8-bit grey, RGB or RGBA PNG."""
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{path} is not a PNG")
    chunks, at = {}, 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if zlib.crc32(kind + body) != struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]:
            raise ValueError(f"{path}: chunk {kind} is damaged")
        chunks[kind] = chunks.get(kind, b"") + body
        at += 12 + size
    if b"IEND" not in chunks:
        raise ValueError(f"{path} is truncated")
    width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    channels = {0: 1, 2: 3, 6: 4}[colour]
    if depth != 8 or interlace != 0:
        raise ValueError(f"{path}: only 8-bit PNGs that are not interlaced")
    return width, height, channels, unfilter(zlib.decompress(chunks[b"IDAT"]), width * channels,
                                             height, channels)


def unfilter(raw, stride, height, channels):
    """Undoes the PNG row filters (PNG specification, section 9)."""
    out, above = bytearray(), bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left = row[x - channels] if x >= channels else 0
            up = above[x]
            corner = above[x - channels] if x >= channels else 0
            row[x] = (row[x] + predictor(kind, left, up, corner)) & 255
        out += row
        above = row
    return bytes(out)


def predictor(kind, left, up, corner):
    if kind < 4:
        return (0, left, up, (left + up) // 2)[kind]
    distances = [(abs(up - corner), 0, left), (abs(left - corner), 1, up),
                 (abs(left + up - 2 * corner), 2, corner)]
    return min(distances)[2]


def read_exr(path):
    """({attribute: raw bytes}, all that comes after them) of a single-part EXR file: equal rests of
    equal channels are equal pixels, bit for bit."""
    data = path.read_bytes()
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError(f"{path} is not an EXR file")
    attributes, at = {}, 8
    while data[at] != 0:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        size = struct.unpack("<i", data[type_end + 1:type_end + 5])[0]
        attributes[data[at:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    return attributes, data[at + 1:]


def read_exr_header(path):
    """{attribute: raw bytes} of a single-part EXR file, and "channels" as a list of names."""
    attributes, _ = read_exr(path)
    names, raw, at = [], attributes["channels"], 0
    while raw[at] != 0:
        end = raw.index(0, at)
        names.append(raw[at:end].decode())
        at = end + 17
    attributes["channels"] = names
    return attributes


def read_ply(path):
    """(names of the properties, list of tuples) of a binary little-endian PLY of float vertices."""
    head, _, body = path.read_bytes().partition(b"end_header\n")
    lines = head.decode().splitlines()
    if lines[:2] != ["ply", "format binary_little_endian 1.0"]:
        raise ValueError(f"{path}: not a binary little-endian PLY")
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    names = [line.split()[2] for line in lines if line.startswith("property float")]
    if len(body) != count * 4 * len(names):
        raise ValueError(f"{path}: {len(body)} bytes for {count} vertices")
    return names, list(struct.iter_unpack(f"<{len(names)}f", body))
