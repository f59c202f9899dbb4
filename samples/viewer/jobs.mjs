// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs work that takes time in workers. A worker that has finished waits for more work, because it
// has compiled its WebAssembly. A worker that is still busy with something no longer wanted is
// ended.

/** Idle workers, at most one per module. */
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
   * @param {(message: { name: string }) => void} onMessage what it says; `error` or `done` comes
   * last
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
