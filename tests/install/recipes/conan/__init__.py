# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Stands for what a recipe of Conan 2 uses of it; see conan_create.py."""


class ConanFile:
    pass
