// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Lets modules of lib/web, and code from its README, find the packages of the tests and gltf-mcc; in a project they are in one
// node_modules. Modules that need it have to be imported by import() afterwards.
import { register } from 'node:module';

register('./peers_hook.mjs', import.meta.url);
