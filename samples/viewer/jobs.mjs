// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Runs work that takes time in workers. A worker that has finished waits for more work, because it
// has compiled its WebAssembly. A worker that is still busy with something no longer wanted is
// ended.

/** Idle workers, at most one per module. */
const idle = new Map();

const startWorker = (module) => new Worker(new URL(module, import.meta.url), { type: 'module' });

function takeWorker(module) {
  const worker = idle.get(module) ?? startWorker(module);
  idle.delete(module);
  return worker;
}

export class Job {
  /**
   * @param {string} module of the worker, relative to this one
   * @param {object} request what it gets
   * @param {(message: { name: string }) => void} onMessage what it says; `error` or `done` comes
   * last
   * @param {boolean} [isFresh] a new worker, which is not used again: nothing is loaded or compiled in it
   */
  constructor(module, request, onMessage, isFresh = false) {
    this.worker = isFresh ? startWorker(module) : takeWorker(module);
    this.worker.onmessage = ({ data }) => {
      if (['error', 'done'].includes(data.name)) {
        if (isFresh) this.worker.terminate();
        else idle.set(module, this.worker);
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

/**
 * Resolves with the last message of a job, or rejects with its error.
 * @param {{ signal: AbortSignal, isFresh?: boolean, onProgress?: (message) => void }} how the signal ends the job
 */
export function runJob(module, request, { signal, isFresh, onProgress }) {
  return new Promise((resolve, reject) => {
    signal.throwIfAborted();
    const job = new Job(module, request, (message) => {
      if (message.name === 'done') resolve(message);
      else if (message.name === 'error') reject(new Error(message.message));
      else onProgress?.(message);
    }, isFresh);
    signal.addEventListener('abort', () => {
      job.stop();
      reject(signal.reason);
    });
  });
}
