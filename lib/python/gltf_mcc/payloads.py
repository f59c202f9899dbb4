# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Single meshes: payloads to arrays, arrays to payloads. Arrays that go in are anything with the buffer protocol."""
from __future__ import annotations

import ctypes
import zlib
from dataclasses import dataclass, field
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

from . import _library
from ._library import library
from .arrays import array_over
from .documents import PREFERENCES, Source, bytes_of, choice, unsigned
from .errors import check

_SEMANTICS = ("POSITION", "NORMAL", "TANGENT", "TEXCOORD", "COLOR", "JOINTS", "WEIGHTS")
_CUSTOM = 7
_BASE = -1  # what Attribute.target is for the mesh itself
_NUMBERED = {"TEXCOORD", "COLOR", "JOINTS", "WEIGHTS"}
_FORMATS = "bBhHIf"  # of struct and memoryview, by the number of the component type


@dataclass
class Attribute:
    """One vertex attribute of a decoded piece.

    Attributes:
        name: as in glTF, such as "TEXCOORD_0"; a custom one is "_CUSTOM_" and its number in the payload, since
            payloads do not hold its name
        data: one row for each vertex, one column for each component
        normalized: integers stand for fractions
        target: -1 for the mesh itself, else the index of a morph target, from 0, whose deltas these are
        coding: "lattice", "integer", "exact float", "octahedral", "tangent angle", "alias" or "grid"
        bits: the bits that were kept, 0 if that says nothing about the coding
    """

    name: str
    data: Any
    normalized: bool
    target: int
    coding: str
    bits: int


@dataclass
class Piece:
    """A set of vertices with its triangle lists.

    Attributes:
        attributes: the first is POSITION
        parts: the indices of each triangle list, one row of three for each triangle; each is one glTF primitive
    """

    attributes: List[Attribute] = field(default_factory=list)
    parts: List[Any] = field(default_factory=list)

    def __getitem__(self, name: str) -> Any:
        """Returns the data of an attribute of the base mesh: piece["POSITION"]."""
        for attribute in self.attributes:
            if attribute.name == name and attribute.target == _BASE:
                return attribute.data
        raise KeyError(name)


@dataclass
class Encoding:
    """A finished payload.

    Attributes:
        payload: the bytes for the buffer view
        source_vertices: entry i is the vertex of the source that decoded vertex i carries
    """

    payload: bytes
    source_vertices: Any


def decode_payload(payload: Source, *, max_vertices: Optional[int] = None, max_triangles: Optional[int] = None,
                   max_output_bytes: Optional[int] = None) -> List[Piece]:
    """Decodes one payload, the bytes of a compressed buffer view, into arrays of its own.

    Safe for untrusted input: the counts are checked against the bounds before memory is taken.

    Args:
        payload: its bytes, or the path of a file that holds them
        max_vertices, max_triangles: bounds of all pieces together, 2^28 by default
        max_output_bytes: bounds the bytes of all attributes and indices; none by default

    Raises:
        Error: the payload is damaged or above a bound
        MemoryError: memory ran out
    """
    data = bytes_of(payload)
    options = _library.OpenOptions()
    library.mcc_open_options_init(ctypes.byref(options), ctypes.sizeof(options))
    given = {"max_vertices": max_vertices, "max_triangles": max_triangles, "max_output_bytes": max_output_bytes}
    for name, value in given.items():
        if value is not None:
            setattr(options, name, unsigned(value, name, 64))
    opened = ctypes.c_void_p()
    check(library.mcc_payload_open(data, len(data), ctypes.byref(options), ctypes.byref(opened)))
    try:
        made = [_piece(opened, k) for k in range(library.mcc_payload_piece_count(opened))]
        targets = (_library.PieceTarget * len(made))(*(target for _, target in made))
        check(library.mcc_payload_decode(opened, targets, len(targets), None))
        return [piece for piece, _ in made]
    finally:
        library.mcc_payload_close(opened)


