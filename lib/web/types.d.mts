// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

export type TypedArray = Int8Array | Uint8Array | Int16Array | Uint16Array | Uint32Array | Float32Array;

export interface DecodedAttribute {
  /** 0 POSITION, 1 NORMAL, 2 TANGENT, 3 TEXCOORD, 4 COLOR, 5 JOINTS, 6 WEIGHTS, 7 any other. */
  semantic: number;
  /** n of TEXCOORD_n; of others see the specification. */
  set: number;
  /** 0: the base mesh; k: morph target k - 1. */
  morphTarget: number;
  /** As in glTF accessors: 5120 BYTE to 5126 FLOAT. */
  componentType: number;
  componentCount: number;
  normalized: boolean;
  /** componentCount numbers for each of the piece's wedgeCount vertices, without padding. Owns its buffer. */
  array: TypedArray;
}

export interface DecodedPart {
  triangleCount: number;
  /** Three per triangle. Owns its buffer. */
  indices: Uint16Array | Uint32Array;
}

export interface DecodedPiece {
  /** Vertices in the sense of glTF: the count of the accessors. */
  wedgeCount: number;
  /** Distinct ones of the surface. */
  vertexCount: number;
  attributes: DecodedAttribute[];
  parts: DecodedPart[];
}

export interface DecodedPayload {
  pieces: DecodedPiece[];
}

/** Bounds that are checked before memory is taken for a payload. */
export interface Limits {
  maxVertices?: number;
  maxTriangles?: number;
  maxAttributes?: number;
  maxPieces?: number;
  /** The elements of A.2.6: time and working memory are in proportion. A payload has 1024 for each of its bytes at most. */
  maxElements?: number;
  /** Of all outputs. */
  maxOutputBytes?: number;
}

/** Bounds of each payload of a file, and of all of them together. */
export interface FileLimits extends Limits {
  /** What all payloads of a file may decode to, each counted once, with indices of 32 bits. Default: 1024 bytes for each byte of
   * the file (for loaders: of its payloads), but no less than 256 MiB and no more than 4 GiB. */
  maxDecodedBytes?: number;
}

export interface DecodeOptions {
  limits?: Limits;
  /** 'auto', the default: 16 bits for pieces with up to 65535 vertices. */
  indexType?: 'auto' | 'uint16' | 'uint32';
  /** What a document says about the payload, of payloadsOf(): checked before memory is taken. */
  claims?: readonly object[];
}

export interface InitOptions {
  /** Where the module is, with and without SIMD; both by default beside decoder.mjs, in wasm/. */
  wasmUrl?: string | URL;
  simdWasmUrl?: string | URL;
  /** Where its core is, likewise: a smaller module, which has what most payloads need. Without one it is not used, unless
   * the others are where they are by default. */
  coreUrl?: string | URL;
  simdCoreUrl?: string | URL;
  /** Or what it is: compiled already, or its bytes. */
  module?: WebAssembly.Module;
  bytes?: BufferSource;
}

export interface PoolOptions extends InitOptions {
  /** Default: one less than the processor has cores, 4 at most. They start when they are first needed. */
  workers?: number;
}

export interface PoolDecodeOptions extends DecodeOptions {
  /** The buffer of `bytes` moves to the worker instead of being copied; it is empty then. */
  transfer?: boolean;
}

export interface DecoderPool {
  readonly size: number;
  /** Bound to the pool. */
  readonly decodePayload: (bytes: Uint8Array, options?: PoolDecodeOptions) => Promise<DecodedPayload>;
  /** Ends the workers; what is not decoded yet rejects. */
  dispose(): void;
}

/** A kind of error of the specification (A.1.4), or one of this package. */
export type ErrorCode =
  | 'Truncated' | 'BadMagic' | 'UnsupportedVersion' | 'BadChecksum' | 'BadHeader' | 'BadConnectivity' | 'BadStitch'
  | 'BadAttribute' | 'TrailingBytes' | 'Limit' | 'OutOfMemory' | 'BadArgument'
  | 'NotInCore' | 'Document' | 'Load' | 'Trap' | 'Disposed' | 'Encode';
