# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import os
import subprocess


def cmake_layout(recipe, src_folder="."):
    recipe.source_folder = os.path.join(recipe.folder, src_folder)
    recipe.build_folder = os.path.join(recipe.folder, "build")


class CMakeToolchain:
    def __init__(self, recipe):
        self.recipe, self.cache_variables = recipe, {}

    def generate(self):
        self.recipe.variables = self.cache_variables


class CMakeDeps:
    def __init__(self, recipe):
        pass

    def generate(self):
        pass


class CMake:
    def __init__(self, recipe):
        self.recipe = recipe

    def configure(self):
        values = [f"-D{name}={'ON' if value else 'OFF'}" for name, value in self.recipe.variables.items()]
        subprocess.run(["cmake", "-S", self.recipe.source_folder, "-B", self.recipe.build_folder, "-DCMAKE_BUILD_TYPE=Debug",
                        "-DCMAKE_INSTALL_LIBDIR=lib", *values], check=True)

    def build(self):
        subprocess.run(["cmake", "--build", self.recipe.build_folder, "--parallel", "2"], check=True)

    def install(self):
        subprocess.run(["cmake", "--install", self.recipe.build_folder, "--prefix", self.recipe.package_folder], check=True)
