# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Tests of the package gltf_mcc: test_gltf_mcc.py GLTF_MCC SAMPLES README, run by package_test in an environment that has
nothing but the wheel. NumPy is used if it is there."""
import contextlib
import io
import json
import os
import pickle
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib
from pathlib import Path

import gltf_mcc
from gltf_mcc import _library, accessors, arrays, documents, primitives
from gltf_mcc.meshlets import SHAPES

PROGRAM, SAMPLES, README = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])


def grid(side):
    """Returns the positions and indices of a bumpy sheet as memoryviews."""
    positions = [c for y in range(side) for x in range(side) for c in (x, y, x * y % 7)]
    corners = []
    for y in range(side - 1):
        for x in range(side - 1):
            i = y * side + x
            corners += [i, i + 1, i + side, i + 1, i + side + 1, i + side]
    return (memoryview(struct.pack(f"{len(positions)}f", *positions)).cast("f", (side * side, 3)),
            memoryview(struct.pack(f"{len(corners)}I", *corners)).cast("I"))


def triangles_of(positions, indices):
    """Returns the triangles as sets of positions, each turned so that its lowest corner comes first."""
    rows = [tuple(row) for row in positions.tolist()]
    flat = [i for t in indices.tolist() for i in (t if isinstance(t, list) else [t])]
    found = []
    for k in range(0, len(flat), 3):
        corners = [rows[i] for i in flat[k:k + 3]]
        first = corners.index(min(corners))
        found.append(tuple(corners[first:] + corners[:first]))
    return sorted(found)


class Documents(unittest.TestCase):
    def test_the_bytes_are_those_of_the_program(self):
        for sample in sorted(SAMPLES.glob("*.glb")):
            with tempfile.TemporaryDirectory() as folder:
                out = Path(folder, "out.glb")
                subprocess.run([PROGRAM, "convert", "-q", "--position-bits", "12", sample, out], check=True,
                               stdout=subprocess.DEVNULL)
                expected = out.read_bytes()
                self.assertEqual(gltf_mcc.convert(sample, position_bits=12), expected, sample.name)
                subprocess.run([PROGRAM, "decode", out, Path(folder, "back.glb")], check=True,
                               stdout=subprocess.DEVNULL)
                self.assertEqual(gltf_mcc.decode(expected), Path(folder, "back.glb").read_bytes(), sample.name)
                text = subprocess.run([PROGRAM, "inspect", "--format", "json", out], check=True,
                                      stdout=subprocess.PIPE).stdout
                self.assertEqual(gltf_mcc.inspect(out), json.loads(text), sample.name)

    def test_sources_of_every_kind(self):
        path = SAMPLES / "torus.glb"
        data = path.read_bytes()
        small = gltf_mcc.convert(data)
        self.assertLess(len(small), len(data) / 2)
        for source in (path, str(path), bytearray(data), memoryview(data)):
            self.assertEqual(gltf_mcc.convert(source), small)

    def test_every_option_reaches_the_library(self):
        data = (SAMPLES / "torus.glb").read_bytes()
        usual = gltf_mcc.convert(data)
        for options in ({"position_bits": 9}, {"normal_bits": 7}, {"lossless": True}, {"indices_only": True},
                        {"keep_vertex_order": True}, {"keep_triangle_order": True}, {"max_position_error": 0.01},
                        {"prefer": "speed", "block_triangles": 100}, {"position_lattice": (0, 0, 0, 0.125)}, {"step": 2**-7}, {"quality": 1024}):
            self.assertNotEqual(gltf_mcc.convert(data, **options), usual, options)
        self.assertEqual(gltf_mcc.convert(data, thread_count=2, grid="scene"), usual)
        builder = Builder()
        builder.primitive(attributes={"POSITION": builder.positions(3)})
        self.assertEqual(gltf_mcc.convert(builder.glb()), builder.glb())
        self.assertGreater(len(gltf_mcc.convert(builder.glb(), allow_larger=True)), len(builder.glb()))

    def test_a_preview_is_in_front(self):
        positions, indices = grid(226)  # just enough triangles
        builder = Builder()
        builder.primitive(attributes={"POSITION": builder.accessor("VEC3", FLOAT, 226 * 226, bytes(positions),
                                                                   min=[0, 0, 0], max=[225, 225, 6])},
                          indices=builder.accessor("SCALAR", UINT, len(indices), bytes(indices)))
        glb = builder.glb()
        whole = gltf_mcc.inspect(gltf_mcc.convert(glb))["payloads"]
        for asked in (500, gltf_mcc.PREVIEWS_BY_SHARE):
            small = gltf_mcc.convert(glb, preview_triangles=asked)
            payloads = gltf_mcc.inspect(small)["payloads"]
            self.assertEqual(len(payloads), len(whole) + 1)
            self.assertEqual([payload.get("preview", False) for payload in payloads].count(True), 1)
            self.assertEqual(gltf_mcc.decode(small), gltf_mcc.decode(gltf_mcc.convert(glb)))

    def test_enumerations_are_those_of_the_header(self):
        header = (SAMPLES.parent / "lib/include/mcc/c_api.h").read_text()
        for prefix, own in (("MCC_CODING_", {c.name: c.value for c in _library.Coding}),
                            ("MCC_PREFER_", {n.upper(): k for k, n in enumerate(documents.PREFERENCES)}),
                            ("MCC_MESHLETS_", {"ROUND": SHAPES.index("round"), "IN_ORDER": SHAPES.index("order")}),
                            ("MCC_GRID_", {n.upper(): k for k, n in enumerate(documents.GRIDS)}),
                            ("MCC_DECODE_TO_", {n.upper(): k for k, n in enumerate(documents.DECODE_TO)})):
            found = re.findall(rf"\b{prefix}(\w+) = (\d+)", header)
            self.assertEqual(own, {name: int(number) for name, number in found}, prefix)

    def test_wrong_lattices(self):
        data = (SAMPLES / "torus.glb").read_bytes()
        with self.assertRaises(ValueError):
            gltf_mcc.convert(data, position_lattice=(0, 0, 0))
        with self.assertRaises(gltf_mcc.Error):
            gltf_mcc.convert(data, position_lattice=(0, 0, 0, 0))
        for wrong in ({"step": 0.001}, {"step": 1, "max_position_error": 1}):
            with self.assertRaisesRegex(gltf_mcc.Error, "step"):
                gltf_mcc.convert(data, **wrong)
        for wrong in ({"quality": 15}, {"quality": float("nan")}, {"quality": 64, "step": 1}):
            with self.assertRaisesRegex(gltf_mcc.Error, "quality"):
                gltf_mcc.convert(data, **wrong)
        with self.assertRaisesRegex(ValueError, "quality"):
            gltf_mcc.convert(data, quality=64, normal_bits=8)

    def test_refusals(self):
        with self.assertRaisesRegex(gltf_mcc.Error, "neither a GLB nor JSON") as caught:
            gltf_mcc.decode(b"no GLB")
        self.assertEqual(caught.exception.code, "DOCUMENT")
        with self.assertRaises(FileNotFoundError):
            gltf_mcc.convert("there is no such file.glb")
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(again), again.code, again.offset_bytes),
                         (str(caught.exception), "DOCUMENT", caught.exception.offset_bytes))
        for wrong in ({"position_bits": 99}, {"position_bits": -1}, {"position_bits": 2**32 + 14}, {"grid": "x"},
                      {"prefer": "x"}, {"lossless": True, "normal_bits": 8}):
            with self.assertRaises(ValueError, msg=str(wrong)):
                gltf_mcc.convert(SAMPLES / "torus.glb", **wrong)
        with self.assertRaisesRegex(gltf_mcc.Error, "max_decoded_bytes"):
            gltf_mcc.decode(gltf_mcc.convert(SAMPLES / "torus.glb"), max_decoded_bytes=1)

    def test_other_threads_go_on(self):
        results = [None] * 4
        data = (SAMPLES / "genus3.glb").read_bytes()

        def work(k):
            results[k] = gltf_mcc.decode(gltf_mcc.convert(data))

        threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(results[0])
        self.assertEqual(results.count(results[0]), 4)


class Meshes(unittest.TestCase):
    def test_a_mesh_comes_back(self):
        positions, indices = grid(20)
        encoding = gltf_mcc.encode_mesh({"POSITION": positions}, indices)
        piece, = gltf_mcc.decode_payload(encoding.payload)
        self.assertEqual(triangles_of(piece["POSITION"], piece.parts[0]), triangles_of(positions, indices))
        rows = positions.tolist()
        self.assertEqual([rows[i] for i in encoding.source_vertices.tolist()], piece["POSITION"].tolist())

    def test_attributes_of_every_type(self):
        positions, indices = grid(5)
        made = {"POSITION": positions}
        for k, code in enumerate("bBhHIf"):
            size = struct.calcsize(code)
            made[f"_A{k}"] = memoryview(bytes(range(25 * 2 * size % 256)) * 8)[:25 * 2 * size].cast(code, (25, 2))
        encoding = gltf_mcc.encode_mesh(made, indices, keep_vertex_order=True, keep_triangle_order=True)
        piece, = gltf_mcc.decode_payload(encoding.payload)
        self.assertEqual(piece["POSITION"].tolist(), positions.tolist())
        self.assertEqual(sum(piece.parts[0].tolist(), []), indices.tolist())
        for k in range(6):
            name = f"_CUSTOM_{zlib.crc32(f'_A{k}'.encode()) & 255}"
            self.assertEqual(bytes(piece[name]), bytes(made[f"_A{k}"]), name)

    def test_morph_targets_parts_and_bits(self):
        positions, indices = grid(6)
        uv = memoryview(bytes(2 * 36)).cast("B", (36, 2))
        half = len(indices) // 6 * 3
        encoding = gltf_mcc.encode_mesh({"TEXCOORD_1": uv, "POSITION": positions}, [indices[:half], indices[half:]],
                                        bits={"POSITION": 10}, normalized=["TEXCOORD_1"],
                                        morph_targets=[{"POSITION": positions}])
        piece, = gltf_mcc.decode_payload(encoding.payload)
        self.assertEqual([(a.name, a.target, a.normalized) for a in piece.attributes],
                         [("POSITION", -1, False), ("TEXCOORD_1", -1, True), ("POSITION", 0, False)])
        self.assertEqual(piece.attributes[0].coding, "lattice")
        self.assertEqual(piece.attributes[0].bits, 10)
        self.assertEqual([len(part) for part in piece.parts], [half // 3, len(indices) // 3 - half // 3])

    def test_wrong_lattices(self):
        data = (SAMPLES / "torus.glb").read_bytes()
        with self.assertRaises(ValueError):
            gltf_mcc.convert(data, position_lattice=(0, 0, 0))
        with self.assertRaises(gltf_mcc.Error):
            gltf_mcc.convert(data, position_lattice=(0, 0, 0, 0))

    def test_refusals(self):
        positions, indices = grid(5)
        payload = gltf_mcc.encode_mesh({"POSITION": positions}, indices).payload
        with self.assertRaises(gltf_mcc.Error) as caught:
            gltf_mcc.decode_payload(payload[:-1])
        self.assertEqual(caught.exception.code, "BAD_CHECKSUM")
        with self.assertRaises(gltf_mcc.Error) as caught:
            gltf_mcc.decode_payload(payload, max_vertices=3)
        self.assertEqual(caught.exception.code, "LIMIT")
        with self.assertRaisesRegex(ValueError, "no POSITION"):
            gltf_mcc.encode_mesh({}, indices)
        with self.assertRaisesRegex(ValueError, "float32"):
            gltf_mcc.encode_mesh({"POSITION": memoryview(bytes(24)).cast("d", (1, 3))}, indices)
        with self.assertRaisesRegex(ValueError, "different numbers"):
            gltf_mcc.encode_mesh({"POSITION": positions, "COLOR_0": memoryview(bytes(8)).cast("B", (2, 4))}, indices)
        with self.assertRaises(gltf_mcc.Error) as caught:
            gltf_mcc.encode_mesh({"POSITION": positions}, [0, 1, 25])
        self.assertEqual(caught.exception.code, "BAD_ARGUMENT")
        with self.assertRaisesRegex(ValueError, "no attribute of glTF"):
            gltf_mcc.encode_mesh({"POSITION": positions, "UV": positions}, indices)

    def test_every_flipped_bit_is_refused(self):
        positions, indices = grid(4)
        payload = gltf_mcc.encode_mesh({"POSITION": positions}, indices).payload
        for bit in range(8 * len(payload)):
            damaged = bytearray(payload)
            damaged[bit // 8] ^= 1 << bit % 8
            with self.assertRaises(gltf_mcc.Error, msg=str(bit)):
                gltf_mcc.decode_payload(damaged)

    def test_narrow_and_strided_arrays(self):
        positions, indices = grid(5)
        wide = gltf_mcc.encode_mesh({"POSITION": positions}, indices).payload
        narrow = memoryview(struct.pack(f"{len(indices)}H", *indices)).cast("H")
        self.assertEqual(gltf_mcc.encode_mesh({"POSITION": positions}, narrow).payload, wide)
        self.assertEqual(gltf_mcc.encode_mesh({"POSITION": positions}, indices.tolist()).payload, wide)

    @unittest.skipIf(arrays.numpy is None, "NumPy is not installed")
    def test_numpy(self):
        numpy = arrays.numpy
        positions, indices = grid(9)
        wide = numpy.zeros((81, 8), numpy.float32)
        wide[:, 2:5] = positions.tolist()
        payload = gltf_mcc.encode_mesh({"POSITION": wide[:, 2:5]},
                                       numpy.array(indices.tolist(), numpy.uint16).reshape(-1, 3)).payload
        self.assertEqual(payload, gltf_mcc.encode_mesh({"POSITION": positions}, indices).payload)
        piece, = gltf_mcc.decode_payload(payload)
        self.assertEqual(piece["POSITION"].dtype, numpy.float32)
        self.assertEqual(piece.parts[0].shape[1], 3)


def glb_of(document, binary=b""):
    """Returns a GLB of a document and its BIN chunk."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


