# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""car.py OUT.glb: makes the car of README.md's picture. Its halves are mirrored; wheels, bolts, lamps and the bars of the rack repeat one
another. car.py COSTS.svg OUT.svg: puts labels on what `gltf-mcc tree --costs` draws of it; samples/README.md has the commands.
"""
import json
import struct
import sys
from math import cos, pi, sin

positions, triangles = [], []
LABELS = [  # text, its place and alignment, and the place that it is about
    ("this half is paid for", 100, 92, "middle", 213, 187), ("its mirror image is almost free", 552, 38, "middle", 470, 168),
    ("bars repeat the first one", 372, 16, "start", 345, 54), ("the first wheel", 470, 482, "start", 402, 440),
    ("the next repeats it", 508, 420, "start", 627, 300)]


def add(points, faces, move=(0, 0, 0), mirror=False):
    """Adds a component, in which vertices at the same place are one."""
    places = [tuple((-1 if mirror and s == 0 else 1) * round(p[s] + move[s], 6) + 0 for s in range(3)) for p in points]
    numbers = {place: len(positions) + i for i, place in enumerate(dict.fromkeys(places))}
    positions.extend(numbers)
    for face in faces:
        corners = [numbers[places[i]] for i in (face[::-1] if mirror else face)]
        if len(set(corners)) == 3:
            triangles.append(corners)


def sheet(rows, columns, point, closed=False):
    """Returns a sheet of quads; `closed`: its last column meets the first."""
    width = columns if closed else columns + 1
    points = [point(r / rows, c / columns) for r in range(rows + 1) for c in range(width)]
    faces = []
    for r in range(rows):
        for c in range(columns):
            i, j = r * width + c, r * width + (c + 1) % width
            faces += [(i, j, j + width), (i, j + width, i + width)]
    return points, faces


def turned(outline, segments, axis=0):
    """Returns what (radius, height) make, turned around an axis."""
    def point(v, u):
        radius, height = outline[round(v * (len(outline) - 1))]
        a, b = radius * cos(2 * pi * u), radius * sin(2 * pi * u)
        return [(height, a, b), (b, height, a), (a, b, height)][axis]
    return sheet(len(outline) - 1, segments, point, True)


def smooth(x, low, high):
    t = min(1, max(0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def roof(z):
    """The height of the car at z, from the front (1) to the back (-1)."""
    front = 0.62 + 0.16 * smooth(-z, -1, -0.55) + 0.47 * smooth(-z, -0.42, -0.02)
    return min(front, 0.55 + 0.72 * smooth(z, -1.04, -0.42))


def body(v, u):
    z = 1 - 2 * v
    side = 2 * u - 1  # -1 … 1, from sill to sill
    end = (1 - abs(z) ** 7) ** 0.5 if abs(z) < 1 else 0
    angle = abs(side) * pi / 2
    waist = 0.56 + 0.04 * cos(2 * z)
    height = 0.3 + (roof(z) - 0.3) * (0.25 + 0.75 * end)
    y = 0.3 + (height - 0.3) * cos(angle) ** 0.62 if abs(side) < 1 else 0.3
    narrow = 1 - 0.3 * smooth(y, 0.72, 1.25)
    x = waist * (0.55 + 0.45 * end) * narrow * sin(angle) ** 0.55 if side else 0
    crease = 0.018 * sin(11 * y) * sin(angle)
    return ((x + crease) * (1 if side >= 0 else -1) if side else 0, y, 1.5 * z)


STEP = 3 / (2**14 - 1)  # of the lattice of 14 bits: parts that are whole steps apart are equal on it, as those on the grid of an editor


def steps(*values):
    return tuple(round(value / STEP) * STEP for value in values)


for mirror in (False, True):
    add(*sheet(44, 18, lambda v, u: body(v, 0.5 + u / 2)), mirror=mirror)
tyre = [(0, .1), (.07, .1), (.09, .08), (.17, .07), (.18, .11), (.22, .12), (.28, .11), (.31, .07), (.31, -.07), (.28, -.11), (.1, -.1)]
bolt = turned([(0, .03), (.018, .026), (.024, .012), (.024, 0)], 8)
arch = sheet(10, 14, lambda v, u: ((.1 + .13 * sin(pi * v)) * (0.6 + 0.4 * sin(pi * u)) - .06 + .02 * v,
                                   (.36 + .09 * v) * sin(pi * (1.05 * u - .025)), (.36 + .09 * v) * cos(pi * (1.05 * u - .025))))
lamp = turned([(0, .07), (.05, .062), (.09, .035), (.105, 0), (.12, 0), (.12, -.05)], 20, 2)
for mirror in (False, True):
    for z in (0.92, -0.92):
        add(*turned(tyre, 28), steps(.56, .31, z), mirror)
        add(*arch, (round(.68 / STEP) * STEP - .18, *steps(.33, z)), mirror)  # the widest part, so that the box has whole steps
        for y, dz in ((.12, 0), (0, .12), (-.12, 0), (0, -.12)):
            add(*bolt, steps(.635, .31 + y, z + dz), mirror)
    add(*lamp, steps(.33, .6, 1.36), mirror)
    add(*turned([(0, -.3), (.02, -.3), (.02, 0), (.02, .3), (0, .3)], 8, 2), steps(.34, 1.31, -.2), mirror)
bar = turned([(.0, -.34), (.016, -.34), (.016, -.1), (.016, .1), (.016, .34), (0, .34)], 8)
for i in range(5):
    add(*bar, steps(0, 1.31, .02 - .11 * i))



def label(drawing):
    parts = ['<g font-family="sans-serif" font-size="14" fill="#222a38" stroke-linecap="round">']
    for text, x, y, anchor, to_x, to_y in LABELS:
        begin = f"M{x + (0 if anchor == 'middle' else 30)} {y + 6 if to_y > y else y - 14}"
        parts.append(f'<path d="{begin}L{to_x} {to_y}" stroke="#222a38"/><circle cx="{to_x}" cy="{to_y}" r="2.5"/>'
                     f'<text x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>')
    return drawing.replace("</svg>", "\n".join([*parts, "</g>", "</svg>"]))


if len(sys.argv) == 3:
    with open(sys.argv[1]) as drawing, open(sys.argv[2], "w") as out:
        out.write(label(drawing.read()))
    sys.exit()
flat = struct.pack(f"<{3 * len(positions)}f", *(x for p in positions for x in p))
corners = struct.pack(f"<{3 * len(triangles)}H", *(i for t in triangles for i in t))
corners += b"\0" * (-len(corners) % 4)
document = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "car"}],
    "meshes": [{"name": "car", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
         "min": [struct.unpack("<f", struct.pack("<f", min(p[s] for p in positions)))[0] for s in range(3)],
         "max": [struct.unpack("<f", struct.pack("<f", max(p[s] for p in positions)))[0] for s in range(3)]},
        {"bufferView": 1, "componentType": 5123, "count": 3 * len(triangles), "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": len(flat)},
                    {"buffer": 0, "byteOffset": len(flat), "byteLength": len(corners)}],
    "buffers": [{"byteLength": len(flat) + len(corners)}]}
text = json.dumps(document).encode()
text += b" " * (-len(text) % 4)
with open(sys.argv[1], "wb") as out:
    out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(flat) + len(corners)))
    out.write(struct.pack("<I4s", len(text), b"JSON") + text)
    out.write(struct.pack("<I4s", len(flat) + len(corners), b"BIN\0") + flat + corners)
