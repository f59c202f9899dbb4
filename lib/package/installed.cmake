# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
#
# The target `installed` builds what `cmake --install` installs, and nothing else. Nothing at all is installed as long as some of it
# is missing: these rules run before all others, because this file is included before the folders that have them.
add_custom_target(installed)
foreach(component tool library development)
  install(CODE "set(build \"${CMAKE_BINARY_DIR}\")
set(files \"$<TARGET_GENEX_EVAL:installed,$<TARGET_PROPERTY:installed,MCC_${component}>>\")
include(\"${CMAKE_CURRENT_LIST_DIR}/check_built.cmake\")" COMPONENT ${component})
endforeach()

# mcc_installed(COMPONENT NAME...): the component consists of these targets.
function(mcc_installed component)
  foreach(name IN LISTS ARGN)
    add_dependencies(installed ${name})
    set_property(TARGET installed APPEND PROPERTY MCC_${component} $<TARGET_FILE:${name}>)
  endforeach()
endfunction()
