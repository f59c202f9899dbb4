// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds the longest task of a page's thread in a trace of Chromium.

export const CATEGORIES = ['devtools.timeline', 'disabled-by-default-devtools.timeline', 'blink.user_timing'];

/**
 * Looks at the thread that has set the marks `load-begin` and `load-end`, between them.
 * @param {Buffer} trace
 * @returns {{ elapsed: number, cpu: number }} milliseconds of the longest task, by the clock on the wall and of the
 *   processor, which other programs do not change
 */
export function longestTask(trace) {
  const { traceEvents: events } = JSON.parse(trace.toString('utf8'));
  const mark = (name) => events.find((event) => event.name === name && event.cat.includes('user_timing'));
  const [begin, end] = [mark('load-begin'), mark('load-end')];
  if (begin === undefined || end === undefined) throw new Error('the trace has no marks');
  const tasks = events.filter(({ name, pid, tid, ts }) => name === 'RunTask' && pid === begin.pid && tid === begin.tid
    && ts >= begin.ts && ts <= end.ts);
  if (tasks.length === 0) throw new Error('the trace has no tasks');
  const most = (key) => Math.max(...tasks.map((task) => (task[key] ?? 0) / 1000));
  return { elapsed: most('dur'), cpu: most('tdur') };
}
