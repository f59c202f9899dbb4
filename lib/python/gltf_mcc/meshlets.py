# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Meshlets of decoded triangles, in the layout of meshoptimizer."""
from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Any

from . import _library
from ._library import library
from .arrays import array_over
from .documents import choice, unsigned
from .errors import check
from .payloads import address, index_buffer

SHAPES = ("round", "order")


@dataclass
class Meshlets:
    """Clusters of triangles, as mesh shaders draw them.

    Attributes:
        meshlets: one row for each: where its vertices and its triangles begin (these in bytes, a multiple of 4), and
            how many of both there are
        vertices: for each meshlet its vertices, as the indices have them
        triangles: for each triangle three bytes: the numbers of its corners among the vertices of its meshlet
    """

    meshlets: Any
    vertices: Any
    triangles: Any


def build_meshlets(indices: Any, vertex_count: int, *, max_vertices: int = 64, max_triangles: int = 124,
                   shape: str = "round") -> Meshlets:
    """Divides triangles into meshlets, each of which is in one of them with its corners in their order.

    Args:
        indices: such as those of a decoded Piece or Primitive: three for each triangle, in any shape
        vertex_count: each index is below it
        max_vertices: from 3 to 256
        max_triangles: from 1 to 512
        shape: "round": the triangles around its vertices; "order": the next ones of the list, several times as fast

    Raises:
        Error: an index is too large, or an option out of range
        MemoryError: memory ran out
    """
    kept: list = []
    part = index_buffer(indices, kept)
    if part.index_count % 3 != 0:
        raise ValueError(f"there are {part.index_count} indices, no multiple of 3")
    triangle_count = unsigned(part.index_count // 3, "the number of triangles")
    options = _library.MeshletOptions()
    library.mcc_meshlet_options_init(ctypes.byref(options), ctypes.sizeof(options))
    options.max_vertices = unsigned(max_vertices, "max_vertices")
    options.max_triangles = unsigned(max_triangles, "max_triangles")
    options.shape = choice(shape, SHAPES, "shape")
    bound = library.mcc_meshlet_bound(triangle_count, ctypes.byref(options))
    memory = [bytearray(size) for size in (16 * bound.meshlet_count, 4 * bound.vertex_count, bound.triangle_bytes)]
    target = _library.MeshletTarget(*map(address, memory), bound)
    triangles = _library.TriangleList(part.indices, 4, triangle_count, unsigned(vertex_count, "vertex_count"))
    used = _library.MeshletSizes()
    check(library.mcc_build_meshlets(ctypes.byref(triangles), ctypes.byref(target), ctypes.byref(used),
                                     ctypes.byref(options)))
    meshlets, vertices, corners = memory
    return Meshlets(array_over(meshlets[:16 * used.meshlet_count], "I", (used.meshlet_count, 4)),
                    array_over(vertices[:4 * used.vertex_count], "I", (used.vertex_count,)),
                    array_over(corners[:used.triangle_bytes], "B", (used.triangle_bytes,)))
