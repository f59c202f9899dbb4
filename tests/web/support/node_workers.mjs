// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/**
 * Gives Node the class Worker of browsers meanwhile, and calls `change` with each worker that is made, whose `messages` are those that have
 * come from it.
 */
export async function withWorkers(change, work) {
  const { Worker } = globalThis;
  const { Worker: NodeWorker } = await import('node:worker_threads');
  const made = [];
  globalThis.Worker = class {
    constructor(url) {
      this.worker = new NodeWorker(url);
      made.push(this.worker);
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
  } catch (error) {
    for (const worker of made) worker.terminate(); // which would keep Node running
    throw error;
  } finally {
    globalThis.Worker = Worker;
  }
}
