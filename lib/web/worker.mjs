// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A worker of a decoder pool.
import { serve } from './serve.mjs';

serve();
