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
  /** One per accessor. */
  targets: Target[];
  /** Plain data for decodePayload(bytes, { claims }). */
  claims: object[];
}

/** The payloads of a glTF document, each once: buffer views of the same bytes hold one. Throws an MccError where the document violates the specification. */
export function payloadsOf(json: object): Payload[];

/** The array that fills the accessor of a target: tight, and in the component type of the accessor. */
export function elementsOf(decoded: DecodedPayload, target: Target, accessor: { componentType: number }): TypedArray;

/** All primitives with the extension. */
export function extensionUses(json: object): { extension: any; primitive: any; path: string }[];

/** Components by type of accessor. */
export const COMPONENT_COUNTS: Record<'SCALAR' | 'VEC2' | 'VEC3' | 'VEC4' | 'MAT2' | 'MAT3' | 'MAT4', number>;
