# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Tests of the package gltf_mcc: test_gltf_mcc.py GLTF_MCC SAMPLES README, run by package_test in an environment that has
nothing but the wheel. NumPy is used if it is there."""
import json
import os
import pickle
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
from gltf_mcc import meshes

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
                subprocess.run([PROGRAM, "convert", "--quantize-position", "12", sample, out], check=True,
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
                        {"prefer": "speed", "block_triangles": 100}):
            self.assertNotEqual(gltf_mcc.convert(data, **options), usual, options)
        self.assertEqual(gltf_mcc.convert(data, threads=2, grid="scene"), usual)

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
                      {"prefer": "x"}):
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
        self.assertEqual([(a.name, a.morph_target, a.normalized) for a in piece.attributes],
                         [("POSITION", 0, False), ("TEXCOORD_1", 0, True), ("POSITION", 1, False)])
        self.assertEqual(piece.attributes[0].coding, "lattice")
        self.assertEqual(piece.attributes[0].bits, 10)
        self.assertEqual([len(part) for part in piece.parts], [half // 3, len(indices) // 3 - half // 3])

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

    @unittest.skipIf(meshes._numpy is None, "NumPy is not installed")
    def test_numpy(self):
        numpy = meshes._numpy
        positions, indices = grid(9)
        wide = numpy.zeros((81, 8), numpy.float32)
        wide[:, 2:5] = positions.tolist()
        payload = gltf_mcc.encode_mesh({"POSITION": wide[:, 2:5]},
                                       numpy.array(indices.tolist(), numpy.uint16).reshape(-1, 3)).payload
        self.assertEqual(payload, gltf_mcc.encode_mesh({"POSITION": positions}, indices).payload)
        piece, = gltf_mcc.decode_payload(payload)
        self.assertEqual(piece["POSITION"].dtype, numpy.float32)
        self.assertEqual(piece.parts[0].shape[1], 3)


class Package(unittest.TestCase):
    def test_the_code_of_the_readme(self):
        code = README.read_text().split("```python\n")[1].split("```")[0]
        positions, indices = grid(5)
        names = {"positions": positions, "indices": indices, "uvs": memoryview(bytes(4 * 2 * 25)).cast("f", (25, 2))}
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            shutil.copyfile(SAMPLES / "torus.glb", Path(folder, "in.glb"))
            os.chdir(folder)
            try:
                exec(code, names)
            finally:
                os.chdir(before)
        self.assertEqual(names["plain"], gltf_mcc.decode(gltf_mcc.convert(SAMPLES / "torus.glb", position_bits=12)))
        self.assertEqual(names["piece"]["POSITION"].shape, (25, 3))

    def test_versions_go_together(self):
        self.assertEqual(gltf_mcc.__version__, gltf_mcc.library_version.replace("-rc.", "rc"))

    def test_a_missing_library_is_explained(self):
        environment = dict(os.environ, GLTF_MCC_LIBRARY="no-such-library.so")
        run = subprocess.run([sys.executable, "-c", "import gltf_mcc"], env=environment, stderr=subprocess.PIPE)
        self.assertIn(b"set GLTF_MCC_LIBRARY", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
