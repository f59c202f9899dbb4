// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The stages of a piece that are compiled once per Io, in files of their own: each is called once
// per piece, so nothing is lost when it is not inlined. Whoever runs stages includes this file, and
// then compiles none of them. Compact code (the web's decoder) compiles them all with reader.cpp,
// which makes it smaller.
#ifndef MCC_READER_INSTANCES_H_
#define MCC_READER_INSTANCES_H_

#include "entropy/decoder_io.h"
#include "reader/piece.h"

// PREFIX is `extern` for a declaration, and nothing where the instances are.

#define MCC_MODES_INSTANCE(PREFIX, Io, fixed)                                       \
  PREFIX template Status PieceCoder<Io>::runModes<fixed>(const PositionParameters&, \
                                                         const PieceTruth&);
#define MCC_ALL_INSTANCES(PREFIX, Io)                                                              \
  PREFIX template Status PieceCoder<Io>::codeConnectivity(const PieceTruth&, CodeHistogram*,       \
                                                          bool);                                   \
  PREFIX template Status PieceCoder<Io>::codeStitch(const PieceTruth&);                            \
  PREFIX template Status PieceCoder<Io>::codePositions(const PieceTruth&,                          \
                                                       const PositionParameters*);                 \
  PREFIX template Status PieceCoder<Io>::runMirrored(const PositionParameters&, const Repetition&, \
                                                     const PieceTruth&);                           \
  PREFIX template Status PieceCoder<Io>::codePositionTails(const PieceTruth&);                     \
  PREFIX template Status PieceCoder<Io>::codeSeams(const PieceTruth&);                             \
  PREFIX template Status PieceCoder<Io>::codeLeftovers(const PieceTruth&);                         \
  PREFIX template Status PieceCoder<Io>::codeOrders(const PieceTruth&);                            \
  PREFIX template Status PieceCoder<Io>::prepareAttributes();                                      \
  PREFIX template Status AttributeStage<Io>::code(uint32_t, Array<int32_t>&);

#if !defined(MCC_COMPACT)
namespace mcc {

MCC_ALL_INSTANCES(extern, StreamsIo)
MCC_ALL_INSTANCES(extern, CompactIo)
MCC_MODES_INSTANCE(extern, CompactIo, kAnyModes)
#define MCC_EXTERN_MODES(which, modes) \
  MCC_MODES_INSTANCE(extern, StreamsIo, fixedModes(which, modes))
MCC_PLAIN_MODES(MCC_EXTERN_MODES)
MCC_KIND_MODES(MCC_EXTERN_MODES)
#undef MCC_EXTERN_MODES

}  // namespace mcc
#endif

#endif  // MCC_READER_INSTANCES_H_
