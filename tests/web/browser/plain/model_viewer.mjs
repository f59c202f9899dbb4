// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
globalThis.draw = async (url) => {
  const viewer = document.querySelector('model-viewer');
  await new Promise((resolve, reject) => {
    viewer.addEventListener('load', resolve, { once: true });
    viewer.addEventListener('error', ({ detail }) => reject(detail.sourceError ?? new Error(detail.type)), { once: true });
    viewer.src = url;
  });
  for (let last = ''; ;) {
    await new Promise((resolve) => setTimeout(resolve, 300));
    const picture = viewer.toDataURL();
    if (picture === last) return picture;
    last = picture;
  }
};
