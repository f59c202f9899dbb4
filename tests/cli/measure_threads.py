#!/usr/bin/env python3
# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""measure_threads.py GLTF_MCC: makes models like those in reports about lost precision, converts them with the defaults
and with --quality, and prints the table of docs/cli.md."""
import json
import math
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SIDE = 120  # squares of a sheet


def sheet(place, chart):
    """Returns positions, texture coordinates and corners of a sheet."""
    points = [(x / SIDE, y / SIDE) for y in range(SIDE + 1) for x in range(SIDE + 1)]
    corners = []
    for y in range(SIDE):
        for x in range(SIDE):
            i = y * (SIDE + 1) + x
            corners += [i, i + 1, i + SIDE + 2, i, i + SIDE + 2, i + SIDE + 1]
    return [place(*p) for p in points], [chart(*p) for p in points], corners


def wave(u, v):
    return u, v, 0.1 * math.sin(9 * u) * math.cos(7 * v)


def glb(meshes):
    """A GLB with a node for each mesh."""
    binary, views, accessors, nodes = b"", [], [], []
    document = {"asset": {"version": "2.0"}, "scene": 0, "meshes": []}

    def accessor(code, kind, component, rows, **bounds):
        nonlocal binary
        data = struct.pack(f"<{sum(len(r) for r in rows)}{code}", *(n for r in rows for n in r))
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "type": kind, "componentType": component, "count": len(rows), **bounds})
        binary += data
        return len(accessors) - 1

    for positions, texcoords, corners in meshes:
        columns = list(zip(*(struct.unpack("<3f", struct.pack("<3f", *p)) for p in positions)))
        attributes = {"POSITION": accessor("f", "VEC3", 5126, positions, min=[min(c) for c in columns], max=[max(c) for c in columns]),
                      "TEXCOORD_0": accessor("f", "VEC2", 5126, texcoords)}
        document["meshes"].append({"primitives": [{"attributes": attributes, "indices": accessor("I", "SCALAR", 5125, [(c,) for c in corners])}]})
        nodes.append({"mesh": len(nodes)})
    document.update(scenes=[{"nodes": list(range(len(nodes)))}], nodes=nodes, accessors=accessors, bufferViews=views,
                    buffers=[{"byteLength": len(binary)}])
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text
            + struct.pack("<II", len(binary), 0x004E4942) + binary)


def plain(u, v):
    return u, v


# What it is like, the meshes and how large each is without what lies far away, more options.
MODELS = [
    ("a few vertices with texture coordinates 50 repeats away (meshoptimizer 971)",
     [sheet(wave, lambda u, v: (u + 50, v) if u > 0.995 and v > 0.995 else (u, v))], [1], []),
    ("a texture that repeats 200 times (meshoptimizer 972)", [sheet(wave, lambda u, v: (200 * u, 200 * v))], [1], []),
    ("one vertex 500 times as far away as all others", [sheet(lambda u, v: (500, 0, 0) if u + v == 0 else wave(u, v), plain)], [1], []),
    ("small meshes beside one of 4,000 times their size (meshoptimizer 433, 848)",
     [sheet(lambda u, v, k=k: tuple((4000 if k == 0 else 1) * x for x in wave(u, v)), plain) for k in range(4)], [4000, 1, 1, 1], []),
    ("a rail, 5,000 times as long as thick (glTF-Transform 268)",
     [sheet(lambda u, v: (1000 * u, 0.1 * math.cos(6.28 * v), 0.1 * math.sin(6.28 * v)), plain)], [1000], []),
    ("two parts that touch (Draco 713, 1098)",
     [sheet(lambda u, v: wave(0.7 * u, v), plain), sheet(lambda u, v: wave(0.7 + 1.3 * u, v), plain)], [1, 1.3], ["--grid", "scene"]),
]


def borders(program, folder, small):
    """The widest gap between the two sides of a border, of a model whose meshes touch at the end of the first one."""
    back = folder / "back.glb"
    subprocess.run([program, "decode", "-q", small, back], check=True)
    data = back.read_bytes()
    size, = struct.unpack_from("<I", data, 12)
    document, binary = json.loads(data[20:20 + size]), data[28 + size:]
    sides = []
    for mesh in document["meshes"]:
        accessor = document["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]]
        view = document["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = [struct.unpack_from("<3f", binary, start + view.get("byteStride", 12) * i) for i in range(accessor["count"])]
        sides.append([row for row in rows if abs(row[0] - 0.7) < 1e-3])
    return max(min(math.dist(a, b) for b in sides[1]) for a in sides[0])


def figures(program, folder, source, sizes, options):
    """Converts a model and returns cells of the table, the notes and the name of the result."""
    small, report = folder / "small.glb", folder / "report.json"
    subprocess.run([program, "convert", "-q", "--compare", "none", *options, "--report", report, source, small], check=True)
    told = json.loads(report.read_text())
    position, pixels = 0, 0
    for payload in told["payloads"]:
        for attribute in payload["attributes"]:
            if attribute["name"] == "POSITION":
                position = max(position, attribute["max_error"] / sizes[payload["mesh"]])
            else:
                pixels = max(pixels, 2048 * attribute["max_error"])
    return [f"1/{1 / position:,.0f}" if position else "exact", f"{pixels:.2g}" if pixels else "exact",
            f"{sum(payload['bytes'] for payload in told['payloads']):,}"], told["notes"], small


def main(program):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for what, meshes, sizes, more in MODELS:
            source = folder / "source.glb"
            source.write_bytes(glb(meshes))
            for options in ([], ["--quality"], *([["--quality", *more]] if more else [])):
                cells, notes, small = figures(program, folder, source, sizes, options)
                if more:
                    cells[0] += f", gaps of {borders(program, folder, small):.2g}"
                print(f"| {what} | {'`' + ' '.join(options) + '`' if options else 'none'} | {' | '.join(cells)} |")
                for note in notes:
                    print(f"note: {note}")


main(*sys.argv[1:])
