# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""File > Export > glTF 2.0, compressed: Blender's own exporter, and then the converter."""
import os
import tempfile
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from . import gltf_mcc

# Under this name Blender's exporter keeps its options in a scene if "Remember Export Settings" is on.
REMEMBERED = "glTF2ExportSettings"
BITS = ("position_bits", "normal_bits", "texcoord_bits", "color_bits", "weight_bits")


class ExportCompressed(bpy.types.Operator, ExportHelper):
    """Export the scene as a GLB whose meshes are compressed"""
    bl_idname = "export_scene.gltf_mcc"
    bl_label = "Export compressed glTF"

    filename_ext = ".glb"
    filter_glob: StringProperty(default="*.glb", options={"HIDDEN"})

    lossless: BoolProperty(name="Lossless", description="Every number keeps every bit", default=False)
    quality: IntProperty(
        name="Quality", description="If not 0, how large a mesh is drawn, from 16 pixels on: no position moves by more than "
                                    "a pixel, and all bits follow; 4096 is usual", default=0, min=0, max=2**20)
    step: FloatProperty(
        name="Step", description="If not 0, a power of two such as 0.0009765625: the step of a lattice of positions through "
                                 "the origin, so that everything exported with the same step fits together",
        default=0.0, min=0.0, precision=6)
    position_bits: IntProperty(
        name="Position", description="Bits of a coordinate; 0 keeps every bit", default=14, min=0, max=24)
    normal_bits: IntProperty(name="Normal", description="0 keeps every bit", default=10, min=0, max=16)
    texcoord_bits: IntProperty(name="UV", description="0 keeps every bit", default=12, min=0, max=24)
    color_bits: IntProperty(name="Colour", description="0 keeps every bit", default=8, min=0, max=24)
    weight_bits: IntProperty(name="Weight", description="0 keeps every bit", default=12, min=0, max=24)
    prefer: EnumProperty(name="Prefer", items=[
        ("balanced", "Balanced", "Small, and quick to decode"),
        ("size", "Size", "As small as possible"),
        ("speed", "Speed", "As quick to decode as possible")])
    keep_vertex_order: BoolProperty(
        name="Keep vertex order", description="Decoded vertices come in the order that Blender exports", default=False)
    preview_triangles: IntProperty(
        name="Preview", description="If not 0, about how many triangles the coarse versions have that meshes of 100,000 "
                                    "triangles and more get in front, for web pages to show first; 5000 is usual",
        default=0, min=0)

    use_selection: BoolProperty(name="Selected objects", description="Only selected objects", default=False)
    export_apply: BoolProperty(name="Apply modifiers", description="Excluding armatures", default=False)
    export_animations: BoolProperty(name="Animations", default=True)
    use_remembered: BoolProperty(
        name="Other options as remembered",
        description='Options that are not listed here are those of the last export as glTF 2.0 with "Remember Export '
                    'Settings"', default=True)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(heading="Compression")
        column.prop(self, "lossless")
        lossy = layout.column()
        lossy.enabled = not self.lossless
        lossy.prop(self, "quality")
        lossy.prop(self, "step")
        bits = layout.column(heading="Bits")
        bits.enabled = not self.lossless and self.quality == 0
        for name in BITS:
            bits.prop(self, name)
        layout.prop(self, "prefer")
        layout.prop(self, "keep_vertex_order")
        layout.prop(self, "preview_triangles")
        layout.separator()
        column = layout.column(heading="Include")
        for name in ("use_selection", "export_apply", "export_animations", "use_remembered"):
            column.prop(self, name)

    def execute(self, context):
        try:
            plain, small = self.compress(context)
            write(Path(self.filepath), small)
        except (gltf_mcc.Error, OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{self.filepath}: {plain:,} bytes became {len(small):,}")
        return {"FINISHED"}

    def compress(self, context):
        """Returns the size of what Blender exports, and the compressed GLB."""
        with tempfile.TemporaryDirectory() as folder:
            plain = os.path.join(folder, "scene.glb")
            options = dict(context.scene.get(REMEMBERED, {})) if self.use_remembered else {}
            options.update(
                filepath=plain, export_format="GLB", export_draco_mesh_compression_enable=False, will_save_settings=False,
                use_selection=self.use_selection, export_apply=self.export_apply,
                export_animations=self.export_animations)
            known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
            bpy.ops.export_scene.gltf(**{name: value for name, value in options.items() if name in known})
            small = gltf_mcc.convert(
                plain, lossless=self.lossless, prefer=self.prefer, keep_vertex_order=self.keep_vertex_order,
                preview_triangles=self.preview_triangles, thread_count=os.cpu_count() or 1, **self.precision())
            return os.path.getsize(plain), small

    def precision(self):
        """Returns the options for what may be lost. The library refuses those that exclude each other."""
        if self.lossless:
            return {}
        options = {"step": self.step, "quality": self.quality}
        if self.quality == 0:
            options.update((name, getattr(self, name)) for name in BITS)
        return options


def write(path, data):
    """Replaces a file at once, so that a full disk leaves the old one as it was."""
    unfinished = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        unfinished.write_bytes(data)
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def menu(self, context):
    self.layout.operator(ExportCompressed.bl_idname, text="glTF 2.0, compressed (.glb)")


def register():
    bpy.utils.register_class(ExportCompressed)
    bpy.types.TOPBAR_MT_file_export.append(menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(menu)
    bpy.utils.unregister_class(ExportCompressed)
