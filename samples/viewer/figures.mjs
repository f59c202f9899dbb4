// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows sizes, times and errors as text and tables.
import { CODECS } from './comparison.mjs';
import { element } from './element.mjs';
import { formatCount, formatMilliseconds, formatPercent, formatSmall } from './format.mjs';
import { VERSIONS } from './vendor/versions.mjs';

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
 * @param {{ [codec]: { streams?: Map<string, number>, bytes?: number, errors: string[] } }} codecs streams: not there yet, or not
 * to be had
 */
export function showStreams(table, codecs) {
  const known = Object.values(codecs).map(({ streams }) => streams ?? new Map());
  const names = [...new Set(known.flatMap((streams) => [...streams.keys()]))].sort((a, b) => rank(a) - rank(b));
  const most = Math.max(...known.flatMap((streams) => [...streams.values()]));
  table.replaceChildren(
    headOf('Stream'),
    element('tbody', {}, ...names.map((name) => element('tr', {},
      element('th', { scope: 'row' }, name),
      ...Object.keys(CODECS).map((codec) => cell(codecs[codec].streams?.get(name), most, codec))))),
    element('tfoot', {}, rowOf(totalsOf(codecs))));
}

/** Shows a row per figure: bytes, times. @param {HTMLTableElement} table */
export function showCodecs(table, codecs) {
  table.replaceChildren(headOf(titleOf(codecs)), element('tbody', {}, ...rowsOf(codecs).map(rowOf)));
}

/** What the figures are of. */
export const titleOf = ({ ours }) => (ours.allBytes === undefined ? 'Payloads' : 'Without morph targets');

const headOf = (title) => element('thead', {}, element('tr', {},
  element('th', { scope: 'col' }, title),
  ...Object.entries(CODECS).map(([codec, name]) => element('th', { scope: 'col' }, key(codec), name))));

const rowOf = ({ name, cells }) => element('tr', {},
  element('th', { scope: 'row' }, name),
  ...cells.map(({ text, ratio, isLeast }) => element('td', isLeast ? { class: 'least' } : {},
    number(text), element('span', { class: 'ratio' }, ratio))));

const FIGURES = [
  ['Bytes', 'bytes', formatCount],
  ['Bytes after brotli', 'brotliBytes', formatCount],
  ['Load + first decode', 'first', formatMilliseconds],
  ['Best decode', 'best', formatMilliseconds],
];

/**
 * The figures of all codecs as text, for the page and the picture.
 * @returns {{ name: string, cells: { text: string, ratio: string, isLeast: boolean }[] }[]} ratio: to ours; cells in the order of CODECS
 */
export function rowsOf(codecs) {
  const rows = FIGURES.map(([name, figure, format]) => ({ name, cells: cellsOf(codecs, ({ [figure]: value }) => value, format) }));
  if (codecs.ours.allBytes === undefined) return rows;
  return [...rows, { name: 'Bytes with morph targets', cells: cellsOf(codecs, ({ allBytes }) => allBytes, formatCount) }];
}

/** The sums of the streams. */
function totalsOf(codecs) {
  const totals = cellsOf(codecs, ({ allBytes, bytes }) => allBytes ?? bytes, formatCount);
  return { name: 'all', cells: Object.keys(CODECS).map((codec, i) => (
    codecs[codec].uncodedBytes === undefined ? totals[i] : { ...totals[i], ratio: 'without morph targets', isLeast: false })) };
}

function cellsOf(codecs, valueOf, format) {
  const values = Object.keys(CODECS).map((codec) => valueOf(codecs[codec]));
  const least = Math.min(...values.filter((value) => value > 0));
  return Object.keys(CODECS).map((codec, i) => ({
    text: values[i] === undefined ? missing(codecs[codec]) : format(values[i]),
    ratio: i === 0 || !(values[i] > 0 && values[0] > 0) ? '' : comparison(format(values[0]), format(values[i]), values[i] / values[0]),
    isLeast: values[i] === least,
  }));
}

const missing = ({ errors, isComplete }) => (errors.length !== 0 || isComplete ? '–' : '…');

const key = (kind) => element('span', { class: `key ${kind}` });

const number = (text) => element('span', { class: 'number' }, text);

function cell(bytes, most, kind) {
  if (bytes === undefined) return element('td', {}, number('–'));
  const bar = element('span', { class: `bar ${kind}` });
  bar.style.width = `${Math.max(100 * bytes / most, 0.5)}%`;
  return element('td', {}, number(formatCount(bytes)), element('span', { class: 'track' }, bar));
}

function comparison(ours, theirs, ratio) {
  if (ours === theirs) return 'the same';
  return ratio > 1 ? `${ratio < 100 ? ratio.toFixed(2) : Math.round(ratio)} × ours` : `${formatPercent(ratio)} of ours`;
}

