# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""The meshes of a file as named arrays."""
from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Sequence

from .accessors import Document, count_in, list_in, object_in, refuse, refuse_foreign, text_in
from .arrays import array_over, numpy
from .documents import Source, decode, unsigned
from .errors import naming

_FLOATS = ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_", "COLOR_", "WEIGHTS_")  # what no program wants as integers
_KINDS = ("points", "lines", "lines", "lines", "triangles", "triangles", "triangles")  # by `mode`
_WIDTHS = {"points": 1, "lines": 2, "triangles": 3}


@dataclass
class Primitive:
    """One primitive: vertices that share a material, and what they form.

    Attributes:
        kind: "triangles", "lines" or "points"
        indices: uint32, a row for each triangle, line or point; strips, fans and loops are taken apart
        attributes: arrays by their names in glTF, such as "NORMAL" or "TEXCOORD_0": a row for each vertex, a column for
            each component (of a matrix, column by column). float32, except for JOINTS_n and the attributes of
            applications, which keep their type unless they are normalized.
        targets: the same for the displacements of each morph target
        material: its number in the file, or None
    """

    kind: str
    indices: Any
    attributes: Dict[str, Any]
    targets: List[Dict[str, Any]]
    material: Optional[int]

    @property
    def positions(self) -> Any:
        """attributes["POSITION"], float32 in the coordinates of the mesh: nodes may still move, turn and scale it."""
        return self.attributes["POSITION"]


@dataclass
class Mesh:
    """One mesh of a file.

    Attributes:
        name: as in the file, or ""
        primitives: its primitives, in the order of the file
    """

    name: str
    primitives: List[Primitive]


def meshes(source: Source, *, thread_count: int = 1, max_decoded_bytes: int = 0) -> List[Mesh]:
    """Returns the meshes of a GLB as arrays, whether they are compressed or not.

        for mesh in gltf_mcc.meshes("small.glb"):
            for primitive in mesh.primitives:
                print(mesh.name, primitive.positions.shape, primitive.indices.shape, *primitive.attributes)

    The arrays are NumPy's where NumPy is installed, else memoryviews of the same shape. Primitives that share an
    accessor share the array. Every index is below the number of vertices.

    Safe for untrusted input.

    Args:
        source: the bytes of a GLB, or the path of a .glb file
        thread_count: how many threads decode
        max_decoded_bytes: bounds what compressed meshes decode to, as in decode(), and the bytes of all arrays; by
            default the arrays may take eight bytes for each byte of the decoded GLB, and at least 256 MiB

    Raises:
        Error: the file is not a GLB, or is damaged, or a mesh is compressed with another codec
        OSError: the file cannot be read
        MemoryError: memory ran out
    """
    limit = unsigned(max_decoded_bytes, "max_decoded_bytes", 64)
    plain = decode(source, thread_count=thread_count, max_decoded_bytes=limit)
    with naming(source):
        document = Document(plain, limit or max(2**28, 8 * len(plain)))
        return [_mesh(document, mesh, f"/meshes/{k}") for k, mesh in enumerate(list_in(document.json, "meshes", ""))]


def _mesh(document: Document, mesh: Any, path: str) -> Mesh:
    if not isinstance(mesh, dict):
        raise refuse(path, "is not an object")
    made = [_primitive(document, primitive, f"{path}/primitives/{k}")
            for k, primitive in enumerate(list_in(mesh, "primitives", path))]
    return Mesh(text_in(mesh, "name"), made)


def _primitive(document: Document, primitive: Any, path: str) -> Primitive:
    if not isinstance(primitive, dict):
        raise refuse(path, "is not an object")
    refuse_foreign(primitive, path)
    mode = count_in(primitive, "mode", path, 4)
    if mode >= len(_KINDS):
        raise refuse(f"{path}/mode", "is unknown")
    attributes = _arrays(document, object_in(primitive, "attributes", path), f"{path}/attributes")
    targets = []
    for k, target in enumerate(list_in(primitive, "targets", path)):
        if not isinstance(target, dict):
            raise refuse(f"{path}/targets/{k}", "is not an object")
        targets.append(_arrays(document, target, f"{path}/targets/{k}"))
    counts = {array.shape[0] for arrays in [attributes, *targets] for array in arrays.values()}
    if len(counts) > 1:
        raise refuse(path, f"its attributes have different numbers of vertices: {sorted(counts)}")
    accessor = count_in(primitive, "indices", path) if "indices" in primitive else None
    indices = _indices(document, accessor, mode, max(counts, default=0), path)
    material = count_in(primitive, "material", path) if "material" in primitive else None
    return Primitive(_KINDS[mode], indices, attributes, targets, material)


def _arrays(document: Document, accessors: Dict[str, Any], path: str) -> Dict[str, Any]:
    return {name: document.values(count_in(accessors, name, path), name.startswith(_FLOATS), f"{path}/{name}")
            for name in accessors}


def _indices(document: Document, accessor: Optional[int], mode: int, vertex_count: int, path: str) -> Any:
    """Returns the indices of a primitive, which may have none: then its vertices follow each other."""
    def make_flat() -> bytes:
        if accessor is not None:
            return document.indices(accessor, f"{path}/indices")
        document.take(4 * vertex_count)
        return _packed(range(vertex_count))

    def make() -> Any:
        flat = make_flat()
        width = _WIDTHS[_KINDS[mode]]
        if mode in (2, 3, 5, 6):
            document.take(4 * width * (len(flat) // 4))
            flat = _packed(_taken_apart(mode, memoryview(flat).cast("I")))
        else:
            document.take(len(flat))
        memory = bytearray(flat[:len(flat) // (4 * width) * 4 * width])  # an unfinished triangle is not drawn
        return array_over(memory, "I", (len(memory) // (4 * width), width))

    key = ("drawn", mode, accessor) if accessor is not None else ("drawn", mode, None, vertex_count)
    indices = document.once(key, make)
    if accessor is not None and document.once(("highest", accessor), lambda: _highest(make_flat())) >= vertex_count:
        raise refuse(f"{path}/indices", f"there are indices beyond the {vertex_count} vertices")
    return indices


def _packed(numbers: Sequence[int]) -> bytes:
    if numpy is not None:
        return numpy.asarray(numbers, "I").tobytes()
    return struct.pack(f"{len(numbers)}I", *numbers)


def _highest(flat: bytes) -> int:
    if numpy is not None:
        return int(numpy.frombuffer(flat, "I").max(initial=0)) if flat else -1
    return max(memoryview(flat).cast("I"), default=-1)


def _taken_apart(mode: int, v: Sequence[int]) -> List[int]:
    """Returns the lines of a loop (2) or strip (3), or the triangles of a strip (5) or fan (6), as glTF 2.0 (3.7.2.1)
    orders them."""
    if mode == 2:
        return [k for i in range(len(v)) for k in (v[i], v[(i + 1) % len(v)])]
    if mode == 3:
        return [k for i in range(len(v) - 1) for k in (v[i], v[i + 1])]
    if mode == 5:
        return [k for i in range(len(v) - 2) for k in (v[i], v[i + 1 + i % 2], v[i + 2 - i % 2])]
    return [k for i in range(len(v) - 2) for k in (v[i + 1], v[i + 2], v[0])]
