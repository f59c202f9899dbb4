# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""What the library refuses, as exceptions."""
from __future__ import annotations

import contextlib
import ctypes
import os
from typing import Any, Iterator, Optional, Tuple

from ._library import Status, library

_NO_OFFSET = 2**64 - 1
_OUT_OF_MEMORY = 11
_NAMES = {
    1: "TRUNCATED", 2: "BAD_MAGIC", 3: "UNSUPPORTED_VERSION", 4: "BAD_CHECKSUM", 5: "BAD_HEADER",
    6: "BAD_CONNECTIVITY", 7: "BAD_STITCH", 8: "BAD_ATTRIBUTE", 9: "TRAILING_BYTES", 10: "LIMIT",
    12: "BAD_ARGUMENT", 13: "CANCELLED", 64: "DOCUMENT",
}


class Error(ValueError):
    """A file or an argument that the library refuses. Its text is the one the program gltf-mcc prints.

    Attributes:
        code: the name of the error in mcc/c_api.h without its prefix, such as "BAD_CHECKSUM"; "DOCUMENT"
            for everything that is wrong with a glTF document
        offset_bytes: the place in the payload, or None
    """

    def __init__(self, text: str, code: str, offset_bytes: Optional[int] = None):
        super().__init__(text)
        self.code = code
        self.offset_bytes = offset_bytes

    def __reduce__(self) -> Tuple[type, Tuple[str, str, Optional[int]]]:
        # Exceptions are pickled with the arguments of ValueError otherwise; Dask and multiprocessing send them.
        return type(self), (str(self), self.code, self.offset_bytes)


def printable(text: str) -> str:
    """Returns a text whose control characters are escaped, since names in it may come from a file."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


@contextlib.contextmanager
def naming(source: Any) -> Iterator[None]:
    """If the source is a path, an Error about what is in that file begins with it."""
    try:
        yield
    except Error as failure:
        if isinstance(source, (bytes, bytearray, memoryview)) or failure.code == "BAD_ARGUMENT":
            raise
        text = f"{printable(os.fsdecode(source))}: {failure}"
        raise Error(text, failure.code, failure.offset_bytes) from failure.__cause__


def check(status: Status, text: Optional[str] = None) -> None:
    """Raises what a status says: MemoryError or Error. `text` replaces the text of the status."""
    if status.error == 0:
        return
    if text is None:
        line = ctypes.create_string_buffer(1000)
        library.mcc_status_text(status, line, len(line))
        text = line.value.decode("utf-8", "replace")
    if status.error == _OUT_OF_MEMORY:
        raise MemoryError(text)
    offset = None if status.offset_bytes == _NO_OFFSET else status.offset_bytes
    raise Error(text, _NAMES.get(status.error, str(status.error)), offset)