class MeshletsOfTriangles(unittest.TestCase):
    def test_they_are_the_triangles(self):
        positions, indices = grid(20)
        piece, = gltf_mcc.decode_payload(gltf_mcc.encode_mesh({"POSITION": positions}, indices).payload)
        for limits in ({}, {"max_vertices": 3, "max_triangles": 512}, {"max_vertices": 32, "max_triangles": 7}):
            for shape in SHAPES:
                made = gltf_mcc.build_meshlets(piece.parts[0], 400, shape=shape, **limits)
                vertices, corners, found = made.vertices.tolist(), made.triangles.tolist(), []
                for first_vertex, first_byte, vertex_count, triangle_count in made.meshlets.tolist():
                    self.assertLessEqual(vertex_count, limits.get("max_vertices", 64))
                    self.assertLessEqual(triangle_count, limits.get("max_triangles", 124))
                    ends = corners[first_byte:first_byte + 3 * triangle_count]
                    found += [[vertices[first_vertex + number] for number in ends[k:k + 3]]
                              for k in range(0, len(ends), 3)]
                expected = piece.parts[0].tolist()
                self.assertEqual(*((found, expected) if shape == "order" else (sorted(found), sorted(expected))))

    def test_nothing_and_what_cannot_be(self):
        one = struct.pack("3I", 0, 1, 2)
        indices = memoryview(one).cast("I")
        self.assertEqual(len(gltf_mcc.build_meshlets(memoryview(b"").cast("I"), 0).triangles), 0)
        self.assertEqual(gltf_mcc.build_meshlets([2, 1, 0], 3).vertices.tolist(), [2, 1, 0])
        for wrong in ({"max_vertices": 2}, {"max_vertices": 257}, {"max_triangles": 0}, {"vertex_count": 2}):
            with self.assertRaises(gltf_mcc.Error, msg=str(wrong)):
                gltf_mcc.build_meshlets(indices, **{"vertex_count": 3, **wrong})
        for wrong in ({"shape": "flat"}, {"max_vertices": -1}, {"indices": indices[:2]}, {"vertex_count": 2**32}):
            with self.assertRaises(ValueError, msg=str(wrong)):
                gltf_mcc.build_meshlets(**{"indices": indices, "vertex_count": 3, **wrong})


