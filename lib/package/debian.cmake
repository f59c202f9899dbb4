# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# Debian packages by `cpack -G DEB` in a build folder: the tool, the shared libraries, and what it takes
# to compile against them. tools/release makes them, tools/check/deb tries them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gltf-mcc)
set(CPACK_PACKAGE_VENDOR "The gltf-mcc authors")
set(CPACK_PACKAGE_CONTACT "The gltf-mcc authors")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
if(mcc_prerelease)
  string(APPEND CPACK_PACKAGE_VERSION ~${mcc_prerelease})  # sorts before the release
endif()
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL tool library development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)

set(CPACK_DEBIAN_TOOL_PACKAGE_NAME gltf-mcc)
set(CPACK_DEBIAN_TOOL_PACKAGE_SECTION graphics)
set(CPACK_COMPONENT_TOOL_DESCRIPTION "converter for mesh collapse compression of glTF 2.0
 Compresses the meshes of glTF files with KHR_mesh_collapse_compression and
 decodes them again.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libgltf-mcc${mcc_soversion})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "mesh collapse compression of glTF 2.0, shared libraries
 Reader, writer and document layer of KHR_mesh_collapse_compression.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libgltf-mcc-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libgltf-mcc${mcc_soversion} (= ${CPACK_PACKAGE_VERSION})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "mesh collapse compression of glTF 2.0, development files
 Headers for C++ and C, static libraries, CMake package and pkg-config files.")
include(CPack)
