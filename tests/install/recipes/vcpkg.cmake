# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# cmake -D FOLDER=… -D PORT=…/portfile.cmake -P vcpkg.cmake: runs a port for a static build, without optimisation, of its
# smallest choice of features. Stands for the functions of vcpkg, with the arguments they have.
set(CURRENT_PACKAGES_DIR "${FOLDER}/vcpkg")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_extract_source_archive out keyword archive)
  file(ARCHIVE_EXTRACT INPUT "${archive}" DESTINATION "${FOLDER}/vcpkg-source")
  file(GLOB top "${FOLDER}/vcpkg-source/*")
  set(${out} "${top}" PARENT_SCOPE)
endfunction()
function(vcpkg_check_features keyword out mode feature option)
  set(${out} -D${option}=ON PARENT_SCOPE)  # the feature is not asked for, and inverted
endfunction()
function(vcpkg_cmake_configure)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" SOURCE_PATH OPTIONS)
  run(${CMAKE_COMMAND} -S "${arg_SOURCE_PATH}" -B "${FOLDER}/vcpkg-build" -DCMAKE_BUILD_TYPE=Debug
      -DBUILD_SHARED_LIBS=OFF "-DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR}" -DCMAKE_INSTALL_LIBDIR=lib ${arg_OPTIONS})
endfunction()
function(vcpkg_cmake_install)
  run(${CMAKE_COMMAND} --build "${FOLDER}/vcpkg-build" --parallel 2 --target install)
endfunction()
function(vcpkg_cmake_config_fixup keyword path)
  file(MAKE_DIRECTORY "${CURRENT_PACKAGES_DIR}/share")
  file(RENAME "${CURRENT_PACKAGES_DIR}/${path}" "${CURRENT_PACKAGES_DIR}/share/gltf-mcc")
  # As vcpkg does: the prefix is one folder nearer.
  file(GLOB files "${CURRENT_PACKAGES_DIR}/share/gltf-mcc/*.cmake")
  foreach(file IN LISTS files)
    file(READ "${file}" text)
    string(REPLACE [[get_filename_component(_IMPORT_PREFIX "${_IMPORT_PREFIX}" PATH)
get_filename_component(_IMPORT_PREFIX "${_IMPORT_PREFIX}" PATH)
get_filename_component(_IMPORT_PREFIX "${_IMPORT_PREFIX}" PATH)]]
      [[get_filename_component(_IMPORT_PREFIX "${_IMPORT_PREFIX}" PATH)
get_filename_component(_IMPORT_PREFIX "${_IMPORT_PREFIX}" PATH)]] text "${text}")
    string(REPLACE "/../../../" "/../../" text "${text}")
    file(WRITE "${file}" "${text}")
  endforeach()
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_install_copyright keyword license)
  configure_file("${license}" "${CURRENT_PACKAGES_DIR}/share/gltf-mcc/copyright" COPYONLY)
endfunction()

include("${PORT}")
