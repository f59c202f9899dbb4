# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Blender add-on: Blender's glTF importer reads files with KHR_mesh_collapse_compression, and File > Export writes them.

Blender's importer looks for glTF2ImportUserExtension in every add-on that is enabled.
"""
import os
from pathlib import Path

bl_info = {
    "name": "glTF mesh collapse compression",
    "author": "The gltf-mcc authors",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > glTF 2.0; File > Export > glTF 2.0, compressed (.glb)",
    "description": "Reads and writes glTF files with KHR_mesh_collapse_compression",
    "category": "Import-Export",
}

# The zip may hold the shared library, next to those that it needs; GLTF_MCC_LIBRARY names another one.
for _library in Path(__file__).parent.glob("*gltf-mcc.[sd]*"):
    os.environ.setdefault("GLTF_MCC_LIBRARY", str(_library))

from . import exporter  # noqa: E402 (the library must be named before it is loaded)
from .importer import glTF2ImportUserExtension  # noqa: E402, F401 (Blender's importer looks for it here)


def register():
    exporter.register()


def unregister():
    exporter.unregister()
