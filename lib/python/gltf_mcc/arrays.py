# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""What the package returns as arrays: NumPy's where NumPy is installed, else memoryviews of the same shape and type."""
from __future__ import annotations

from typing import Any, Tuple

try:
    import numpy
except ImportError:
    numpy = None  # type: ignore[assignment]


def array_over(memory: Any, code: str, shape: Tuple[int, ...]) -> Any:
    """Returns an array over memory that it keeps alive; it is writable if the memory is a bytearray."""
    if numpy is not None:
        return numpy.frombuffer(memory, dtype=numpy.dtype(code)).reshape(shape)
    if 0 in shape:  # which no memoryview of several dimensions can be
        return memoryview(memory).cast(code)
    return memoryview(memory).cast(code, shape)
