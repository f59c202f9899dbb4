# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Whole GLB files: compress, decompress, describe."""
from __future__ import annotations

import ctypes
import json
import os
from typing import Any, Callable, Dict, Optional, Sequence, Tuple, Union

from . import _library
from ._library import library
from .errors import check, naming

Source = Union[bytes, bytearray, memoryview, str, "os.PathLike[str]"]

PREFERENCES = ("balanced", "size", "speed")
GRIDS = ("mesh", "scene", "primitive")
DECODE_TO = ("floats", "integers")
PREVIEWS_BY_SHARE = 0xffffffff


def choice(value: str, names: Tuple[str, ...], option: str) -> int:
    """Returns the number of a named choice."""
    if value not in names:
        raise ValueError(f"{option} is {value!r}; it can be {', '.join(map(repr, names))}")
    return names.index(value)


def convert(source: Source, *, position_bits: Optional[int] = None, normal_bits: Optional[int] = None,
            texcoord_bits: Optional[int] = None, color_bits: Optional[int] = None,
            tangent_bits: Optional[int] = None, weight_bits: Optional[int] = None, lossless: bool = False,
            grid: str = "mesh", max_position_error: float = 0.0, is_error_relative: bool = False,
            position_lattice: Optional[Sequence[float]] = None, step: float = 0.0,
            quality: float = 0.0, indices_only: bool = False, keep_vertex_order: bool = False, keep_triangle_order: bool = False,
            drop_unused: bool = False, prefer: str = "balanced", block_triangles: Optional[int] = None,
            thread_count: int = 1, max_decoded_bytes: int = 0, glb_version: int = 0, preview_triangles: int = 0,
            allow_larger: bool = False) -> bytes:
    """Compresses the meshes of a GLB and returns the GLB that results.

    The result is decoded and compared with the source before the call returns; where compression gains
    nothing, the result is the source. The same input gives the same bytes, whatever `thread_count` is.

    Args:
        source: the bytes of a GLB, or the path of a .glb file
        position_bits: bits of a coordinate (14), and likewise normal_bits (10), texcoord_bits (12), color_bits
            (8), tangent_bits (12), weight_bits (12); 0 keeps every bit, None is the default in parentheses
        lossless: every float keeps every bit; excludes the options for bits
        grid: which primitives share a lattice of positions: "mesh", "scene" or "primitive"
        max_position_error: if not 0, how far a position may move, in units of the file; replaces position_bits
        is_error_relative: the error is a fraction of the largest side of the bounding box
        position_lattice: x, y, z of a point of the lattice of positions, and its step, for tiles that must fit
            together; replaces grid, position_bits and max_position_error
        step: if not 0, a power of two such as 2**-10: the step of a lattice of positions through the origin, so
            that everything converted with the same step fits together; excludes lossless, max_position_error and
            position_lattice
        quality: if not 0, how large a mesh is drawn, from 16 to 2**20 pixels: no position moves by more than a
            pixel, and the bits of all other attributes follow as well; 4096 is usual. Excludes step and what it
            excludes, and replaces all bits
        indices_only: only the triangles are compressed
        keep_vertex_order, keep_triangle_order: decoded elements come in the order of the source
        drop_unused: vertices that no triangle uses are left out
        prefer: "balanced", "size" or "speed" of decoding
        block_triangles: triangles of a block of a large surface, 0 for no blocks; None: `prefer` decides
        thread_count: how many threads to use
        max_decoded_bytes: bounds what a compressed source may decode to; 0 is the library's default
        glb_version: 2, 3 (of the draft of glTF 2.1), or 0: 2 unless the result has more than 4 GiB
        preview_triangles: if not 0, about how many triangles the coarse versions have that primitives of 100,000
            triangles and more get in front of everything else; PREVIEWS_BY_SHARE is 2 % of those of the primitive
        allow_larger: compresses even where that makes the file larger

    Raises:
        Error: the file is not a GLB, or is damaged, or an option is out of range
        OSError: the file cannot be read
        MemoryError: memory ran out
    """
    options = _library.ConvertOptions()
    library.mcc_convert_options_init(ctypes.byref(options), ctypes.sizeof(options))
    given = {"position_bits": position_bits, "normal_bits": normal_bits, "texcoord_bits": texcoord_bits,
             "color_bits": color_bits, "tangent_bits": tangent_bits, "weight_bits": weight_bits,
             "block_triangles": block_triangles}
    for name, value in given.items():
        if value is not None and lossless and name != "block_triangles":
            raise ValueError(f"lossless keeps every bit, so it excludes {name}")
        if value is not None and quality and name != "block_triangles":
            raise ValueError(f"quality chooses all bits, so it excludes {name}")
        if value is not None:
            setattr(options, name, unsigned(value, name))
    options.lossless = lossless
    options.grid = choice(grid, GRIDS, "grid")
    options.max_position_error = max_position_error
    options.is_error_relative = is_error_relative
    if position_lattice is not None:
        x, y, z, lattice_step = position_lattice
        lattice = _library.Lattice((x, y, z, 0), lattice_step)
        options.position_lattice = ctypes.pointer(lattice)
    options.step = step
    options.quality = quality
    options.indices_only = indices_only
    options.keep_vertex_order = keep_vertex_order
    options.keep_triangle_order = keep_triangle_order
    options.drop_unused = drop_unused
    options.prefer = choice(prefer, PREFERENCES, "prefer")
    options.thread_count = unsigned(thread_count, "thread_count")
    options.max_decoded_bytes = unsigned(max_decoded_bytes, "max_decoded_bytes", 64)
    options.glb_version = unsigned(glb_version, "glb_version")
    options.preview_triangles = unsigned(preview_triangles, "preview_triangles")
    options.allow_larger = allow_larger
    return _document(source, lambda glb, document: library.mcc_convert_glb(
        glb, len(glb), ctypes.byref(options), document))


