// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What only Node has. By package.json, bundlers for browsers take no_node.mjs instead: a dynamic import, although it is never called,
// would make them add code that loads other modules, and the URL of a script for Node makes them add that script.

/** Imports a module of Node. */
function importOfNode(name) {
  return import(/* @vite-ignore */ /* webpackIgnore: true */ `node:${name}`);
}

/** Returns a promise of the bytes of a file; undefined for other URLs. */
export const fileOf = (url) => (url.protocol === 'file:' ? importOfNode('fs/promises').then(({ readFile }) => readFile(url)) : undefined);

/** Creates a worker that has the interface of the browser's. `take` is called with each message, or undefined and an error. */
export async function workerOfNode(take) {
  const threads = await importOfNode('worker_threads');
  const worker = new threads.Worker(new URL('./worker.mjs', import.meta.url));
  worker.on('message', take);
  for (const event of ['error', 'messageerror']) worker.on(event, (error) => take(undefined, error));
  worker.on('exit', () => take(undefined, { message: 'it has ended' }));
  return worker;
}

/** Calls a function with each message to this worker, and `use` with one that answers. Messages are queued until then. */
export async function listenInNode(take, unreadable, use) {
  const { parentPort } = await importOfNode('worker_threads');
  use((message, moved) => parentPort.postMessage(message, moved));
  parentPort.on('message', take);
  parentPort.on('messageerror', () => parentPort.postMessage(unreadable));
}
