// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows sizes, times and errors as text and tables.
import { element } from './element.mjs';
import { formatCount, formatMilliseconds, formatPercent, formatSmall } from './format.mjs';

const FIRST = ['connectivity', 'stitching', 'leftovers', 'order', 'seams', 'POSITION'];
const LAST = ['header'];

/** Returns the bytes of each stream, summed over all payloads of a report. */
export function streamsOf({ payloads }) {
  const streams = new Map();
  const add = (name, bytes) => streams.set(name, (streams.get(name) ?? 0) + bytes);
  for (const { stream_bytes: parts, attributes } of payloads) {
    for (const [name, bytes] of Object.entries(parts)) if (bytes > 0) add(name, bytes);
    for (const { name, coded_bytes: bytes } of attributes) add(name, bytes);
  }
  return streams;
}

const rank = (name) => (FIRST.includes(name) ? FIRST.indexOf(name) : LAST.includes(name) ? 1000 : 100);

/**
 * @param {HTMLTableElement} table
 * @param {Map<string, number>} ours @param {number} oursTotal
 * @param {{ streams: Map<string, number>, byteLength: number } | undefined} draco not there yet, or
 * not to be had
 */
export function showStreams(table, ours, oursTotal, draco) {
  const names = [...new Set([...ours.keys(), ...draco?.streams.keys() ?? []])].sort((a, b) => rank(a) - rank(b));
  const most = Math.max(...ours.values(), ...draco?.streams.values() ?? [0]);
  table.replaceChildren(
    element('thead', {}, element('tr', {},
      element('th', { scope: 'col' }, 'Stream'),
      element('th', { scope: 'col' }, key('ours'), 'Mesh collapse'),
      element('th', { scope: 'col' }, key('draco'), 'Draco'))),
    element('tbody', {}, ...names.map((name) => element('tr', {},
      element('th', { scope: 'row' }, name),
      cell(ours.get(name), most, 'ours'),
      cell(draco?.streams.get(name), most, 'draco')))),
    element('tfoot', {}, element('tr', {},
      element('th', { scope: 'row' }, 'all'),
      element('td', {}, number(formatCount(oursTotal))),
      element('td', {}, number(draco === undefined ? '…' : formatCount(draco.byteLength)),
        element('span', { class: 'ratio' }, draco === undefined ? '' : comparison(oursTotal, draco.byteLength))))));
}

const key = (kind) => element('span', { class: `key ${kind}` });

const number = (text) => element('span', { class: 'number' }, text);

function cell(bytes, most, kind) {
  if (bytes === undefined) return element('td', {}, number('–'));
  const bar = element('span', { class: `bar ${kind}` });
  bar.style.width = `${Math.max(100 * bytes / most, 0.5)}%`;
  return element('td', {}, number(formatCount(bytes)), element('span', { class: 'track' }, bar));
}

function comparison(ours, draco) {
  if (ours === draco) return 'the same';
  return ours < draco ? `${(draco / ours).toFixed(2)} × ours` : `${formatPercent(draco / ours)} of ours`;
}

/** @param {HTMLDListElement} list @param {[string, string, string?][]} entries name, figure, more */
export function showSummary(list, entries) {
  list.replaceChildren(...entries.map(([name, figure, more = '']) => element('div', {},
    element('dt', {}, name), element('dd', {}, element('b', { class: 'number' }, figure), element('span', {}, more)))));
}

/** Lists what is known so far about a compression. */
export function summaryOf({ sourceBytes, report, glb, timing, errors, draco, dracoError }) {
  const sizes = `${formatCount(sourceBytes)} → ${formatCount(glb.length)}`;
  const entries = [['File', sizes, `bytes, ${formatPercent(glb.length / sourceBytes)}`]];
  const payloadBytes = sum(report.payloads, 'bytes');
  const triangles = sum(report.payloads, 'triangles');
  if (triangles !== 0) {
    const vertices = formatCount(sum(report.payloads, 'vertices'));
    const rate = formatSmall(8 * payloadBytes / triangles);
    entries.push(['Triangles', formatCount(triangles), `and ${vertices} vertices in ${formatCount(payloadBytes)} bytes, ${rate} bits per triangle`]);
  }
  if (timing !== undefined) {
    const theirs = draco === undefined ? '…' : formatMilliseconds(draco.decodeMilliseconds);
    entries.push(['Decoding', formatMilliseconds(timing.decodeMilliseconds), dracoError === undefined ? `Draco ${theirs}` : '']);
  }
  if (errors !== undefined) entries.push(['Largest error', formatSmall(errors.most), describeError(errors)]);
  return entries;
}

function describeError({ most, side, mean }) {
  if (most === 0) return 'every position is exact';
  return `units of the model, ${formatSmall(most / side)} of the box; ${formatSmall(mean)} on average`;
}

export const sum = (list, name) => list.reduce((all, entry) => all + entry[name], 0);
