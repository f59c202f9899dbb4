# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""The version of the package; CHANGELOG.md says what versions mean."""
VERSION = "1.0.0"
