// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Work that takes time, in workers. A worker that is through waits for more, as it has compiled its WebAssembly; one that works at
// what is no longer wanted is ended.

/** One by module, at most. */
const idle = new Map();

function takeWorker(module) {
  const worker = idle.get(module) ?? new Worker(new URL(module, import.meta.url), { type: 'module' });
  idle.delete(module);
  return worker;
}

export class Job {
  /**
   * @param {string} module of the worker, relative to this one
   * @param {object} request what it gets
   * @param {(message: { name: string }) => void} onMessage what it says; `error` or `done` comes last
   */
  constructor(module, request, onMessage) {
    this.worker = takeWorker(module);
    this.worker.onmessage = ({ data }) => {
      if (['error', 'done'].includes(data.name)) {
        idle.set(module, this.worker);
        this.worker = undefined;
      }
      onMessage(data);
    };
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.stop();
      onMessage({ name: 'error', message: event.message || `${module} could not be loaded` });
    };
    this.worker.postMessage(request);
  }

  get isRunning() {
    return this.worker !== undefined;
  }

  stop() {
    this.worker?.terminate();
    this.worker = undefined;
  }
}
