# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# Shared libraries, installation, and what others find us by.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Before 1.0 every minor version may change the binary interface.
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(mcc_soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
else()
  set(mcc_soversion ${PROJECT_VERSION_MAJOR})
endif()
set(mcc_soversion ${mcc_soversion} PARENT_SCOPE)
set(mcc_package_dir ${CMAKE_CURRENT_LIST_DIR})

# mcc_shared_library(NAME STATIC ALIAS FILE): a shared library of the objects of a static one. It
# exports mcc:: and mcc_*, as far as they are marked MCC_API, and none of the templates of std:: that
# are instantiated here.
function(mcc_shared_library name static alias file)
  add_library(${name} SHARED $<TARGET_OBJECTS:${static}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>)
  set_target_properties(${name} PROPERTIES OUTPUT_NAME ${file} EXPORT_NAME ${alias}
                        LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION} SOVERSION ${mcc_soversion})
  # They find each other wherever they lie together; a program that uses one of them names no other.
  set_target_properties(${name} PROPERTIES BUILD_WITH_INSTALL_RPATH ON
                        INSTALL_RPATH $<IF:$<BOOL:${APPLE}>,@loader_path,$ORIGIN>)
  if(UNIX AND NOT APPLE)
    set(script ${mcc_package_dir}/exports.map)
    target_link_options(${name} PRIVATE LINKER:--version-script=${script} LINKER:--as-needed
                                        LINKER:--no-undefined)
    set_target_properties(${name} PROPERTIES LINK_DEPENDS ${script})
  endif()
endfunction()

# Public headers by the library that a program needs to link for them.
set(mcc_headers_reader allocator.h c_api.h decoded_limit.h error.h export.h job_runner.h meshlets.h reader.h simple.h
                       simple_inline.h status.h types.h)
set(mcc_headers_writer run_jobs.h writer.h)
set(mcc_headers_gltf files.h glb.h result.h tinygltf.h)

# mcc_install(ALIAS...): these libraries, their headers, CMake package, pkg-config files, and the
# target `uninstall`.
function(mcc_install)
  set(targets "")
  foreach(alias IN LISTS ARGN)
    list(APPEND targets mcc_${alias})
    if(BUILD_SHARED_LIBS)
      list(APPEND targets mcc_${alias}_shared)
    endif()
    list(TRANSFORM mcc_headers_${alias} PREPEND ${PROJECT_SOURCE_DIR}/lib/include/mcc/)
    install(FILES ${mcc_headers_${alias}} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mcc
            COMPONENT development)
  endforeach()
  install(TARGETS ${targets} EXPORT gltf-mcc
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
                  NAMELINK_COMPONENT development
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  if(PROJECT_IS_TOP_LEVEL)
    set(shared ${targets})
    list(FILTER shared INCLUDE REGEX _shared$)
    list(FILTER targets EXCLUDE REGEX _shared$)
    mcc_installed(library ${shared})
    mcc_installed(development ${targets})
  endif()

  set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/gltf-mcc)
  configure_package_config_file(${mcc_package_dir}/gltf-mccConfig.cmake.in gltf-mccConfig.cmake
                                INSTALL_DESTINATION ${folder})
  write_basic_package_version_file(gltf-mccConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(EXPORT gltf-mcc FILE gltf-mccTargets.cmake NAMESPACE gltf-mcc:: DESTINATION ${folder}
          COMPONENT development)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/gltf-mccConfig.cmake
                ${CMAKE_CURRENT_BINARY_DIR}/gltf-mccConfigVersion.cmake
          DESTINATION ${folder} COMPONENT development)

  # pkg-config. Static libraries need the libraries of C++ in programs linked by a C compiler.
  set(file_reader gltf-mcc-reader)
  set(file_writer gltf-mcc-writer)
  set(file_gltf gltf-mcc)
  set(requires "")
  # Relative to the file itself, so that what is installed may be moved.
  set(pc_prefix ${CMAKE_INSTALL_PREFIX})
  if(NOT IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
    file(RELATIVE_PATH pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    string(REGEX REPLACE "^(.*)/$" "\${pcfiledir}/\\1" pc_prefix ${pc_prefix})
  endif()
  foreach(alias IN LISTS ARGN)
    set(file ${file_${alias}})
    configure_file(${mcc_package_dir}/pkg-config.pc.in ${file}.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${file}.pc
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
    set(requires "${file} = ${PROJECT_VERSION}")
  endforeach()

  if(PROJECT_IS_TOP_LEVEL)
    add_custom_target(uninstall COMMAND ${CMAKE_COMMAND} -D MANIFEST_DIR=${CMAKE_BINARY_DIR}
                                        -P ${mcc_package_dir}/uninstall.cmake VERBATIM)
  endif()
endfunction()
