// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/**
 * Gives Node the class Worker of browsers meanwhile, and calls `change` with each worker that is made, whose `messages` are those that have
 * come from it.
 */
export async function withWorkers(change, work) {
  const { Worker } = globalThis;
  const { Worker: NodeWorker } = await import('node:worker_threads');
  globalThis.Worker = class {
    constructor(url) {
      this.worker = new NodeWorker(url);
      this.messages = [];
      this.worker.on('message', (data) => {
        this.messages.push(data);
        this.onmessage({ data });
      });
      this.worker.on('error', (error) => this.onerror(error));
      change(this);
    }

    postMessage(...args) { this.worker.postMessage(...args); }

    terminate() { this.worker.terminate(); }
  };
  try {
    await work();
  } finally {
    globalThis.Worker = Worker;
  }
}
