// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { Extension, type Document, type ReaderContext, type WriterContext } from '@gltf-transform/core';
import type { EncodeOptions, EncodeResult } from './encoder.mjs';

/**
 * Reads and writes the extension. It needs the dependency 'mcc.decoder' and, for writing,
 * 'mcc.encoder'; 'mcc.limits' may be FileLimits for reading.
 */
export class KHRMeshCollapseCompression extends Extension {
  static readonly EXTENSION_NAME: 'KHR_mesh_collapse_compression';
  readonly extensionName: 'KHR_mesh_collapse_compression';
  /** Sets the options. They take effect when the document is written. */
  setEncoderOptions(options: EncodeOptions): this;
  /** Returns the sizes and measured errors of the last write; undefined before the first. */
  getReport(): EncodeResult['report'] | undefined;
  read(context: ReaderContext): this;
  write(context: WriterContext): this;
}

/** Returns a transform after which the document is compressed when it is written. */
export function meshCollapse(options?: EncodeOptions): (document: Document) => void;