class Builder:
    """Makes documents of one mesh, accessor by accessor."""

    def __init__(self):
        self.binary = b""
        self.document = {"asset": {"version": "2.0"}, "buffers": [{}], "bufferViews": [], "accessors": [], "meshes": []}

    def view(self, data, **members):
        self.binary += bytes(-len(self.binary) % 4)
        self.document["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **members})
        self.binary += data
        return len(self.document["bufferViews"]) - 1

    def accessor(self, kind, component_type, count, data=None, stride=None, **members):
        if data is not None:
            members["bufferView"] = self.view(data, **({"byteStride": stride} if stride else {}))
        self.document["accessors"].append({"type": kind, "componentType": component_type, "count": count, **members})
        return len(self.document["accessors"]) - 1

    def primitive(self, **members):
        if not self.document["meshes"]:
            self.document["meshes"] = [{"name": "a mesh", "primitives": []}]
        self.document["meshes"][0]["primitives"].append(members)

    def glb(self):
        self.document["buffers"][0]["byteLength"] = len(self.binary)
        return glb_of(self.document, self.binary)

    def positions(self, count=4):
        return self.accessor("VEC3", FLOAT, count, struct.pack(f"{3 * count}f", *range(3 * count)),
                             min=[0, 1, 2], max=[3 * count - 3, 3 * count - 2, 3 * count - 1])


BYTE, UBYTE, SHORT, USHORT, INT, UINT, FLOAT = 5120, 5121, 5122, 5123, 5124, 5125, 5126
DOUBLE, HALF, LONG, ULONG = 5130, 5131, 5134, 5135  # of the draft of glTF 2.1


def flat(array):
    return [number for row in array.tolist() for number in row]


class MeshesOfFiles(unittest.TestCase):
    def read(self, builder):
        mesh, = gltf_mcc.meshes(builder.glb())
        return mesh.primitives

    def test_compressed_or_not_is_the_same(self):
        kept = {"lossless": True, "keep_vertex_order": True, "keep_triangle_order": True}
        compressed_count = 0
        for sample in sorted(SAMPLES.glob("*.glb")):
            small = gltf_mcc.convert(sample, **kept)
            compressed_count += gltf_mcc.inspect(small)["payloads"] != []
            plain, again = gltf_mcc.meshes(sample), gltf_mcc.meshes(small)
            self.assertEqual([mesh.name for mesh in plain], [mesh.name for mesh in again])
            for mesh, other in zip(plain, again):
                self.assertEqual(len(mesh.primitives), len(other.primitives))
                for a, b in zip(mesh.primitives, other.primitives):
                    self.assertEqual((a.kind, a.material), (b.kind, b.material))
                    self.assertEqual(list(a.attributes), list(b.attributes))
                    self.assertEqual(a.indices.tolist(), b.indices.tolist())
                    for arrays, others in zip([a.attributes, *a.targets], [b.attributes, *b.targets]):
                        for name in arrays:
                            self.assertEqual(arrays[name].tolist(), others[name].tolist(), f"{sample.name} {name}")
        self.assertGreater(compressed_count, 10)

    def test_triangles_of_a_sample(self):
        data = (SAMPLES / "torus.glb").read_bytes()
        document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
        mesh, = gltf_mcc.meshes(gltf_mcc.convert(data))
        primitive, = mesh.primitives
        accessors = document["accessors"]
        described = document["meshes"][0]["primitives"][0]
        self.assertEqual(mesh.name, document["meshes"][0].get("name", ""))
        self.assertEqual(primitive.kind, "triangles")
        self.assertEqual(primitive.indices.shape, (accessors[described["indices"]]["count"] // 3, 3))
        position = accessors[described["attributes"]["POSITION"]]
        self.assertEqual(primitive.positions.shape, (position["count"], 3))
        for found, expected in ((map(min, zip(*primitive.positions.tolist())), position["min"]),
                                (map(max, zip(*primitive.positions.tolist())), position["max"])):
            for a, b in zip(found, expected):
                self.assertAlmostEqual(a, b, places=3)

    def test_every_layout(self):
        made = Builder()
        positions = made.positions()
        interleaved = made.accessor("VEC2", SHORT, 4, b"".join(struct.pack("2h4x", k, k + 1) for k in range(0, 8, 2)), 8)
        padded = made.accessor("MAT2", BYTE, 4, bytes(range(32)))  # columns begin at multiples of four
        colors = made.accessor("VEC3", UBYTE, 4, bytes([0, 255, 51, 0] * 4), 4, normalized=True)
        normals = made.accessor("VEC3", BYTE, 4, struct.pack("12b", *[-128, -127, 127] * 4), normalized=True)
        joints = made.accessor("VEC4", USHORT, 4, struct.pack("16H", *range(16)))
        zeros = made.accessor("SCALAR", UINT, 4)
        changed = made.view(bytes([1, 3]))
        values = made.view(struct.pack("2I", 70, 90))
        sparse = made.accessor("SCALAR", UINT, 4, sparse={
            "count": 2, "indices": {"bufferView": changed, "componentType": UBYTE}, "values": {"bufferView": values}})
        made.primitive(attributes={"POSITION": positions, "_I": interleaved, "_M": padded, "COLOR_0": colors, "_Z": zeros,
                                   "NORMAL": normals, "JOINTS_0": joints, "_S": sparse, "TEXCOORD_0": interleaved},
                       targets=[{"POSITION": positions}], material=0)
        made.document["materials"] = [{}]
        primitive, = self.read(made)
        found = primitive.attributes
        self.assertEqual(flat(found["_I"]), list(range(8)))
        self.assertEqual(flat(found["_M"]), [8 * i + k for i in range(4) for k in (0, 1, 4, 5)])
        self.assertEqual(found["_M"].shape, (4, 4))
        for value, expected in zip(flat(found["COLOR_0"]), [0, 1, 0.2] * 4):
            self.assertAlmostEqual(value, expected)
        self.assertEqual(flat(found["NORMAL"]), [-1, -1, 1] * 4)
        self.assertEqual(flat(found["JOINTS_0"]), list(range(16)))
        self.assertEqual(flat(found["_Z"]), [0] * 4)
        self.assertEqual(flat(found["_S"]), [0, 70, 0, 90])
        self.assertEqual(flat(found["TEXCOORD_0"]), list(range(8)))
        formats = {name: memoryview(array).format for name, array in found.items()}
        self.assertEqual(formats, {"POSITION": "f", "_I": "h", "_M": "b", "COLOR_0": "f", "_Z": "I", "NORMAL": "f",
                                   "JOINTS_0": "H", "_S": "I", "TEXCOORD_0": "f"})
        self.assertEqual(flat(primitive.targets[0]["POSITION"]), flat(primitive.positions))
        self.assertEqual(primitive.material, 0)
        self.assertEqual(primitive.indices.tolist(), [[0, 1, 2]])  # one vertex is left over
        primitive.positions[0, 0] = 7  # the arrays are the caller's

    def test_types_of_the_draft_of_2_1(self):
        made = Builder()
        rows = {"_I": (INT, "i", [-2**31, -1, 0, 2**31 - 1]), "_D": (DOUBLE, "d", [0.1, -1e300, 0.0, 5e-324]),
                "_H": (HALF, "e", [0.5, -65504.0, 0.0, 2**-24]), "_L": (LONG, "q", [-2**63, -1, 0, 2**63 - 1]),
                "_U": (ULONG, "Q", [0, 1, 2**63, 2**64 - 1])}
        attributes = {name: made.accessor("SCALAR", kind, 4, struct.pack(f"<4{code}", *values))
                      for name, (kind, code, values) in rows.items()}
        attributes["POSITION"] = made.accessor("VEC3", DOUBLE, 4, struct.pack("<12d", *[0.1] * 12))
        attributes["_N"] = made.accessor("SCALAR", INT, 4, struct.pack("<4i", -2**31, -2**31 + 1, 0, 2**31 - 1), normalized=True)
        attributes["_P"] = made.accessor("SCALAR", ULONG, 4, struct.pack("<4Q", 0, 2**62, 2**63, 2**64 - 1), normalized=True)
        attributes["WEIGHTS_0"] = made.accessor("SCALAR", LONG, 4, struct.pack("<4q", 0, 1, -3, 2**40))
        made.primitive(attributes=attributes)
        primitive, = self.read(made)
        found = primitive.attributes
        for name, (_, code, values) in rows.items():
            self.assertEqual(flat(found[name]), values, name)
            is_wide = code == "e" and arrays.numpy is None  # no memoryview has floats of 16 bits
            self.assertEqual(struct.calcsize(memoryview(found[name]).format), struct.calcsize("f" if is_wide else code), name)
        self.assertEqual(flat(found["POSITION"]), [0.1] * 12, "every bit is kept")
        self.assertEqual(flat(found["_N"]), [-1, -1, 0, 1])
        self.assertEqual(flat(found["_P"]), [0, 0.25, 0.5, 1])
        self.assertEqual(flat(found["WEIGHTS_0"]), [0, 1, -3, 2**40])
        made = Builder()
        made.primitive(attributes={"POSITION": made.positions()}, indices=made.accessor("SCALAR", LONG, 3, bytes(24)))
        self.refuses(made, "holds no indices")
        made = Builder()
        made.primitive(attributes={"POSITION": made.positions(), "_A": made.accessor("SCALAR", 5132, 4, bytes(16))})
        self.refuses(made, "componentType: is unknown")

    def test_every_mode(self):
        made = Builder()
        positions = made.positions(5)
        indices = made.accessor("SCALAR", UBYTE, 5, bytes([4, 3, 2, 1, 0]))
        for mode in range(7):
            made.primitive(attributes={"POSITION": positions}, indices=indices, mode=mode)
        kinds = [(primitive.kind, primitive.indices.tolist()) for primitive in self.read(made)]
        self.assertEqual(kinds, [
            ("points", [[4], [3], [2], [1], [0]]), ("lines", [[4, 3], [2, 1]]),
            ("lines", [[4, 3], [3, 2], [2, 1], [1, 0], [0, 4]]), ("lines", [[4, 3], [3, 2], [2, 1], [1, 0]]),
            ("triangles", [[4, 3, 2]]), ("triangles", [[4, 3, 2], [3, 1, 2], [2, 1, 0]]),
            ("triangles", [[3, 2, 4], [2, 1, 4], [1, 0, 4]])])

    def test_what_is_shared_is_read_once(self):
        made = Builder()
        positions = made.positions()
        for _ in range(2000):
            made.primitive(attributes={"POSITION": positions})
        primitives = self.read(made)
        self.assertTrue(all(primitive.positions is primitives[0].positions for primitive in primitives))
        self.assertTrue(all(primitive.indices is primitives[0].indices for primitive in primitives))

    def test_nothing_at_all(self):
        self.assertEqual(gltf_mcc.meshes(glb_of({"asset": {"version": "2.0"}})), [])

    def refuses(self, made, pattern, code="DOCUMENT", **options):
        with self.assertRaisesRegex(gltf_mcc.Error, pattern) as caught:
            gltf_mcc.meshes(made.glb(), **options)
        self.assertEqual(caught.exception.code, code)

    def test_wrong_lattices(self):
        data = (SAMPLES / "torus.glb").read_bytes()
        with self.assertRaises(ValueError):
            gltf_mcc.convert(data, position_lattice=(0, 0, 0))
        with self.assertRaises(gltf_mcc.Error):
            gltf_mcc.convert(data, position_lattice=(0, 0, 0, 0))

    def test_refusals(self):
        made = Builder()
        made.primitive(attributes={"POSITION": made.positions()}, indices=made.accessor("SCALAR", UBYTE, 3, bytes([0, 1, 4])))
        self.refuses(made, "^/meshes/0/primitives/0/indices: there are indices beyond the 4 vertices$")
        made = Builder()
        made.primitive(attributes={"POSITION": made.positions(), "_A": made.positions(5)})
        self.refuses(made, "different numbers of vertices")
        made = Builder()
        made.primitive(attributes={"POSITION": made.accessor("VEC3", FLOAT, 2**31)})
        self.refuses(made, "max_decoded_bytes", "LIMIT")
        made = Builder()
        made.primitive(attributes={"POSITION": made.positions()}, extensions={"KHR_draco_mesh_compression": {}})
        self.refuses(made, "compressed with KHR_draco_mesh_compression")
        made = Builder()
        made.primitive(attributes={"POSITION": made.positions()})
        self.refuses(made, "max_decoded_bytes", "LIMIT", max_decoded_bytes=10)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "in.gltf")
            path.write_text(json.dumps({"asset": {"version": "2.0"}, "buffers": [{"uri": "in.bin", "byteLength": 4}]}))
            with self.assertRaisesRegex(gltf_mcc.Error, "gltf-mcc decode IN.gltf OUT.glb"):
                gltf_mcc.meshes(path)

    def test_messages_begin_with_the_name_of_the_file(self):
        made = Builder()
        made.primitive(attributes={"POSITION": made.positions(), "_A": made.positions(5)})
        with tempfile.TemporaryDirectory() as folder:
            for name, content, reads in (("text.glb", b"no GLB", (gltf_mcc.convert, gltf_mcc.decode, gltf_mcc.inspect, gltf_mcc.meshes)),
                                         ("odd.glb", made.glb(), (gltf_mcc.meshes,))):
                path = Path(folder, name)
                path.write_bytes(content)
                for read in reads:
                    with self.assertRaises(gltf_mcc.Error) as of_bytes:
                        read(content)
                    for given in (path, str(path)):
                        with self.assertRaises(gltf_mcc.Error) as of_file:
                            read(given)
                        self.assertEqual(str(of_file.exception), f"{path}: {of_bytes.exception}")
                        self.assertEqual(of_file.exception.code, of_bytes.exception.code)
        with self.assertRaises(gltf_mcc.Error) as caught:  # the option is wrong, not the file
            gltf_mcc.convert(SAMPLES / "torus.glb", position_bits=99)
        self.assertNotIn("torus.glb", str(caught.exception))

    def test_false_claims_raise_nothing_else(self):
        """Every member of the JSON, one after the other, becomes something that it should not be."""
        made = Builder()
        positions = made.positions()
        sparse = made.accessor("SCALAR", UINT, 4, sparse={
            "count": 1, "indices": {"bufferView": made.view(bytes(1)), "componentType": UBYTE},
            "values": {"bufferView": made.view(bytes(4))}})
        made.primitive(attributes={"POSITION": positions, "_S": sparse}, indices=made.accessor("SCALAR", UBYTE, 3, bytes(3)),
                       targets=[{"POSITION": positions}], mode=4, material=0, extensions={})
        made.glb()
        wrong = [None, True, -1, 1, 3, 0.5, 1e300, 2**31, 2**63, 10**40, "x", "\n", [], {}, [[]], [None], {"a": []}]

        def places(value, path=()):
            yield path
            for key in (value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()):
                yield from places(value[key], (*path, key))

        refused_count = 0
        for path in list(places(made.document))[1:]:
            for value in wrong:
                document = json.loads(json.dumps(made.document))
                owner = document
                for key in path[:-1]:
                    owner = owner[key]
                owner[path[-1]] = value
                for read in (gltf_mcc.meshes, self.read_without_the_library):
                    try:
                        read(glb_of(document, made.binary))
                    except gltf_mcc.Error as error:
                        refused_count += 1
                        self.assertTrue(str(error).isprintable(), error)
        self.assertGreater(refused_count, 500)

    @staticmethod
    def read_without_the_library(glb):
        """The library refuses some of the documents before the package sees them."""
        document = accessors.Document(glb, 2**20)
        for k, mesh in enumerate(accessors.list_in(document.json, "meshes", "")):
            primitives._mesh(document, mesh, f"/meshes/{k}")


class Package(unittest.TestCase):
    def test_the_code_of_the_readme(self):
        code = "".join(part.split("```")[0] for part in README.read_text().split("```python\n")[1:3])
        positions, indices = grid(5)
        names = {"positions": positions, "indices": indices, "uvs": memoryview(bytes(4 * 2 * 25)).cast("f", (25, 2))}
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            shutil.copyfile(SAMPLES / "torus.glb", Path(folder, "in.glb"))
            os.chdir(folder)
            try:
                with contextlib.redirect_stdout(io.StringIO()) as printed:
                    exec(code, names)
            finally:
                os.chdir(before)
        self.assertEqual(names["plain"], gltf_mcc.decode(gltf_mcc.convert(SAMPLES / "torus.glb", position_bits=12)))
        self.assertEqual(names["piece"]["POSITION"].shape, (25, 3))
        self.assertEqual(names["normals"].shape, names["primitive"].positions.shape)
        self.assertIn("triangles", printed.getvalue())

    def test_versions_go_together(self):
        self.assertEqual(gltf_mcc.__version__, gltf_mcc.library_version.replace("-rc.", "rc"))

    @unittest.skipUnless(Path("/proc/self/maps").exists(), "no list of what the process has loaded")
    def test_the_library_is_the_one_that_was_asked_for(self):
        named = os.environ.get("GLTF_MCC_LIBRARY")
        folder = Path(named).parent if named else Path(gltf_mcc.__file__).parent  # a wheel with the libraries inside
        loaded = {Path(line.split()[-1]) for line in Path("/proc/self/maps").read_text().splitlines() if "gltf-mcc" in line}
        self.assertEqual({path.name.split(".")[0] for path in loaded},
                         {"libgltf-mcc", "libgltf-mcc-writer", "libgltf-mcc-reader"})
        self.assertEqual({path.parent for path in loaded}, {folder.resolve()})

    def test_a_missing_library_is_explained(self):
        environment = dict(os.environ, GLTF_MCC_LIBRARY="no-such-library.so")
        run = subprocess.run([sys.executable, "-c", "import gltf_mcc"], env=environment, stderr=subprocess.PIPE)
        self.assertIn(b"tools/build-wheel", run.stderr)
        self.assertIn(b"set GLTF_MCC_LIBRARY", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
