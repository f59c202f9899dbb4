// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/**
 * What is wrong with a payload or a document, in plain English. `code` is a kind of error of the
 * specification (A.1.4), 'Document' if a document contradicts its payload, or one of 'OutOfMemory',
 * 'BadArgument', 'Load', 'Trap'.
 */
export class MccError extends Error {
  constructor(message, code) {
    super(message);
    this.name = 'MccError';
    this.code = code;
  }
}
