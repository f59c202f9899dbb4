// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/** An array with a buffer of its own, which is never shared: Uint8Array<ArrayBuffer> in TypeScript 5.7 and later. */
export type Owned<A extends { slice(): unknown }> = ReturnType<A['slice']>;

export type TypedArray =
  | Owned<Int8Array> | Owned<Uint8Array> | Owned<Int16Array> | Owned<Uint16Array> | Owned<Uint32Array> | Owned<Float32Array>;

export interface DecodedAttribute {
  /** 0 POSITION, 1 NORMAL, 2 TANGENT, 3 TEXCOORD, 4 COLOR, 5 JOINTS, 6 WEIGHTS, 7 any other. */
  semantic: number;
  /** n of TEXCOORD_n; for others see the specification. */
  set: number;
  /** 0: the base mesh; k: morph target k - 1. */
  morphTarget: number;
  /** As in glTF accessors: 5120 BYTE to 5126 FLOAT. */
  componentType: number;
  componentCount: number;
  normalized: boolean;
  /** Of floats that are quantised: their bits; 0 for all others. */
  bits: number;
  /** Of floats on a lattice: the origins of four components, then the step. Component i is origin i + step * an integer. */
  lattice?: number[];
  /** componentCount numbers for each of the piece's wedgeCount vertices, without padding. Owns its buffer. */
  array: TypedArray;
}

export interface DecodedPart {
  triangleCount: number;
  /** Three per triangle. Owns its buffer. */
  indices: Owned<Uint16Array> | Owned<Uint32Array>;
}

export interface DecodedPiece {
  /** Vertices in the sense of glTF: the count of the accessors. */
  wedgeCount: number;
  /** Distinct vertices of the surface. */
  vertexCount: number;
  attributes: DecodedAttribute[];
  parts: DecodedPart[];
}

export interface DecodedPayload {
  pieces: DecodedPiece[];
}

/** A part of a large piece that is decoded for itself, in its own numbers. */
export interface DecodedBlock {
  /** Its number, and how many there are. A payload without blocks yields each of its pieces as a block. */
  index: number;
  blockCount: number;
  /** The piece that it is a part of. */
  piece: number;
  /** The smallest box of its positions, in the units of the accessor; undefined for a piece without positions. */
  box?: { min: number[]; max: number[] };
  /** Vertices in the sense of glTF, those included that blocks before this one have too. */
  wedgeCount: number;
  repeatedCount: number;
  triangleCount: number;
  /** One for each attribute of the piece, with the elements of the block's own vertices. */
  attributes: DecodedAttribute[];
  /** One for each part of the piece: its triangles in the block, as indices of the block's own vertices. */
  parts: DecodedPart[];
}

/** A block of a payload of a GLB. */
export interface GlbBlock extends DecodedBlock {
  /** Which payload. */
  bufferView: number;
  /** What draws it: /meshes/MESH/primitives/PRIMITIVE, with `attributes` as numbers by name. */
  uses: { mesh: number; primitive: number; piece: number; part: number; attributes: Record<string, number> }[];
}

/** Bytes, or a stream of them such as the body of a response. Bytes must not change meanwhile. null, which a body may be, is refused. */
export type ByteSource = Uint8Array | ArrayBuffer | ReadableStream<Uint8Array> | AsyncIterable<Uint8Array> | null;

/** Bounds that are checked before memory is allocated for a payload. */
export interface Limits {
  maxVertices?: number;
  maxTriangles?: number;
  maxAttributes?: number;
  maxPieces?: number;
  /**
   * The elements of A.2.6, to which time and working memory are proportional. A payload has at most
   * 1024 of them for each of its bytes.
   */
  maxElements?: number;
  /** The size of all outputs together. */
  maxOutputBytes?: number;
}

/** Bounds of each payload of a file, and of all of them together. */
export interface FileLimits extends Limits {
  /**
   * What all payloads of a file may decode to, each counted once, with 32-bit indices. Default: 1024
   * bytes for each byte of the file (for loaders: of its payloads), but at least 256 MiB and at most
   * 4 GiB.
   */
  maxDecodedBytes?: number;
}

export interface DecodeOptions {
  limits?: Limits;
  /** 'auto', the default: 16 bits for pieces with up to 65535 vertices. */
  indexType?: 'auto' | 'uint16' | 'uint32';
  /** What a document says about the payload, from payloadsOf(); checked before memory is allocated. */
  claims?: readonly object[];
}

export interface BlockOptions extends DecodeOptions {
  /** The size of the payload, which is that of its buffer view. A stream needs it; no more is read. */
  payloadBytes?: number;
  /** 'any' yields blocks when they are decoded; 'index', the default, by their numbers. */
  order?: 'index' | 'any';
  /** Ends the iteration: next() rejects with its reason. */
  signal?: AbortSignal;
}

export interface GlbBlockOptions extends Omit<BlockOptions, 'payloadBytes' | 'claims' | 'limits'> {
  /** Default: decodeBlocks(). The one of a pool decodes in workers. */
  decodeBlocks?: (source: ByteSource, options: BlockOptions) => AsyncGenerator<DecodedBlock, void, void>;
  limits?: FileLimits;
}

export interface InitOptions {
  /** Where the module is, without and with SIMD. Default: the folder wasm/ next to decoder.mjs. */
  wasmUrl?: string | URL;
  simdWasmUrl?: string | URL;
  /**
   * Where its core is, likewise: a smaller module, which suffices for most payloads. If only the
   * others are given, the core is not used.
   */
  coreUrl?: string | URL;
  simdCoreUrl?: string | URL;
  /** The module itself, compiled or as bytes, instead of a place. */
  module?: WebAssembly.Module;
  bytes?: BufferSource;
}

export interface PoolOptions extends InitOptions {
  /**
   * The number of workers, from 1 to 1024; others are refused with an MccError. Default: one less than the processor has cores, at most
   * 4. A worker starts when it is first needed, and another takes its place if it fails.
   */
  workers?: number;
}

export interface PoolDecodeOptions extends DecodeOptions {
  /** Moves the buffer of `bytes` to the worker instead of copying it; afterwards it is empty. */
  transfer?: boolean;
  /**
   * Is called with each block of a payload with blocks, by their numbers, before all of them become the
   * piece. If it throws, decodePayload() rejects.
   */
  onBlock?: (block: DecodedBlock) => void;
}

export interface DecoderPool {
  readonly size: number;
  /**
   * Bound to the pool. What is not moved is copied when a worker takes it, so it must not change before. Rejects with an MccError if it
   * cannot be sent to a worker.
   */
  readonly decodePayload: (bytes: Uint8Array, options?: PoolDecodeOptions) => Promise<DecodedPayload>;
  /** decodeBlocks() in workers, several blocks at a time. Bound to the pool. */
  readonly decodeBlocks: (source: ByteSource, options?: BlockOptions) => AsyncGenerator<DecodedBlock, void, void>;
  /** Ends the workers; pending calls of decodePayload() reject. */
  dispose(): void;
}

/** A kind of error of the specification (A.1.4), or one of this package. */
export type ErrorCode =
  | 'Truncated' | 'BadMagic' | 'UnsupportedVersion' | 'BadChecksum' | 'BadHeader' | 'BadConnectivity' | 'BadStitch'
  | 'BadAttribute' | 'TrailingBytes' | 'Limit' | 'OutOfMemory' | 'BadArgument'
  | 'NotInCore' | 'Document' | 'Load' | 'Trap' | 'Disposed' | 'Encode';
