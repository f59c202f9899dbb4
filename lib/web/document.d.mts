// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { DecodedPayload, TypedArray } from './types.mjs';

export const EXTENSION_NAME: 'KHR_mesh_collapse_compression';

/** An accessor, and the attribute or the part of a piece that fills it. */
export interface Target {
  accessor: number;
  piece: number;
  attribute?: number;
  part?: number;
}

export interface Payload {
  bufferView: number;
  /** The buffer, where the payload begins, and where it ends. */
  source: [number, number, number];
  /** One per accessor. */
  targets: Target[];
  /** Plain data for decodePayload(bytes, { claims }). */
  claims: object[];
}

/**
 * Lists the payloads of a glTF document, each once: buffer views of the same bytes hold one
 * payload. Throws an MccError with a JSON path if the document violates the specification, if what is
 * read of it is of a wrong type, or if payloads overlap, since work and memory must be in proportion
 * to its bytes. Of a document without payloads nothing is checked.
 */
export function payloadsOf(json: object): Payload[];

/**
 * Returns the array that fills the accessor of a target, without padding, in the component type of
 * the accessor.
 */
export function elementsOf(decoded: DecodedPayload, target: Target, accessor: { componentType: number }): TypedArray;

/** Lists all primitives with the extension. */
export function extensionUses(json: object): { extension: any; primitive: any; path: string }[];

/** The number of components by accessor type. */
export const COMPONENT_COUNTS: Record<'SCALAR' | 'VEC2' | 'VEC3' | 'VEC4' | 'MAT2' | 'MAT3' | 'MAT4', number>;
