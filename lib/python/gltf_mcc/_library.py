# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Finds the shared library and declares the part of its C API (mcc/c_api.h) that the package calls.

ctypes releases the interpreter's lock during every call, so that other threads go on.
"""
from __future__ import annotations

import ctypes
import ctypes.util
import enum
import os
from ctypes import POINTER, c_char_p, c_double, c_float, c_int32, c_size_t, c_uint32, c_uint64, c_void_p
from pathlib import Path

MAJOR_VERSION = 1


class Status(ctypes.Structure):
    _fields_ = [("error", c_int32), ("what", c_char_p), ("offset_bytes", c_uint64)]


class Allocator(ctypes.Structure):
    _fields_ = [("allocate", c_void_p), ("release", c_void_p), ("user", c_void_p)]


class AttributeFormat(ctypes.Structure):
    _fields_ = [(name, c_uint32) for name in
                ("semantic", "set_index", "component_type", "component_count", "normalized", "morph_target")]


class Lattice(ctypes.Structure):
    _fields_ = [("origin", c_float * 4), ("step", c_float)]


class OpenOptions(ctypes.Structure):
    _fields_ = [("struct_bytes", c_size_t), ("max_vertices", c_uint64), ("max_triangles", c_uint64),
                ("max_elements", c_uint64), ("max_output_bytes", c_uint64), ("max_attributes", c_uint32),
                ("max_pieces", c_uint32), ("allocator", Allocator)]


class PieceInfo(ctypes.Structure):
    _fields_ = [("struct_bytes", c_size_t), ("wedge_count", c_uint32), ("vertex_count", c_uint32),
                ("attribute_count", c_uint32), ("part_count", c_uint32)]


class Coding(enum.IntEnum):
    """MCC_CODING_… of mcc/c_api.h."""
    LATTICE = 0
    INTEGER = 1
    EXACT_FLOAT = 2
    OCTAHEDRAL = 3
    TANGENT_ANGLE = 4
    ALIAS = 5
    GRID = 6


class AttributeInfo(ctypes.Structure):
    _fields_ = [("struct_bytes", c_size_t), ("format", AttributeFormat), ("coding", c_uint32),
                ("bits", c_uint32), ("lattice", Lattice)]


class AttributeTarget(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("stride_bytes", c_size_t)]


class PartTarget(ctypes.Structure):
    _fields_ = [("indices", c_void_p), ("index_bytes", c_uint32)]


class PieceTarget(ctypes.Structure):
    _fields_ = [("attributes", POINTER(AttributeTarget)), ("attribute_count", c_size_t),
                ("parts", POINTER(PartTarget)), ("part_count", c_size_t)]


class AttributeView(ctypes.Structure):
    _fields_ = [("format", AttributeFormat), ("data", c_void_p), ("stride_bytes", c_size_t),
                ("quantization_bits", c_uint32), ("lattice", POINTER(Lattice))]


class PartView(ctypes.Structure):
    _fields_ = [("indices", c_void_p), ("index_count", c_size_t)]


class PieceView(ctypes.Structure):
    _fields_ = [("wedge_count", c_uint32), ("attributes", POINTER(AttributeView)), ("attribute_count", c_size_t),
                ("parts", POINTER(PartView)), ("part_count", c_size_t)]


class MeshletOptions(ctypes.Structure):
    _fields_ = [("struct_bytes", c_size_t), ("max_vertices", c_uint32), ("max_triangles", c_uint32),
                ("shape", c_uint32), ("allocator", Allocator)]


class MeshletSizes(ctypes.Structure):
    _fields_ = [("meshlet_count", c_size_t), ("vertex_count", c_size_t), ("triangle_bytes", c_size_t)]


class MeshletTarget(ctypes.Structure):
    _fields_ = [("meshlets", c_void_p), ("vertices", c_void_p), ("triangles", c_void_p), ("sizes", MeshletSizes)]


class TriangleList(ctypes.Structure):
    _fields_ = [("indices", c_void_p), ("index_bytes", c_uint32), ("triangle_count", c_uint32),
                ("vertex_count", c_uint32)]


class EncodeOptions(ctypes.Structure):
    _fields_ = [("struct_bytes", c_size_t), ("keep_vertex_order", c_uint32), ("keep_triangle_order", c_uint32),
                ("prefer", c_uint32), ("block_triangles", c_uint32), ("run_jobs", c_void_p),
                ("run_jobs_user", c_void_p)]


class ConvertOptions(ctypes.Structure):
    _fields_ = [("struct_bytes", c_size_t), ("position_bits", c_uint32), ("normal_bits", c_uint32),
                ("texcoord_bits", c_uint32), ("color_bits", c_uint32), ("tangent_bits", c_uint32),
                ("weight_bits", c_uint32), ("lossless", c_uint32), ("grid", c_uint32),
                ("max_position_error", c_double), ("is_error_relative", c_uint32), ("indices_only", c_uint32),
                ("keep_vertex_order", c_uint32), ("keep_triangle_order", c_uint32), ("thread_count", c_uint32),
                ("position_lattice", POINTER(Lattice)), ("prefer", c_uint32), ("max_decoded_bytes", c_uint64),
                ("drop_unused", c_uint32), ("block_triangles", c_uint32), ("step", c_double), ("quality", c_double),
                ("glb_version", c_uint32), ("preview_triangles", c_uint32), ("allow_larger", c_uint32)]


class DecodeGlbOptions(ctypes.Structure):
    _fields_ = [("struct_bytes", c_size_t), ("decode_to", c_uint32), ("thread_count", c_uint32),
                ("max_decoded_bytes", c_uint64), ("glb_version", c_uint32)]


# Name, result, arguments. Objects of the library are plain pointers here.
_FUNCTIONS = [
    ("mcc_version", c_char_p, []),
    ("mcc_status_text", c_size_t, [Status, c_char_p, c_size_t]),
    ("mcc_element_bytes", c_size_t, [POINTER(AttributeFormat)]),
    ("mcc_open_options_init", None, [POINTER(OpenOptions), c_size_t]),
    ("mcc_payload_open", Status, [c_char_p, c_size_t, POINTER(OpenOptions), POINTER(c_void_p)]),
    ("mcc_payload_close", None, [c_void_p]),
    ("mcc_payload_piece_count", c_uint32, [c_void_p]),
    ("mcc_payload_piece", Status, [c_void_p, c_uint32, POINTER(PieceInfo)]),
    ("mcc_payload_attribute", Status, [c_void_p, c_uint32, c_uint32, POINTER(AttributeInfo)]),
    ("mcc_payload_part", Status, [c_void_p, c_uint32, c_uint32, POINTER(c_uint32)]),
    ("mcc_payload_decode", Status, [c_void_p, POINTER(PieceTarget), c_size_t, c_void_p]),
    ("mcc_meshlet_options_init", None, [POINTER(MeshletOptions), c_size_t]),
    ("mcc_meshlet_bound", MeshletSizes, [c_uint32, POINTER(MeshletOptions)]),
    ("mcc_build_meshlets", Status, [POINTER(TriangleList), POINTER(MeshletTarget), POINTER(MeshletSizes),
                                    POINTER(MeshletOptions)]),
    ("mcc_encode_options_init", None, [POINTER(EncodeOptions), c_size_t]),
    ("mcc_encode", Status, [POINTER(PieceView), c_size_t, POINTER(EncodeOptions), POINTER(c_void_p)]),
    ("mcc_encoding_payload", c_void_p, [c_void_p, POINTER(c_size_t)]),
    ("mcc_encoding_source_wedges", c_void_p, [c_void_p, c_size_t, POINTER(c_size_t)]),
    ("mcc_encoding_release", None, [c_void_p]),
    ("mcc_convert_options_init", None, [POINTER(ConvertOptions), c_size_t]),
    ("mcc_convert_glb", Status, [c_char_p, c_size_t, POINTER(ConvertOptions), POINTER(c_void_p)]),
    ("mcc_decode_glb_options_init", None, [POINTER(DecodeGlbOptions), c_size_t]),
    ("mcc_decode_glb", Status, [c_char_p, c_size_t, POINTER(DecodeGlbOptions), POINTER(c_void_p)]),
    ("mcc_inspect_glb", Status, [c_char_p, c_size_t, c_char_p, POINTER(c_void_p)]),
    ("mcc_document_bytes", c_void_p, [c_void_p, POINTER(c_size_t)]),
    ("mcc_document_message", c_char_p, [c_void_p]),
    ("mcc_document_release", None, [c_void_p]),
]

_HELP = ("gltf_mcc: the shared library of gltf-mcc was not found. Install the wheel that tools/build-wheel makes, "
         "which contains it, or the library (tools/install), or set GLTF_MCC_LIBRARY to the path of libgltf-mcc.so")


def _candidates():
    """Yields the names to try, the most specific one first."""
    named = os.environ.get("GLTF_MCC_LIBRARY")
    if named:
        yield named
        return  # who names a library does not want another one
    for name in (f"libgltf-mcc.so.{MAJOR_VERSION}", f"libgltf-mcc.{MAJOR_VERSION}.dylib", "gltf-mcc.dll"):
        beside = Path(__file__).with_name(name)
        if beside.exists():
            yield str(beside)
        yield name
    found = ctypes.util.find_library("gltf-mcc")
    if found:
        yield found


def _load() -> ctypes.CDLL:
    failures = []
    for name in _candidates():
        try:
            library = ctypes.CDLL(name)
            for function, result, arguments in _FUNCTIONS:
                declared = getattr(library, function)
                declared.restype = result
                declared.argtypes = arguments
            return library
        except (OSError, AttributeError) as failure:  # AttributeError: an older library lacks a function
            failures.append(f"{name}: {failure}")
    raise ImportError("\n  ".join([_HELP + ". Tried:"] + failures))


library = _load()
