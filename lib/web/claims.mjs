// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks what a document says about a payload against the payload's header, before memory is
// allocated for it.
import { fail } from './error.mjs';

/**
 * Checks all claims. `info` is a DecodedPayload without arrays; `claims` is plain data from
 * payloadsOf().
 */
export function checkClaims(info, claims) {
  for (const claim of claims) checkPrimitive(info, claim);
}

function checkPrimitive({ pieces }, claim) {
  const piece = pieces[claim.piece];
  if (piece === undefined) {
    fail(`${claim.path}/piece`, `there is no piece ${claim.piece} in the payload, which has ${pieces.length}`);
  }
  const part = piece.parts[claim.part];
  if (part === undefined) {
    fail(`${claim.path}/part`, `there is no part ${claim.part} in the piece, which has ${piece.parts.length}`);
  }
  if (piece.wedgeCount === 0 || part.triangleCount === 0) fail(claim.path, 'the piece or the part is empty');
  for (const attribute of claim.attributes) checkAttribute(piece, attribute);
  const { path, count, size } = claim.indices;
  if (count !== 3 * part.triangleCount) {
    fail(`${path}/count`, `${count} does not match the payload, which has ${3 * part.triangleCount} indices`);
  }
  if (piece.wedgeCount >= 256 ** size) {
    fail(`${path}/componentType`, `cannot hold indices of ${piece.wedgeCount} vertices`);
  }
  for (const ordinary of claim.ordinary) checkCount(piece, ordinary);
}

function checkCount({ wedgeCount }, { path, count }) {
  if (count !== wedgeCount) fail(`${path}/count`, `${count} does not match the payload, which has ${wedgeCount} vertices`);
}

function checkAttribute(piece, claim) {
  const coded = piece.attributes[claim.attribute];
  if (coded === undefined) {
    fail(claim.path, `there is no attribute ${claim.attribute} in the payload's piece, which has ${piece.attributes.length}`);
  }
  checkCount(piece, claim.accessor);
  for (const key of ['componentType', 'componentCount', 'normalized', 'semantic', 'set', 'morphTarget']) {
    if (coded[key] !== claim[key]) fail(claim.path, `${key} is ${claim[key]}, but ${coded[key]} in the payload`);
  }
}
