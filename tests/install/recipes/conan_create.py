# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""conan_create.py CONANFILE PACKAGE_FOLDER: runs the methods of a recipe in the order in which `conan create` does, with the
reader alone."""
import importlib.util
import sys
import types

from conan import ConanFile

path, package_folder = sys.argv[1:]
spec = importlib.util.spec_from_file_location("conanfile", path)
module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
kind = next(value for value in vars(module).values() if isinstance(value, type) and issubclass(value, ConanFile) and value is not ConanFile)
recipe = kind()
recipe.folder, recipe.package_folder = package_folder + "-work", package_folder
recipe.options = types.SimpleNamespace(**{**kind.default_options, "reader_only": True})
assert all(value in kind.options[name] for name, value in vars(recipe.options).items())
recipe.requires = lambda *_, **__: sys.exit("the reader needs nothing")
recipe.cpp_info = types.SimpleNamespace(set_property=lambda *_: None, builddirs=[])
for step in ("requirements", "validate", "layout", "source", "generate", "build", "package", "package_info"):
    getattr(recipe, step)()
