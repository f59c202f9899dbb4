# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Tests of the add-on inside of Blender: ADDON.zip GLTF_MCC SAMPLES after "--", run by addon_test."""
import base64
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import bpy
import numpy

if not hasattr(numpy, "bool"):
    # Debian 12's Blender 3.4 cannot import any glTF file with Debian 12's NumPy 1.24, which has dropped this name.
    numpy.bool = bool

ZIP, PROGRAM, SAMPLES = sys.argv[sys.argv.index("--") + 1:]
MODELS = sorted(Path(SAMPLES).glob("*.glb"))
EXTENSION = "KHR_mesh_collapse_compression"


def import_file(path):
    """Imports a file into an empty scene and returns what its meshes are."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Factory settings switch add-ons off.
    for name in ("io_scene_gltf2", "gltf_mcc_blender"):
        bpy.ops.preferences.addon_enable(module=name)
    assert bpy.ops.import_scene.gltf(filepath=str(path)) == {"FINISHED"}
    return {o.name: described(o) for o in bpy.data.objects if o.type == "MESH"}


def described(item):
    """Lists everything of a mesh that a file can hold, in its own order."""
    mesh = item.data
    mesh.calc_normals_split()
    groups = {group.index: group.name for group in item.vertex_groups}
    vertices = [(tuple(v.co), tuple(sorted((groups[g.group], g.weight) for g in v.groups))) for v in mesh.vertices]
    keys = mesh.shape_keys.key_blocks if mesh.shape_keys else []
    return {
        "vertices": vertices,
        "normals": [tuple(loop.normal) for loop in mesh.loops],
        "corners": [loop.vertex_index for loop in mesh.loops],
        "triangles": [(tuple(p.loop_indices), p.material_index) for p in mesh.polygons],
        "uvs": {layer.name: [tuple(x.uv) for x in layer.data] for layer in mesh.uv_layers},
        "colors": {layer.name: [tuple(x.color) for x in layer.data] for layer in mesh.color_attributes},
        "keys": {key.name: [tuple(x.co) for x in key.data] for key in keys},
    }


def triangles_of(mesh):
    """Returns the triangles with all that their corners carry but normals, without an order."""
    found = []
    for loops, material in mesh["triangles"]:
        corners = []
        for loop in loops:
            v = mesh["corners"][loop]
            corners.append((mesh["vertices"][v], tuple(uv[loop] for uv in mesh["uvs"].values()),
                            tuple(color[loop] for color in mesh["colors"].values()),
                            tuple(key[v] for key in mesh["keys"].values())))
        first = corners.index(min(corners))
        found.append((tuple(corners[first:] + corners[:first]), material))
    return sorted(found)


def normals_of(mesh):
    """Returns the normals of the corners of triangles, in an order that follows from the positions. Triangles with
    two equal positions are left out: their corners cannot be told from each other."""
    found = []
    for loops, _ in mesh["triangles"]:
        corners = [(mesh["vertices"][mesh["corners"][loop]][0], mesh["normals"][loop]) for loop in loops]
        first = corners.index(min(corners))
        if len({position for position, _ in corners}) == 3:
            found.append(corners[first:] + corners[:first])
    return sorted(found, key=lambda corners: [position for position, _ in corners])


def gltf_of(path):
    """Returns the JSON of a GLB."""
    data = Path(path).read_bytes()
    return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])


class Addon(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return Path(self.folder.name, name)

    def run_program(self, *arguments):
        subprocess.run([PROGRAM, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    def compressed(self, model, *options):
        small = self.path("small.glb")
        small.unlink(missing_ok=True)
        self.run_program("convert", *options, model, small)
        return small

    def test_import_is_that_of_the_decoded_file(self):
        for model in MODELS:
            with self.subTest(model.name):
                small, plain = self.compressed(model), self.path("plain.glb")
                plain.unlink(missing_ok=True)
                self.run_program("decode", small, plain)
                self.assertEqual(import_file(small), import_file(plain))

    def test_lossless_import_is_that_of_the_source(self):
        for model in MODELS:
            with self.subTest(model.name):
                small = import_file(self.compressed(model, "--lossless"))
                plain = import_file(model)
                self.assertEqual(small.keys(), plain.keys())
                for name in plain:
                    self.assertEqual(triangles_of(small[name]), triangles_of(plain[name]))

    def test_what_the_source_has_is_there(self):
        self.assertTrue(any(m["keys"] for m in import_file(self.compressed(Path(SAMPLES, "morphed.glb"))).values()))
        skinned = import_file(self.compressed(Path(SAMPLES, "skinned.glb")))
        self.assertTrue(all(groups for m in skinned.values() for _, groups in m["vertices"]))
        textured = import_file(self.compressed(Path(SAMPLES, "textured.glb")))
        self.assertTrue(all(m["uvs"] for m in textured.values()))

    def test_files_with_buffers_of_their_own(self):
        small = self.compressed(Path(SAMPLES, "torus.glb"))
        data = small.read_bytes()
        json_bytes = struct.unpack_from("<I", data, 12)[0]
        document, binary = gltf_of(small), data[28 + json_bytes:]
        expected = import_file(small)
        beside = json.loads(json.dumps(document))
        beside["buffers"][0]["uri"] = "some%20data.bin"
        self.path("some data.bin").write_bytes(binary)
        self.path("beside.gltf").write_text(json.dumps(beside))
        self.assertEqual(import_file(self.path("beside.gltf")), expected)
        inside = json.loads(json.dumps(document))
        inside["buffers"].insert(0, {"uri": "data:;base64,AAAAAAA=", "byteLength": 5})
        inside["buffers"][1]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
        for view in inside["bufferViews"]:
            view["buffer"] = 1
        self.path("inside.gltf").write_text(json.dumps(inside))
        self.assertEqual(import_file(self.path("inside.gltf")), expected)

    def test_damage_is_refused_with_its_reason(self):
        small = self.compressed(Path(SAMPLES, "torus.glb"))
        data = bytearray(small.read_bytes())
        data[-20] ^= 4
        small.write_bytes(data)
        with self.assertRaisesRegex(RuntimeError, "checksum"):
            import_file(small)
        self.assertFalse([o for o in bpy.data.objects if o.type == "MESH"])

    def test_other_files_are_as_ever(self):
        self.assertTrue(import_file(Path(SAMPLES, "sphere.glb")))

    def test_export_and_import_again(self):
        for name in ("morphed.glb", "skinned.glb", "textured.glb", "two_materials.glb"):
            with self.subTest(name):
                import_file(Path(SAMPLES, name))
                plain, small = self.path("plain.glb"), self.path("exported.glb")
                bpy.ops.export_scene.gltf(filepath=str(plain), export_format="GLB")
                self.assertEqual(bpy.ops.export_scene.gltf_mcc(filepath=str(small), lossless=True), {"FINISHED"})
                self.assertIn(EXTENSION, gltf_of(small)["extensionsRequired"])
                self.assertLess(small.stat().st_size, plain.stat().st_size)
                before, after = import_file(plain), import_file(small)
                self.assertEqual(before.keys(), after.keys())
                for mesh in before:
                    self.assertEqual(triangles_of(after[mesh]), triangles_of(before[mesh]))
                    for a, b in zip(normals_of(after[mesh]), normals_of(before[mesh])):
                        for (_, x), (_, y) in zip(a, b):
                            self.assertLess(math.dist(x, y), 2e-3)  # Blender keeps 16 bits of a normal

    def test_export_has_bits(self):
        import_file(Path(SAMPLES, "textured.glb"))
        sizes = []
        for bits in (6, 12, 24):
            bpy.ops.export_scene.gltf_mcc(filepath=str(self.path(f"{bits}.glb")), position_bits=bits)
            sizes.append(self.path(f"{bits}.glb").stat().st_size)
        self.assertEqual(sizes, sorted(sizes))
        self.assertLess(sizes[0], sizes[2])

    def test_export_has_a_quality_and_a_step(self):
        import_file(Path(SAMPLES, "textured.glb"))
        sizes = []
        for pixels in (64, 1024, 16384):
            bpy.ops.export_scene.gltf_mcc(filepath=str(self.path(f"{pixels}.glb")), quality=pixels)
            sizes.append(self.path(f"{pixels}.glb").stat().st_size)
        self.assertEqual(sizes, sorted(sizes))
        self.assertLess(sizes[0], sizes[2])
        step = 2.0**-6
        bpy.ops.export_scene.gltf_mcc(filepath=str(self.path("step.glb")), step=step)
        plain = self.path("plain.glb")
        self.run_program("decode", self.path("step.glb"), plain)
        for mesh in import_file(plain).values():
            for position, _ in mesh["vertices"]:
                for coordinate in position:
                    self.assertEqual(coordinate / step, round(coordinate / step))
        with self.assertRaisesRegex(RuntimeError, "quality"):
            bpy.ops.export_scene.gltf_mcc(filepath=str(self.path("both.glb")), step=step, quality=1024)

    def test_export_has_a_preview(self):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True, app_template="")
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=230, y_subdivisions=230)
        bpy.ops.export_scene.gltf_mcc(filepath=str(self.path("preview.glb")), preview_triangles=500)
        extension, = (primitive["extensions"][EXTENSION]
                      for mesh in gltf_of(self.path("preview.glb"))["meshes"] for primitive in mesh["primitives"])
        self.assertIn("bufferView", extension["preview"])
        mesh, = import_file(self.path("preview.glb")).values()
        self.assertEqual(len(triangles_of(mesh)), 2 * 230 * 230)

    def test_remembered_options(self):
        import_file(Path(SAMPLES, "textured.glb"))
        bpy.context.scene["glTF2ExportSettings"] = {"export_texcoords": False, "of_a_later_version": 1}
        bpy.ops.export_scene.gltf_mcc(filepath=str(self.path("without.glb")))
        bpy.ops.export_scene.gltf_mcc(filepath=str(self.path("with.glb")), use_remembered=False)
        attributes = [gltf_of(self.path(f"{name}.glb"))["meshes"][0]["primitives"][0]["attributes"]
                      for name in ("without", "with")]
        self.assertEqual(["TEXCOORD_0" in a for a in attributes], [False, True])

    def test_the_code_of_the_readme(self):
        code = Path("lib/blender/README.md").read_text().split("```python\n")[1].split("```")[0]
        self.compressed(Path(SAMPLES, "torus.glb")).rename(self.path("in.glb"))
        import_file(self.path("in.glb"))
        bpy.ops.object.select_all(action="DESELECT")
        before = os.getcwd()
        os.chdir(self.folder.name)
        try:
            exec(code, {"bpy": bpy})
        finally:
            os.chdir(before)
        self.assertIn(EXTENSION, gltf_of(self.path("out.glb"))["extensionsRequired"])

    def test_export_that_fails_leaves_the_old_file(self):
        import_file(Path(SAMPLES, "sphere.glb"))
        with self.assertRaisesRegex(RuntimeError, "no such folder"):
            bpy.ops.export_scene.gltf_mcc(filepath=str(self.path("no such folder/a.glb")))


bpy.ops.preferences.addon_install(filepath=ZIP)
bpy.ops.preferences.addon_enable(module="gltf_mcc_blender")
result = unittest.main(argv=["test_addon"], exit=False, verbosity=2).result
print(f"{result.testsRun} tests in Blender {bpy.app.version_string}")
sys.exit(0 if result.wasSuccessful() else 1)
