// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// gltf-mcc: compresses glTF files with KHR_mesh_collapse_compression, and decompresses them.
#include "commands.h"
#include "help_pages.h"
#include "other_programs.h"
#include "program.h"

int main(int argc, char** argv) {
  return mcc::tool::runProgram(argc, argv, nullptr, [](mcc::tool::Program& program) {
    mcc::tool::addConvert(program);
    mcc::tool::addDecode(program);
    mcc::tool::addInspect(program);
    mcc::tool::addValidate(program);
    mcc::tool::addOtherPrograms(program);
    mcc::tool::addHelpCommands(program);
  });
}
