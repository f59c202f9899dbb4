// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { InitOptions } from './types.mjs';

/** As in the command line tool. Bits: 0 keeps every bit. */
export interface EncodeOptions {
  /** Default 14, up to 24; also the grid of morph targets. */
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
  /** Every float keeps every bit; the bits above are ignored. */
  lossless?: boolean;
  /** No position moves farther than this; positionBits is ignored. */
  maxError?: number;
  /** maxError is a fraction of the longest side of the box. */
  maxErrorRelative?: boolean;
  /** x, y, z of a point of the grid of positions and its step, for tiles that must fit together. */
  lattice?: [number, number, number, number];
  /** What shares a grid of positions. Default 'mesh'. */
  grid?: 'mesh' | 'scene' | 'primitive';
  keepVertexOrder?: boolean;
  keepTriangleOrder?: boolean;
  /** Compresses the triangles alone. */
  indicesOnly?: boolean;
  /** Leaves out vertices that no triangle uses. */
  dropUnused?: boolean;
  /** 0 fast to 2 thorough. Default 1. */
  effort?: 0 | 1 | 2;
  /** Payloads that are smaller, or faster to decode. Default 'balanced'. */
  prefer?: 'balanced' | 'size' | 'speed';
  /** Compress also where that makes the file larger. */
  allowLarger?: boolean;
  fallback?: false;
}

export interface EncodeResult {
  /** The compressed file; the input itself, copied, where nothing becomes smaller. */
  glb: Uint8Array;
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

/** Where the encoder's module is, or what it is. Without a call encodeGlb() loads it from beside encoder.mjs. */
export function initEncoder(options?: Omit<InitOptions, 'simdWasmUrl'>): Promise<void>;

/** Compresses a GLB, decodes the result and compares it with the source. Safe for untrusted bytes. */
export function encodeGlb(bytes: Uint8Array, options?: EncodeOptions): Promise<EncodeResult>;

/** The same, once the encoder is loaded: after `await initEncoder()`. */
export function encodeGlbSync(bytes: Uint8Array, options?: EncodeOptions): EncodeResult;

/**
 * The edges along which the mesh of a payload was contracted, by piece: two vertices each, numbered as in the indices, the last
 * contraction first. For those who draw it.
 */
export function mcEdges(payload: Uint8Array): Promise<Uint32Array[]>;
