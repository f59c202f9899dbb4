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

/** Returns an MccError for whatever was thrown. */
export const asMccError = (error, what, code) => (error instanceof MccError ? error : new MccError(`${what} (${error?.message})`, code));

/** Throws an MccError that says which argument is not what it has to be. */
export function requireArgument(condition, message) {
  if (!condition) throw new MccError(message, 'BadArgument');
}

/** Returns an error that is about a place. */
export const placed = (error, place) => (error instanceof MccError ? new MccError(`${place}: ${error.message}`, error.code) : error);

/** Returns an error about the payload in a buffer view; what contradicts the document has a path of its own. */
export const inView = (error, number) => (error?.code === 'Document' ? error : placed(error, `/bufferViews/${number}`));

/** Throws an error about a place in a document. */
export function fail(path, message) {
  throw new MccError(path === '' ? message : `${path}: ${message}`, 'Document');
}
