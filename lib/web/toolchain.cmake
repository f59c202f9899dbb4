# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# Builds WebAssembly with clang and wasi-libc, without a JavaScript runtime.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
find_program(clangxx NAMES clang++-14 clang++ REQUIRED)
set(CMAKE_CXX_COMPILER "${clangxx}")
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
