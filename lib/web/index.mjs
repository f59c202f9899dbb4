// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Everything that decodes. The encoder is a module of its own, encoder.mjs.
export { createDecoderPool, decodePayload, decodePayloadSync, init, MccError, ready } from './decoder.mjs';
export { EXTENSION_NAME } from './document.mjs';
export { unpackGlb } from './unpack.mjs';
