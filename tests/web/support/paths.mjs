// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));

export const ROOT = path.resolve(here, '../../..');
export const LIBRARY = path.join(ROOT, 'lib/web');
export const SAMPLES = path.join(ROOT, 'samples');
export const ENGINES = path.join(ROOT, 'tests/web/node_modules');
export const PAGES = path.resolve(here, '../browser/pages');
export const PLAIN = path.resolve(here, '../browser/plain');
