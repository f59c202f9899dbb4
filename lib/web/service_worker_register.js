// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Starts the service worker of a page, before the scripts that load models:
//
//     <script src="/gltf-mcc/service_worker_register.js" data-worker="/sw.js"></script>
//
// The first visit is loaded again as soon as the worker answers, since requests that came before it
// went past it.
(() => {
  const { worker = '/sw.js' } = document.currentScript.dataset;
  const { serviceWorker } = navigator;
  if (serviceWorker === undefined) {
    console.warn('gltf-mcc: service workers need HTTPS or localhost');
    return;
  }
  if (serviceWorker.controller === null) serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
  serviceWorker.register(worker, { type: 'module' }).catch((error) => console.error(`gltf-mcc: ${worker}: ${error.message}`));
})();
