# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# Included by cmake_install.cmake of the folder `build`: fails if one of `files` has not been built.
foreach(file IN LISTS files)
  if(NOT EXISTS "${file}")
    message(FATAL_ERROR "gltf-mcc: nothing was installed, because ${file} is not built yet. Run tools/install --prefix DIR, "
                        "or build before you install: cmake --build ${build} --target installed")
  endif()
endforeach()
