# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
def check_min_cppstd(recipe, standard):
    assert standard == 20
