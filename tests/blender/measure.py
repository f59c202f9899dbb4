# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Measures imports inside of Blender: FOLDER GLTF_MCC FILE.glb... after "--", run by measure. FOLDER has addon.zip."""
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import bpy
import numpy
from mathutils import Vector

if not hasattr(numpy, "bool"):
    numpy.bool = bool  # see test_addon.py
FOLDER, PROGRAM, *FILES = sys.argv[sys.argv.index("--") + 1:]
RUNS = 5


def import_file(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for name in ("io_scene_gltf2", "gltf_mcc_blender"):
        bpy.ops.preferences.addon_enable(module=name)
    begin = time.perf_counter()
    bpy.ops.import_scene.gltf(filepath=str(path))
    return time.perf_counter() - begin


def draw(path):
    """Draws what was imported, with the materials that the file gives."""
    corners = [o.matrix_world @ Vector(corner) for o in bpy.data.objects if o.type == "MESH" for corner in o.bound_box]
    low, high = (Vector(pick(c[i] for c in corners) for i in range(3)) for pick in (min, max))
    centre, radius = (low + high) / 2, (high - low).length / 2
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = centre + Vector((0.55, -1, 0.5)).normalized() * 3 * radius
    camera.rotation_euler = (centre - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.angle = math.radians(42)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 1.5
    sun.rotation_euler = (0.6, 0.2, 0.5)
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (1, 1, 1, 1)
    scene = bpy.context.scene
    for item in (camera, sun):
        scene.collection.objects.link(item)
    scene.camera, scene.world = camera, world
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 48
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = 480, 360
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


bpy.ops.preferences.addon_install(filepath=str(Path(FOLDER, "addon.zip")))
rows = []
for source in FILES:
    small = Path(FOLDER, Path(source).name)
    subprocess.run([PROGRAM, "convert", source, small], check=True, stdout=subprocess.DEVNULL)
    plain_seconds = min(import_file(source) for _ in range(RUNS))
    small_seconds = min(import_file(small) for _ in range(RUNS))
    triangle_count = sum(len(mesh.polygons) for mesh in bpy.data.meshes)
    rows.append(f"| {Path(source).stem} | {triangle_count:,} | {os.path.getsize(source):,} | {small.stat().st_size:,} | "
                f"{plain_seconds:.2f} | {small_seconds:.2f} |")
if "MCC_SCREENSHOT" in os.environ:
    draw(os.path.abspath(os.environ["MCC_SCREENSHOT"]))
Path(FOLDER, "table.md").write_text("\n".join([
    "| model | triangles | bytes | compressed | import, s | import of the compressed, s |", "|---|---:|---:|---:|---:|---:|",
    *rows, "", f"Blender {bpy.app.version_string}, NumPy {numpy.__version__}."]) + "\n")
