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

/** Creates a worker that has the interface of the browser's. */
export async function workerOfNode(onMessage, onError) {
  const threads = await importOfNode('worker_threads');
  const worker = new threads.Worker(new URL('./worker.mjs', import.meta.url));
  worker.on('message', onMessage);
  for (const event of ['error', 'messageerror']) worker.on(event, onError);
  worker.on('exit', () => onError({ message: 'it has ended' }));
  return worker;
}

/** Calls a function with each message to this worker, and with a function that answers. Messages are queued until it listens. */
export async function listenInNode(take, unreadable) {
  const { parentPort } = await importOfNode('worker_threads');
  parentPort.on('message', (data) => take(data, (message, moved) => parentPort.postMessage(message, moved)));
  parentPort.on('messageerror', () => parentPort.postMessage(unreadable));
}