def encode_mesh(attributes: Mapping[str, Any], indices: Any, *, bits: Optional[Mapping[str, int]] = None,
                normalized: Sequence[str] = (), morph_targets: Sequence[Mapping[str, Any]] = (),
                keep_vertex_order: bool = False, keep_triangle_order: bool = False, prefer: str = "balanced",
                block_triangles: Optional[int] = None) -> Encoding:
    """Compresses one mesh into a payload.

    Args:
        attributes: arrays by their names in glTF, POSITION first or not; int8, uint8, int16, uint16, uint32 or
            float32, one row for each vertex
        indices: the triangles, three indices for each, in any shape; or a list of such arrays, one for each part
        bits: how many bits to keep of float attributes, by name; every bit of those that are not named
        normalized: names of the integer attributes that stand for fractions
        morph_targets: the deltas of each target, by name
        keep_vertex_order, keep_triangle_order: decoded elements come in the order given here
        prefer: "balanced", "size" or "speed" of decoding
        block_triangles: triangles of a block of a large surface, 0 for no blocks; None: `prefer` decides

    Raises:
        Error: an index is too large, POSITION is missing, or bits are out of range
        ValueError: an array has a type or a shape that a mesh cannot have
        MemoryError: memory ran out
    """
    if "POSITION" not in attributes:
        raise ValueError("attributes have no POSITION")
    sources = [("POSITION", attributes["POSITION"], _BASE)]
    sources += [(name, array, _BASE) for name, array in attributes.items() if name != "POSITION"]
    sources += [(name, array, k) for k, target in enumerate(morph_targets) for name, array in target.items()]
    kept: List[Any] = []  # what the structs point to
    views = (_library.AttributeView * len(sources))()
    counts = set()
    for view, (name, array, target) in zip(views, sources):
        counts.add(_fill_view(view, name, array, target, kept))
        view.format.normalized = name in normalized
        view.quantization_bits = unsigned((bits or {}).get(name, 0), f"bits of {name}")
    if len(counts) != 1:
        raise ValueError(f"attributes have different numbers of vertices: {sorted(counts)}")
    lists = [index_buffer(part, kept) for part in (indices if isinstance(indices, (list, tuple)) and indices
                                                    and not isinstance(indices[0], int) else [indices])]
    parts = (_library.PartView * len(lists))(*lists)
    view = _library.PieceView(counts.pop(), views, len(views), parts, len(parts))
    options = _library.EncodeOptions()
    library.mcc_encode_options_init(ctypes.byref(options), ctypes.sizeof(options))
    options.keep_vertex_order = keep_vertex_order
    options.keep_triangle_order = keep_triangle_order
    options.prefer = choice(prefer, PREFERENCES, "prefer")
    if block_triangles is not None:
        options.block_triangles = unsigned(block_triangles, "block_triangles")
    return _encode(view, options)


def _encode(view: _library.PieceView, options: _library.EncodeOptions) -> Encoding:
    encoding = ctypes.c_void_p()
    check(library.mcc_encode(ctypes.byref(view), 1, ctypes.byref(options), ctypes.byref(encoding)))
    try:
        size = ctypes.c_size_t()
        payload = ctypes.string_at(library.mcc_encoding_payload(encoding, ctypes.byref(size)), size.value)
        wedges = library.mcc_encoding_source_wedges(encoding, 0, ctypes.byref(size))
        source = bytearray(ctypes.string_at(wedges, 4 * size.value) if wedges else b"")
        return Encoding(payload, array_over(source, "I", (size.value,)))
    finally:
        library.mcc_encoding_release(encoding)


def address(memory: bytearray) -> Optional[int]:
    """Returns where memory is, or None if it is empty. The caller keeps it alive and unchanged in size."""
    return ctypes.addressof(ctypes.c_char.from_buffer(memory)) if memory else None


