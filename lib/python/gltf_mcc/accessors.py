# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Reads the accessors of a GLB into arrays of their own. The GLB may lie about everything: each number is checked
before it is used, and all arrays together take no more than a given number of bytes."""
from __future__ import annotations

import array
import base64
import binascii
import json
import struct
from typing import Any, Callable, Dict, List, Optional, Tuple

from .arrays import array_over, numpy
from .errors import Error, printable

# Codes of struct and memoryview. docs/gltf-2.1.md has the types that the draft of glTF 2.1 adds.
_CODES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5124: "i", 5125: "I", 5126: "f",
          5130: "d", 5131: "e", 5134: "q", 5135: "Q"}
_SCALES = {"b": 127, "B": 255, "h": 32767, "H": 65535, "i": 2**31 - 1, "I": 2**32 - 1, "q": 2**63 - 1, "Q": 2**64 - 1}
_COLUMNS_AND_ROWS = {"SCALAR": (1, 1), "VEC2": (1, 2), "VEC3": (1, 3), "VEC4": (1, 4),
                     "MAT2": (2, 2), "MAT3": (3, 3), "MAT4": (4, 4)}
_FOREIGN = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")


def refuse(path: str, what: str) -> Error:
    """Returns the exception for something that is wrong with the document."""
    return Error(printable(f"{path}: {what}" if path else what), "DOCUMENT")


def list_in(owner: Dict[str, Any], name: str, path: str) -> List[Any]:
    """Returns an array of the JSON, or an empty one."""
    value = owner.get(name, [])
    if not isinstance(value, list):
        raise refuse(f"{path}/{name}", "is not an array")
    return value


def object_in(owner: Dict[str, Any], name: str, path: str) -> Dict[str, Any]:
    """Returns an object of the JSON, or an empty one."""
    value = owner.get(name, {})
    if not isinstance(value, dict):
        raise refuse(f"{path}/{name}", "is not an object")
    return value


def count_in(owner: Dict[str, Any], name: str, path: str, missing: Optional[int] = None) -> int:
    """Returns a number of the JSON that counts or numbers something; `missing` is its default."""
    value = owner.get(name, missing)
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if type(value) is not int or not 0 <= value < 2**53:
        raise refuse(f"{path}/{name}", "is missing" if value is None else "is not a whole number of 0 or more")
    return value


def text_in(owner: Dict[str, Any], name: str) -> str:
    """Returns a text of the JSON, or an empty one."""
    value = owner.get(name, "")
    return value if isinstance(value, str) else ""


def refuse_foreign(owner: Dict[str, Any], path: str) -> None:
    """Refuses what another codec has compressed, so that nobody takes its empty accessors for zeros."""
    for name in _FOREIGN:
        if name in object_in(owner, "extensions", path):
            raise refuse(path, f"is compressed with {name}, which this package does not read; gltf-mcc convert does")


class Document:
    """A GLB whose accessors are read once each, however often they are used."""

    def __init__(self, glb: bytes, max_bytes: int):
        text, self._chunks = _chunks(glb)
        try:
            document = json.loads(str(text, "utf-8"))
        except (ValueError, RecursionError) as failure:
            raise refuse("JSON", str(failure)) from failure
        if not isinstance(document, dict):
            raise refuse("JSON", "is not an object")
        self.json: Dict[str, Any] = document
        self._left_bytes = max_bytes
        self._max_bytes = max_bytes
        self._buffers: Dict[int, memoryview] = {}
        self._kept: Dict[Any, Any] = {}

    def once(self, key: Any, make: Callable[[], Any]) -> Any:
        """Returns what make() returned when this key was asked for first."""
        if key not in self._kept:
            self._kept[key] = make()
        return self._kept[key]

    def take(self, byte_count: int) -> None:
        """Counts memory before it is taken."""
        self._left_bytes -= byte_count
        if self._left_bytes < 0:
            raise Error(f"its arrays need more than {self._max_bytes:,} bytes; see max_decoded_bytes", "LIMIT")

    def item(self, name: str, number: int, path: str) -> Dict[str, Any]:
        """Returns /name/number, which `path` refers to."""
        items = list_in(self.json, name, "")
        if number >= len(items):
            raise refuse(path, f"there is no {name}[{number}]")
        if not isinstance(items[number], dict):
            raise refuse(f"/{name}/{number}", "is not an object")
        return items[number]

    def values(self, number: int, as_floats: bool, path: str) -> Any:
        """Returns the array of an accessor, a row for each element. Integers that stand for fractions become these, and
        others become floats if the caller asks for them. Floats of 16 and 64 bits keep their type, but no memoryview
        can have 16 bits: without NumPy, they get 32, which hold the same values."""
        def make() -> Any:
            memory, code, count, width, is_normalized = self._elements(number, path)
            if code in _SCALES and (as_floats or is_normalized):
                self.take(4 * count * width)
                memory, code = _floats(memory, code, is_normalized), "f"
            elif code == "e" and numpy is None:
                self.take(4 * count * width)
                halves = (half for half, in struct.iter_unpack("e", memory))
                memory, code = bytearray(array.array("f", halves).tobytes()), "f"
            return array_over(memory, code, (count, width))
        return self.once(("values", number, as_floats), make)

    def indices(self, number: int, path: str) -> bytes:
        """Returns the indices of an accessor as unsigned integers of 32 bits."""
        def make() -> bytes:
            memory, code, count, width, _ = self._elements(number, path)
            if code not in "BHI" or width != 1:
                raise refuse(f"/accessors/{number}", "holds no indices: it is no SCALAR of an unsigned type")
            if code == "I":
                return bytes(memory)
            self.take(4 * count)
            if numpy is not None:
                return numpy.frombuffer(memory, code).astype("I").tobytes()
            return array.array("I", memoryview(memory).cast(code)).tobytes()
        return self.once(("indices", number), make)

    def _elements(self, number: int, path: str) -> Tuple[bytearray, str, int, int, bool]:
        """Returns the packed elements of an accessor, the code of their type, how many there are, how many components
        each has, and whether integers stand for fractions."""
        accessor = self.item("accessors", number, path)
        here = f"/accessors/{number}"
        code = _code_in(accessor, here)
        shape = _COLUMNS_AND_ROWS.get(text_in(accessor, "type"))
        if shape is None:
            raise refuse(f"{here}/type", "is unknown")
        columns, rows = shape
        count = count_in(accessor, "count", here)
        element_bytes = columns * rows * struct.calcsize(code)
        self.take(element_bytes * count)
        if "bufferView" in accessor:
            memory = self._gather(accessor, count, columns, rows * struct.calcsize(code), here)
        else:
            memory = bytearray(element_bytes * count)
        if "sparse" in accessor:
            self._replace_some(memory, object_in(accessor, "sparse", here), element_bytes, count, f"{here}/sparse")
        return memory, code, count, columns * rows, accessor.get("normalized") is True

    def _gather(self, owner: Dict[str, Any], count: int, columns: int, column_bytes: int, path: str) -> bytearray:
        """Returns elements without the gaps between them and between the columns of matrices, which begin at multiples
        of four bytes."""
        view_number = count_in(owner, "bufferView", path)
        view = self.item("bufferViews", view_number, f"{path}/bufferView")
        here = f"/bufferViews/{view_number}"
        refuse_foreign(view, here)
        data = self._bytes_of_view(view, here)
        begin = count_in(owner, "byteOffset", path, 0)
        pitch = column_bytes if columns == 1 else (column_bytes + 3) // 4 * 4
        size = pitch * (columns - 1) + column_bytes
        stride = count_in(view, "byteStride", here, 0) or pitch * columns
        if stride < size:
            raise refuse(path, f"elements of {size} bytes do not fit the stride of {here}")
        if count and begin + stride * (count - 1) + size > len(data):
            raise refuse(path, f"reaches beyond the end of {here}")
        if not count or (columns == 1 and stride == size):
            return bytearray(data[begin:begin + size * count])
        if numpy is not None:
            shape, strides = (count, columns, column_bytes), (stride, pitch, 1)
            return bytearray(numpy.ndarray(shape, "u1", data, begin, strides).tobytes())
        starts = (begin + stride * i + pitch * k for i in range(count) for k in range(columns))
        return bytearray(b"".join(data[at:at + column_bytes] for at in starts))

    def _replace_some(self, memory: bytearray, sparse: Dict[str, Any], size: int, count: int, path: str) -> None:
        """Writes the elements of a sparse accessor over the others."""
        changed = count_in(sparse, "count", path)
        where = object_in(sparse, "indices", path)
        code = _code_in(where, f"{path}/indices")
        if code not in "BHI":
            raise refuse(f"{path}/indices/componentType", "is not unsigned")
        self.take(changed * (size + struct.calcsize(code)))
        numbers = memoryview(self._gather(where, changed, 1, struct.calcsize(code), f"{path}/indices")).cast(code)
        values = self._gather(object_in(sparse, "values", path), changed, 1, size, f"{path}/values")
        for k, number in enumerate(numbers):
            if number >= count:
                raise refuse(f"{path}/indices", f"there is no element {number}")
            memory[number * size:(number + 1) * size] = values[k * size:(k + 1) * size]

    def _bytes_of_view(self, view: Dict[str, Any], path: str) -> memoryview:
        data = self._bytes_of_buffer(count_in(view, "buffer", path), path)
        begin, size = count_in(view, "byteOffset", path, 0), count_in(view, "byteLength", path)
        if begin + size > len(data):
            raise refuse(path, "reaches beyond the end of its buffer")
        return data[begin:begin + size]

    def _bytes_in_glb(self, buffer: Dict[str, Any], number: int) -> memoryview:
        """Returns the BIN chunk that a buffer names (glTF 2.1), or that of the first buffer."""
        nothing = len(self._chunks)
        is_first = number == 0 and self._chunks[0][0] == b"JSON"
        chunk = count_in(buffer, "chunk", f"/buffers/{number}", 1 if is_first else nothing)
        kind, data = self._chunks[chunk] if chunk < nothing else (b"", memoryview(b""))
        if kind == b"BIN\0":
            return data
        if "chunk" in buffer:
            raise refuse(f"/buffers/{number}/chunk", f"chunk {chunk} is not a BIN chunk")
        return memoryview(b"")

    def _bytes_of_buffer(self, number: int, path: str) -> memoryview:
        """Returns the BIN chunk, or the bytes of a data: URI."""
        if number in self._buffers:
            return self._buffers[number]
        buffer = self.item("buffers", number, f"{path}/buffer")
        uri = buffer.get("uri")
        if uri is None:
            data = self._bytes_in_glb(buffer, number)
        elif isinstance(uri, str) and uri.startswith("data:") and ";base64," in uri:
            try:
                data = memoryview(base64.b64decode(uri.split(";base64,", 1)[1]))
            except binascii.Error as failure:
                raise refuse(f"/buffers/{number}/uri", str(failure)) from failure
        else:
            raise refuse(f"/buffers/{number}/uri",
                         "is another file; gltf-mcc decode IN.gltf OUT.glb makes one file of both")
        self._buffers[number] = data
        return data


def _chunks(glb: bytes) -> Tuple[memoryview, List[Tuple[bytes, memoryview]]]:
    """Returns the JSON of a GLB, and the kind and the bytes of each chunk. docs/gltf-2.1.md has both versions."""
    version = struct.unpack_from("<I", glb, 4)[0] if len(glb) >= 20 and glb[:4] == b"glTF" else 0
    if version not in (2, 3):
        raise refuse("", "this is not a GLB of version 2 or 3")
    at, header, alignment = (12, "<I4s", 1) if version == 2 else (16, "<4sIQ", 8)
    data = memoryview(glb)
    chunks: List[Tuple[bytes, memoryview]] = []
    while at + struct.calcsize(header) <= len(data):
        words = struct.unpack_from(header, glb, at)
        size, kind = words if version == 2 else (words[2], words[0])
        if version == 3 and words[1] != 0:
            raise refuse(f"byte {at + 4}", "the chunk is encoded, which cannot be read")
        begin = at + struct.calcsize(header)
        if size > len(data) - begin and kind == b"JSON":
            raise refuse(f"byte {at}", "the JSON chunk is missing or truncated")
        chunks.append((kind, data[begin:begin + size]))
        at = -(-(begin + size) // alignment) * alignment
    texts = [content for kind, content in (chunks[:1] if version == 2 else chunks) if kind == b"JSON"]
    if not texts:
        raise refuse("byte 12", "the JSON chunk is missing or truncated")
    return texts[0], chunks


def _code_in(owner: Dict[str, Any], path: str) -> str:
    code = _CODES.get(count_in(owner, "componentType", path))
    if code is None:
        raise refuse(f"{path}/componentType", "is unknown")
    return code


def _floats(memory: bytearray, code: str, is_normalized: bool) -> bytearray:
    """Returns integers as float32, those that stand for fractions as glTF 2.0 (3.6.2.2) says."""
    scale = _SCALES[code] if is_normalized else 1
    lowest = -1 if is_normalized else -_SCALES[code] - 1
    if numpy is not None:
        return bytearray(numpy.maximum(numpy.frombuffer(memory, code) / scale, lowest).astype("f").tobytes())
    values = memoryview(memory).cast(code)
    return bytearray(array.array("f", (max(value / scale, lowest) for value in values)).tobytes())
