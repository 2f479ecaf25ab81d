"""Just enough of PNG, EXR and PLY to look at what the programs write, and to write what they read,
without other packages."""

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


def exr_attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def exr_header(width, height, channels=("B", "G", "R")):
    """The head of an EXR of float channels without compression; their names in the order of the alphabet."""
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iBBBBii", 2, 0, 0, 0, 0, 1, 1)
                      for name in channels) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    return (struct.pack("<II", 20000630, 2)
            + exr_attribute("channels", "chlist", listed)
            + exr_attribute("compression", "compression", b"\0")
            + exr_attribute("dataWindow", "box2i", window)
            + exr_attribute("displayWindow", "box2i", window)
            + exr_attribute("lineOrder", "lineOrder", b"\0")
            + exr_attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
            + exr_attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
            + exr_attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")


def write_even_exr(path, width, height, channels=("B", "G", "R")):
    """An EXR in which every value is 1."""
    header = exr_header(width, height, channels)
    row = struct.pack("<f", 1.0) * width * len(channels)
    first, block = len(header) + 8 * height, 8 + len(row)
    with open(path, "wb") as file:
        file.write(header)
        file.write(b"".join(struct.pack("<Q", first + y * block) for y in range(height)))
        for y in range(height):
            file.write(struct.pack("<ii", y, len(row)) + row)


EXR_ZIP, EXR_LINES_A_CHUNK = 3, 16
EXR_TYPES = {0: "I", 1: "e", 2: "f"}


def unzip_exr(data, size):
    """Undoes the ZIP compression of a chunk: differences of bytes, the even ones before the odd."""
    if len(data) == size:
        return data  # it would not have become smaller
    raw = bytearray(zlib.decompress(data))
    for i in range(1, size):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    plain, half = bytearray(size), (size + 1) // 2
    plain[0::2], plain[1::2] = raw[:half], raw[half:]
    return bytes(plain)


def read_exr_values(path):
    """{channel: list of its values row by row} of an EXR as they are written here: one part, scan lines,
    ZIP."""
    attributes, rest = read_exr(path)
    if attributes["compression"][0] != EXR_ZIP:
        raise ValueError(f"{path}: only ZIP is read here")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    rows, raw, at = [], attributes["channels"], 0
    while raw[at] != 0:
        end = raw.index(0, at)
        kind = EXR_TYPES[struct.unpack("<i", raw[end + 1:end + 5])[0]]
        rows.append((raw[at:end].decode(), struct.Struct(f"<{width}{kind}")))
        at = end + 17
    values = {name: [] for name, _ in rows}
    at, line_bytes = 8 * -(-height // EXR_LINES_A_CHUNK), sum(row.size for _, row in rows)
    for first in range(0, height, EXR_LINES_A_CHUNK):
        lines = min(EXR_LINES_A_CHUNK, height - first)
        packed = struct.unpack("<ii", rest[at:at + 8])[1]
        plain, place = unzip_exr(rest[at + 8:at + 8 + packed], lines * line_bytes), 0
        at += 8 + packed
        for _ in range(lines):
            for name, row in rows:
                values[name] += row.unpack_from(plain, place)
                place += row.size
    return values


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