def decode(source: Source, *, decode_to: str = "floats", thread_count: int = 1, max_decoded_bytes: int = 0,
           glb_version: int = 0) -> bytes:
    """Turns the compressed primitives of a GLB into ordinary accessors again and returns the GLB.

    Safe for untrusted input.

    Args:
        source: the bytes of a GLB, or the path of a .glb file
        decode_to: what quantised attributes become, "floats" or "integers" (KHR_mesh_quantization)
        thread_count: how many threads to use; the result does not depend on it
        max_decoded_bytes: a GLB that asks for more is refused before memory is taken; 0 allows 1024 bytes for
            each byte of the GLB, but at least 256 MiB and at most 4 GiB
        glb_version: as in convert()

    Raises:
        Error: the file is not a GLB, or is damaged
        OSError: the file cannot be read
        MemoryError: memory ran out
    """
    options = _library.DecodeGlbOptions()
    library.mcc_decode_glb_options_init(ctypes.byref(options), ctypes.sizeof(options))
    options.decode_to = choice(decode_to, DECODE_TO, "decode_to")
    options.thread_count = unsigned(thread_count, "thread_count")
    options.max_decoded_bytes = unsigned(max_decoded_bytes, "max_decoded_bytes", 64)
    options.glb_version = unsigned(glb_version, "glb_version")
    return _document(source, lambda glb, document: library.mcc_decode_glb(
        glb, len(glb), ctypes.byref(options), document))


def inspect(source: Source) -> Dict[str, Any]:
    """Describes the payloads of a GLB: the members of `gltf-mcc inspect --format json`.

    Args:
        source: the bytes of a GLB, or the path of a .glb file

    Raises:
        as decode()
    """
    name = "" if isinstance(source, (bytes, bytearray, memoryview)) else os.fspath(source)
    text = _document(source, lambda glb, document: library.mcc_inspect_glb(
        glb, len(glb), os.fsencode(name), document))
    return json.loads(text)


def unsigned(value: int, name: str, bits: int = 32) -> int:
    """Returns a number that fits an unsigned member; ctypes would cut off what does not fit."""
    if not 0 <= value < 2**bits:
        raise ValueError(f"{name} is {value}; it can be 0 to {2**bits - 1}")
    return value


def bytes_of(source: Source) -> bytes:
    """Returns the bytes of a source: itself, a copy of a buffer, or what a file holds."""
    if isinstance(source, bytes):
        return source
    if isinstance(source, (bytearray, memoryview)):
        return bytes(source)
    with open(source, "rb") as file:
        return file.read()


def _document(source: Source, call: Callable[[bytes, Any], _library.Status]) -> bytes:
    document = ctypes.c_void_p()
    try:
        status = call(bytes_of(source), ctypes.byref(document))
        message = library.mcc_document_message(document).decode("utf-8", "replace") if document else None
        if message and not isinstance(source, (bytes, bytearray, memoryview)) and os.fspath(source).endswith(".gltf"):
            message += "; gltf-mcc decode IN.gltf OUT.glb makes a GLB of a .gltf and its files"
        with naming(source):
            check(status, message or None)
        size = ctypes.c_size_t()
        data = library.mcc_document_bytes(document, ctypes.byref(size))
        return ctypes.string_at(data, size.value)
    finally:
        library.mcc_document_release(document)
