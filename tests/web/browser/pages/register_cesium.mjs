// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Makes the CesiumJS of a page that knows nothing of the library decode.
globalThis.CESIUM_BASE_URL = '/engines/cesium/Build/Cesium/'; // wanted when the module is loaded
const [{ Resource }, { registerMeshCollapse }] = await Promise.all([import('/engines/cesium/Build/Cesium/index.js'), import('/lib/cesium.mjs')]);

registerMeshCollapse(Resource);
globalThis.isRegistered = true;