/** @param {HTMLDListElement} list @param {[string, string, string?][]} entries name, figure, more */
export function showSummary(list, entries) {
  list.replaceChildren(...entries.map(([name, figure, more = '']) => element('div', {},
    element('dt', {}, name), element('dd', {}, element('b', { class: 'number' }, figure), element('span', {}, more)))));
}

/** Lists what is known so far about a compression. */
export function summaryOf({ sourceBytes, isCompressed, report, glb, errors }) {
  const sizes = `${formatCount(sourceBytes)} → ${formatCount(glb.length)}`;
  const entries = [['File', sizes, `bytes, ${formatPercent(glb.length / sourceBytes)}${isCompressed ? ' of what the file decodes to' : ''}`]];
  const payloadBytes = sum(report.payloads, 'bytes');
  const triangles = sum(report.payloads, 'triangles');
  if (triangles !== 0) {
    const vertices = formatCount(sum(report.payloads, 'vertices'));
    const rate = formatSmall(8 * payloadBytes / triangles);
    entries.push(['Triangles', formatCount(triangles), `and ${vertices} vertices in ${formatCount(payloadBytes)} bytes, ${rate} bits per triangle`]);
  }
  if (errors !== undefined) entries.push(['Largest error', formatSmall(errors.most), describeError(errors)]);
  return entries;
}

function describeError({ most, side, mean }) {
  if (most === 0) return 'every position is exact';
  return `units of the model, ${formatSmall(most / side)} of the box; ${formatSmall(mean)} on average`;
}

export const sum = (list, name) => list.reduce((all, entry) => all + entry[name], 0);

/** Sentences on what the figures do not say. @param {{ report, codecs, errors }} result @param {{ lossless, keepsOrder }} options */
export function remarksOn({ report, codecs, errors }, options) {
  const { ours, draco, meshopt } = codecs;
  const all = [];
  if (draco.streams !== undefined) all.push(...dracoRemarks(draco, options));
  if (meshopt.streams !== undefined) all.push(...meshoptRemarks(options));
  const dropped = sum(report.payloads, 'triangles') - draco.triangles;
  if (dropped > 0) all.push(`Draco drops ${formatCount(dropped)} triangles.`);
  if (options.keepsOrder && (draco.bytes ?? meshopt.bytes) !== undefined) all.push('Draco and meshopt do not keep the order here.');
  for (const [codec, name] of Object.entries(CODECS)) for (const error of codecs[codec].errors) all.push(errorOf(name, codecs[codec], error));
  if (ours.streams.has('JOINTS_0') && ours.streams.get('WEIGHTS_0') === 0) all.push('Mesh collapse codes weights with their joints.');
  if (errors?.missed > 0) all.push(`${formatCount(errors.missed)} vertices of the source have no decoded vertex within the promised distance.`);
  all.push(...keptRemarks(report));
  if (Object.values(codecs).some(({ best }) => best !== undefined)) {
    all.push('Times are for all payloads on one thread of this device: from nothing in a new worker, with the decoder from the network or the',
      'browser’s cache; and the shortest of several runs.');
  }
  if (Object.values(codecs).some(({ brotliBytes }) => brotliBytes !== undefined)) all.push(`Brotli: brotli-wasm ${VERSIONS.brotli} at quality 11.`);
  return all;
}

const errorOf = (name, { bytes }, error) => `${bytes === undefined ? `No comparison with ${name}` : `${name}: a figure is missing`}: ${error}.`;

const quantised = (lossless) => (lossless ? 'not quantised' : 'with the same bits');

function dracoRemarks({ speed, uncodedBytes }, { lossless }) {
  const all = [`Draco ${VERSIONS.draco} at speed ${speed}, which of 0, 3 and 5 gives its smallest result, ${quantised(lossless)};`,
    'its seams are counted with the attributes that have them.'];
  if (uncodedBytes !== undefined) {
    all.push(`Draco has no coding for morph targets: it leaves ${formatCount(uncodedBytes)} bytes of them as they are.`,
      'The codecs are therefore compared on the file without them.');
  }
  return all;
}

const meshoptRemarks = ({ lossless }) => [
  `meshopt ${VERSIONS.meshopt} as gltfpack -cz has it, ${quantised(lossless)}: it is made to be compressed once more by the server, and a graphics`,
  'card takes what it decodes to.',
];

function keptRemarks(report) {
  const kept = report.primitives.filter(({ compressed }) => !compressed);
  if (kept.length === 0 || report.copied) return [];
  const why = kept[0].note ? ` (${kept[0].note})` : '';
  return [`${kept.length} of ${report.primitives.length} primitives are left as they were${why}.`];
}
