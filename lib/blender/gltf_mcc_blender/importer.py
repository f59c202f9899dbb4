# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Decodes a file into Blender's glTF importer before it looks at the meshes."""
import json
import struct

from . import gltf_mcc

EXTENSION = "KHR_mesh_collapse_compression"


class glTF2ImportUserExtension:  # noqa: N801 (Blender's importer looks for this name)
    def __init__(self):
        from io_scene_gltf2.io.com.gltf2_io_extensions import Extension
        self.extensions = [Extension(name=EXTENSION, extension={}, required=True)]

    def gather_import_gltf_before_hook(self, importer):
        if EXTENSION not in (importer.data.extensions_used or ()):
            return
        try:
            replace(importer, gltf_mcc.decode(source_of(importer)))
        except Exception as error:
            # The importer prints what a hook raises and goes on, with meshes that are empty. So the document becomes
            # one that cannot be read: the import ends, and Blender shows the reason.
            importer.data = Refused(str(error))


class Refused:
    """A document that was refused. Everything that is asked of it raises the importer's own error."""

    def __init__(self, reason):
        self.__dict__["reason"] = reason

    def __getattr__(self, name):
        from io_scene_gltf2.io.imp.gltf2_io_gltf import ImportError as ImporterError
        raise ImporterError(self.__dict__["reason"])


def source_of(importer):
    """Returns the bytes of the file as a GLB. A .gltf gets its buffers as one."""
    with open(importer.filename, "rb") as file:
        content = file.read()
    if content[:4] == b"glTF":
        return content
    document = json.loads(content)
    binary = bytearray()
    for number, buffer in enumerate(document.get("buffers", [])):
        importer.load_buffer(number)
        data = bytes(importer.buffers.get(number) or b"")[:buffer["byteLength"]]
        for view in document.get("bufferViews", []):
            if view["buffer"] == number:
                view["byteOffset"] = view.get("byteOffset", 0) + len(binary)
        binary += data.ljust((buffer["byteLength"] + 3) // 4 * 4, b"\0")
    for view in document.get("bufferViews", []):
        view["buffer"] = 0
    if "buffers" in document:
        document["buffers"] = [{"byteLength": len(binary)}]
    return glb_of(json.dumps(document).encode(), bytes(binary))


def glb_of(text, binary):
    text = text.ljust((len(text) + 3) // 4 * 4, b" ")
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def replace(importer, glb):
    """Makes the importer go on with the document of a GLB."""
    from io_scene_gltf2.io.com.gltf2_io import gltf_from_dict
    document, binary = importer.load_glb(memoryview(glb))
    importer.data = gltf_from_dict(document)
    importer.glb_buffer = binary
    importer.buffers = {}
