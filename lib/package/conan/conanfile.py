# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""Conan 2: GLTF_MCC_TARBALL=gltf-mcc.tar.gz conan create lib/package/conan, with a tarball of the sources (git archive)."""
import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir, unzip


class GltfMccConan(ConanFile):
    name = "gltf-mcc"
    version = "1.0.0"
    description = "KHR_mesh_collapse_compression for glTF 2.0: reader, writer, and whole documents"
    license = "Apache-2.0"
    topics = ("glTF", "mesh", "compression")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "reader_only": [True, False]}
    default_options = {"shared": False, "reader_only": False}

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self, src_folder="src")

    def source(self):
        unzip(self, os.environ["GLTF_MCC_TARBALL"], destination=self.source_folder, strip_root=True)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables.update({
            "MCC_INSTALL": True, "MCC_TOOLS": False, "MCC_TESTS": False, "MCC_FOREIGN": False,
            "MCC_READER_ONLY": bool(self.options.reader_only), "BUILD_SHARED_LIBS": bool(self.options.shared),
        })
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        rmdir(self, os.path.join(self.package_folder, "lib", "pkgconfig"))

    def package_info(self):
        # The package's own CMake files are used: find_package(gltf-mcc).
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "gltf-mcc"))
