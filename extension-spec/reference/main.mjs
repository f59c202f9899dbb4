// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

import { argv } from 'node:process';
import { pathToFileURL } from 'node:url';

// Whether the module with this import.meta is the program that was started.
export const isMain = (meta) => argv[1] !== undefined && meta.url === pathToFileURL(argv[1]).href;