def _piece(opened: ctypes.c_void_p, number: int) -> Tuple[Piece, _library.PieceTarget]:
    """Allocates the arrays of a piece and returns it with the target that says where they are."""
    info = _library.PieceInfo(ctypes.sizeof(_library.PieceInfo))
    check(library.mcc_payload_piece(opened, number, ctypes.byref(info)))
    piece = Piece()
    attributes = (_library.AttributeTarget * info.attribute_count)()
    for k, target in enumerate(attributes):
        facts = _library.AttributeInfo(ctypes.sizeof(_library.AttributeInfo))
        check(library.mcc_payload_attribute(opened, number, k, ctypes.byref(facts)))
        element_bytes = library.mcc_element_bytes(ctypes.byref(facts.format))
        memory = bytearray(element_bytes * info.wedge_count)
        target.data = address(memory)
        target.stride_bytes = element_bytes
        piece.attributes.append(_attribute(facts, memory, info.wedge_count))
    parts = (_library.PartTarget * info.part_count)()
    for k, target in enumerate(parts):
        count = ctypes.c_uint32()
        check(library.mcc_payload_part(opened, number, k, ctypes.byref(count)))
        memory = bytearray(12 * count.value)
        target.indices = address(memory)
        target.index_bytes = 4
        piece.parts.append(array_over(memory, "I", (count.value, 3)))
    return piece, _library.PieceTarget(attributes, len(attributes), parts, len(parts))


def _attribute(facts: _library.AttributeInfo, memory: bytearray, count: int) -> Attribute:
    form = facts.format
    if form.semantic >= _CUSTOM:
        name = f"_CUSTOM_{form.set_index}"
    else:
        name = _SEMANTICS[form.semantic]
        if name in _NUMBERED:
            name += f"_{form.set_index}"
    data = array_over(memory, _FORMATS[form.component_type], (count, form.component_count))
    return Attribute(name, data, bool(form.normalized), form.morph_target - 1,
                     _library.Coding(facts.coding).name.lower().replace("_", " "), facts.bits)


def _buffer_of(array: Any, what: str) -> Tuple[memoryview, str]:
    """Returns a view of an array and the code of its type, with "I" for all unsigned integers of 32 bits."""
    view = memoryview(array)
    code = view.format.lstrip("@=<") if view.format.lstrip("@=<") else "B"
    if code == "L" and view.itemsize == 4:
        code = "I"
    if code not in _FORMATS:
        raise ValueError(f"{what} has the format {view.format!r}; convert it to float32 or an integer type of glTF")
    return view, code


def _fill_view(view: _library.AttributeView, name: str, array: Any, target: int, kept: List[Any]) -> int:
    """Fills a view of one attribute and returns the number of its elements."""
    buffer, code = _buffer_of(array, name)
    if buffer.ndim not in (1, 2):
        raise ValueError(f"{name} has {buffer.ndim} dimensions; give it one row for each vertex")
    columns = buffer.shape[1] if buffer.ndim == 2 else 1
    view.format.semantic, view.format.set_index = _meaning(name)
    view.format.component_type = _FORMATS.index(code)
    view.format.component_count = columns
    view.format.morph_target = target + 1
    memory = bytearray(buffer.tobytes())
    kept.append(memory)
    view.data = address(memory)
    view.stride_bytes = columns * buffer.itemsize
    return buffer.shape[0]


def index_buffer(indices: Any, kept: List[Any]) -> _library.PartView:
    """Returns a view of triangles. Narrower indices and lists are copied to 32 bits."""
    if isinstance(indices, (list, tuple)):
        values = indices
    else:
        buffer, code = _buffer_of(indices, "indices")
        if code == "f":
            raise ValueError("indices are floats; convert them to uint32")
        values = buffer.cast("B").cast(code) if buffer.c_contiguous and buffer.nbytes else \
            memoryview(buffer.tobytes()).cast(code)
        if code == "I":
            values = None
    if values is None:
        memory = bytearray(buffer.tobytes())
    else:
        memory = bytearray((ctypes.c_uint32 * len(values))(*(unsigned(v, "an index") for v in values)))
    kept.append(memory)
    return _library.PartView(address(memory), len(memory) // 4)


def _meaning(name: str) -> Tuple[int, int]:
    """Returns semantic and set of a name of glTF. [A.2.4]"""
    word, _, number = name.partition("_")
    if name in _SEMANTICS and name not in _NUMBERED:
        return _SEMANTICS.index(name), 0
    if word in _NUMBERED and number.isdigit() and int(number) < 256:
        return _SEMANTICS.index(word), int(number)
    if name.startswith("_") and len(name) > 1:
        return _CUSTOM, zlib.crc32(name.encode()) & 0xFF
    raise ValueError(f"{name!r} is no attribute of glTF; names of one's own begin with an underscore")
