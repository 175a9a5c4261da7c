"""Are two pictures the same? Drawings (SVG) to a pixel of their numbers, PNG by the mean of their pixels: another compiler or driver
rounds differently."""
import re
import struct
import zlib


def png_pixels(data):
    """(width, height, channels, bytes) of a PNG of 8 bits a channel without a palette or interlacing."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("not a PNG")
    at, packed, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += length + 12
    width, height, depth, colour, _, _, interlaced = header
    channels = {0: 1, 2: 3, 4: 2, 6: 4}.get(colour)
    if depth != 8 or channels is None or interlaced:
        raise ValueError("a PNG of a kind that is not read here")
    return width, height, channels, unfiltered(zlib.decompress(packed), width * channels, height, channels)


def paeth(a, b, c):
    p = a + b - c
    distances = abs(p - a), abs(p - b), abs(p - c)
    return (a, b, c)[distances.index(min(distances))]


def unfiltered(raw, stride, height, step):
    """Rows of a PNG (W3C, Portable Network Graphics, 9.2) without their filters."""
    out, above = bytearray(), bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride) if kind else ():
            left = row[x - step] if x >= step else 0
            corner = above[x - step] if x >= step else 0
            add = (0, left, above[x], (left + above[x]) // 2, paeth(left, above[x], corner))[kind]
            row[x] = (row[x] + add) & 255
        out += row
        above = row
    return bytes(out)


def same_drawing(made, kept, most_difference=1.0):
    """The same words in the same order, with numbers that differ by a unit of the drawing at most."""
    number = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"
    if re.sub(number, "#", made) != re.sub(number, "#", kept):
        return False
    pairs = zip(re.findall(number, made), re.findall(number, kept))
    return all(abs(float(a) - float(b)) <= most_difference for a, b in pairs)


def picture_fault(made, kept, most_difference=4.0):
    """None, or how the file `made` differs from `kept`. most_difference: mean over all pixels, of 255."""
    if made.suffix == ".svg":
        return None if same_drawing(made.read_text(), kept.read_text()) else "the drawing is another one"
    new, old = png_pixels(made.read_bytes()), png_pixels(kept.read_bytes())
    if new[:3] != old[:3]:
        return f"{new[:3]} pixels and channels, not {old[:3]}"
    difference = sum(abs(a - b) for a, b in zip(new[3], old[3])) / len(new[3])
    return None if difference <= most_difference else f"pixels differ by {difference:.1f} of 255 on average"
