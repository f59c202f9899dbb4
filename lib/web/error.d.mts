// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { ErrorCode } from './types.mjs';

/** What is wrong, in plain English; preceded by a JSON path if that is known. */
export class MccError extends Error {
  constructor(message: string, code: ErrorCode);
  readonly code: ErrorCode;
}
