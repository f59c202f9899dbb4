// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { InitOptions, Owned } from './types.mjs';

/**
 * What encodeGlb() needs of a decoder of EXT_meshopt_compression and KHR_meshopt_compression.
 * MeshoptDecoder of the npm package meshoptimizer is one.
 */
export interface MeshoptDecoder {
  /** Resolves when decodeGltfBuffer() can be called. */
  readonly ready: Promise<void>;
  /**
   * Fills `target` with `count` elements of `size` bytes each. Throws if the source is damaged.
   */
  decodeGltfBuffer(target: Uint8Array, count: number, size: number, source: Uint8Array, mode: string, filter?: string): void;
}

/** The options of the command line tool. 0 bits keep every bit. */
export interface EncodeOptions {
  /** Default 14, up to 24; also the lattice of morph targets. */
  positionBits?: number;
  /** Default 10, from 2 to 16. */
  normalBits?: number;
  /** Default 12. */
  texcoordBits?: number;
  /** Default 8. */
  colorBits?: number;
  /** Default 12, from 2 to 16. */
  tangentBits?: number;
  /** Default 12. */
  weightBits?: number;
  /** Every float keeps every bit. Excludes maxPositionError, positionLattice, step, quality, and bits other than 0. */
  lossless?: boolean;
  /** No position moves farther than this. Excludes positionBits and positionLattice. */
  maxPositionError?: number;
  /** maxPositionError is a fraction of the longest side of the bounding box. */
  isErrorRelative?: boolean;
  /**
   * x, y, z of a point of the lattice of positions, and its step. For tiles that must fit
   * together.
   */
  positionLattice?: [number, number, number, number];
  /**
   * The step of a lattice of positions through the origin, a power of two such as 2 ** -10, so that everything converted
   * with the same step fits together. Excludes positionBits, maxPositionError and positionLattice.
   */
  step?: number;
  /**
   * How large a mesh is drawn, from 16 to 2 ** 20 pixels: no position moves by more than a pixel, and the bits of all other
   * attributes follow as well. 4096 is usual. The report's `quality_choices` say what was chosen. Excludes all bits,
   * maxPositionError, positionLattice and step.
   */
  quality?: number;
  /** What shares a lattice of positions. Default 'mesh'. */
  grid?: 'mesh' | 'scene' | 'primitive';
  keepVertexOrder?: boolean;
  keepTriangleOrder?: boolean;
  /** Compresses the triangles alone. */
  indicesOnly?: boolean;
  /** Leaves out vertices that no triangle uses. */
  dropUnused?: boolean;
  /** Payloads that are smaller, or faster to decode. Default 'balanced'. */
  prefer?: 'balanced' | 'size' | 'speed';
  /**
   * Large surfaces are cut into blocks of this many triangles, which `decodeGlbBlocks()` shows while a file is loading; 0: never.
   * Default: 262,144, for surfaces of twice as many or more, but none with `prefer: 'size'`.
   */
  blockTriangles?: number;
  /**
   * Puts coarse versions of primitives of 100,000 triangles and more in front, with about so many triangles, for `loadGlb()` and
   * `loadWithPreview()` to show first; true: 2 % of those of the primitive. Excludes indicesOnly.
   */
  previewTriangles?: number | true;
  /** Compresses even where that makes the file larger. */
  allowLarger?: boolean;
  /** 2, or 3 as in the draft of glTF 2.1. Default: 2, but a copy of the input keeps its version. */
  glbVersion?: 2 | 3;
  fallback?: false;
  /**
   * Decodes buffer views that meshoptimizer compressed. Without it, encodeGlb() rejects files whose
   * triangles are in such views, with a message that names this option.
   */
  meshoptDecoder?: MeshoptDecoder;
}

export interface EncodeResult {
  /** The compressed file, or a copy of the input if nothing becomes smaller. */
  glb: Owned<Uint8Array>;
  /** What `gltf-mcc convert --report` writes, as far as it applies, and `seconds`. */
  report: {
    options: Record<string, unknown>;
    input_bytes: number;
    output_bytes: number;
    copied: boolean;
    checked: boolean;
    seconds: number;
    payloads: Record<string, unknown>[];
    primitives: Record<string, unknown>[];
    notes: string[];
    [name: string]: unknown;
  };
}

/**
 * Loads the encoder's module. If it is never called, encodeGlb() loads the module next to
 * encoder.mjs.
 */
export function initEncoder(options?: Omit<InitOptions, 'simdWasmUrl' | 'coreUrl' | 'simdCoreUrl'>): Promise<void>;

/**
 * Compresses a GLB, or a .gltf with its buffers in data URIs, decodes the result and compares it
 * with the source. Safe for untrusted bytes. Waits for `options.meshoptDecoder`, if there is one.
 */
export function encodeGlb(bytes: Uint8Array, options?: EncodeOptions): Promise<EncodeResult>;

/** Like encodeGlb(), but only after `await initEncoder()` and `await options.meshoptDecoder.ready`. */
export function encodeGlbSync(bytes: Uint8Array, options?: EncodeOptions): EncodeResult;

/**
 * Returns the edges along which the mesh of a payload was contracted, for programs that draw it. By
 * piece: two vertices per edge, numbered as in the indices, the last contraction first.
 */
export function mcEdges(payload: Uint8Array): Promise<Owned<Uint32Array>[]>;
