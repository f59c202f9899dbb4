# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Compresses and decompresses glTF meshes with KHR_mesh_collapse_compression.

    import gltf_mcc

    small = gltf_mcc.convert("in.glb", position_bits=12)
    plain = gltf_mcc.decode(small)
    facts = gltf_mcc.inspect(small)
    for mesh in gltf_mcc.meshes(small):
        for primitive in mesh.primitives:
            primitive.positions, primitive.indices, primitive.attributes["NORMAL"]

The functions call the shared library of gltf-mcc; no compiler is needed. They may be called by several threads at
the same time, and release the interpreter's lock while they work.
"""
from ._library import library as _the_library
from ._version import VERSION
from .documents import PREVIEWS_BY_SHARE, convert, decode, inspect
from .errors import Error
from .meshlets import Meshlets, build_meshlets
from .payloads import Attribute, Encoding, Piece, decode_payload, encode_mesh
from .primitives import Mesh, Primitive, meshes

__version__ = VERSION
library_version: str = _the_library.mcc_version().decode()

__all__ = ["Attribute", "Encoding", "Error", "Mesh", "Meshlets", "PREVIEWS_BY_SHARE", "Piece", "Primitive",
           "build_meshlets", "convert", "decode", "decode_payload", "encode_mesh", "inspect", "library_version", "meshes"]
