// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { runSnippet } from './stage.mjs';

globalThis.draw = async (model) => {
  const viewer = document.createElement('model-viewer');
  document.body.replaceChildren(viewer);
  const isLoaded = new Promise((resolve, reject) => {
    viewer.addEventListener('load', resolve, { once: true });
    viewer.addEventListener('error', ({ detail }) => reject(detail.sourceError ?? new Error(detail.type)), { once: true });
  });
  const isVisible = new Promise((resolve) => viewer.addEventListener('poster-dismissed', resolve, { once: true }));
  await runSnippet('model-viewer', model, {});
  await isLoaded;
  await isVisible;
  for (let i = 0; i < 2; ++i) await new Promise(requestAnimationFrame);
  return viewer.toDataURL();
};
