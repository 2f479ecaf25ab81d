"""Files beside a scene that are large, or say so: what they hold is not looked at before their size."""

import struct


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def exr_header(width, height):
    channels = b"".join(name + b"\0" + struct.pack("<iBBBBii", 2, 0, 0, 0, 0, 1, 1)
                        for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    return (struct.pack("<II", 20000630, 2)
            + attribute("channels", "chlist", channels)
            + attribute("compression", "compression", b"\0")
            + attribute("dataWindow", "box2i", window)
            + attribute("displayWindow", "box2i", window)
            + attribute("lineOrder", "lineOrder", b"\0")
            + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
            + attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
            + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")


def write_sky(path, width, height):
    """An even OpenEXR picture of float R, G and B, without compression."""
    header = exr_header(width, height)
    row = struct.pack("<f", 1.0) * width * 3
    first, block = len(header) + 8 * height, 8 + len(row)
    with open(path, "wb") as file:
        file.write(header)
        file.write(b"".join(struct.pack("<Q", first + y * block) for y in range(height)))
        for y in range(height):
            file.write(struct.pack("<ii", y, len(row)) + row)


def write_empty(path, size, start=b""):
    """`size` bytes that take no room on the disk."""
    with open(path, "wb") as file:
        file.write(start)
        file.truncate(size)
