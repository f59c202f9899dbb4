# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# Header-only libraries serve every system, so those of the host are used for Windows too. They are
# linked into a folder of their own, because the headers of the host's C library are next to them.
set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})

# header_package(NAME TARGET FOLDER [DEFINITION...]): find_package(NAME) finds /usr/include/FOLDER as the target TARGET.
function(header_package name target folder)
  find_path(from_${name} ${folder} PATHS /usr/local/include /usr/include REQUIRED NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
  file(CREATE_LINK ${from_${name}}/${folder} ${headers}/${folder} SYMBOLIC)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${name}Config.cmake
       "if(TARGET ${target})\n  return()\nendif()\n"
       "add_library(${target} INTERFACE IMPORTED GLOBAL)\n"
       "target_include_directories(${target} SYSTEM INTERFACE ${headers})\n"
       "target_compile_definitions(${target} INTERFACE ${ARGN})\n")
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${name}ConfigVersion.cmake "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
endfunction()

header_package(CLI11 CLI11::CLI11 CLI)
header_package(fmt fmt::fmt fmt FMT_HEADER_ONLY=1)

# GoogleTest comes as sources (Debian's package googletest).
file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/GTestConfig.cmake
     "if(NOT TARGET GTest::gtest)\n"
     "  add_subdirectory(/usr/src/googletest ${CMAKE_BINARY_DIR}/googletest EXCLUDE_FROM_ALL)\n"
     "endif()\n")
