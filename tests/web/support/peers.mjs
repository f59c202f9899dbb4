// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Lets modules of lib/web find their peer dependencies where those of the tests are; in a project both are in one node_modules.
// Modules that need it have to be imported by import() afterwards.
import { register } from 'node:module';

register('./peers_hook.mjs', import.meta.url);
