// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The page: it opens files, reacts to changed options, and shows results.
import { compareCodecs } from './comparison.mjs';
import { element } from './element.mjs';
import { remarksOn, showCodecs, showStreams, showSummary, streamsOf, sum, summaryOf } from './figures.mjs';
import { formatCount, formatPercent, formatSmall } from './format.mjs';
import { checkFileSize, chooseModel, wholeGlb } from './files.mjs';
import { checkDocument, FileError, readGlb } from './glb.mjs';
import { Job } from './jobs.mjs';
import { Options } from './options.mjs';
import { drawReport } from './picture.mjs';
import { ERROR_RAMP, ORDER_RAMP } from './ramps.mjs';
import { reportOf } from './report.mjs';
import { saveFiles } from './save.mjs';
import { hasTargets } from './targets.mjs';
import { createDecoderPool, loadGlb } from './vendor/gltf-mcc/index.mjs';
import { claimsBlocks } from './vendor/gltf-mcc/blocks.mjs';
import { EXTENSION_NAME } from './vendor/gltf-mcc/document.mjs';
import { LinkedViews } from './views.mjs';

const SAMPLES = ['koi', 'textured', 'torus', 'genus3', 'sheet_with_holes', 'two_materials', 'skinned', 'morphed', 'moebius',
  'non_manifold', 'quantized'];
const EXAMPLES = ['koi', 'textured', 'torus', 'sheet_with_holes', 'two_materials'];
/** Encoding takes a thousand bytes of memory per triangle, and seconds per million triangles. */
const MAX_TRIANGLES = 4_000_000;

const $ = (id) => document.getElementById(id);
const titleOf = (sample) => sample.replaceAll('_', ' ');

class Page {
  constructor() {
    this.options = new Options($('options'), () => this.compress());
    this.listen();
  }

  listen() {
    const choose = () => $('file').click();
    $('open').onclick = $('drop-open').onclick = choose;
    $('file').onchange = () => this.openFiles([...$('file').files]);
    for (const name of SAMPLES) $('sample').append(element('option', { value: name }, titleOf(name)));
    $('sample').onchange = () => $('sample').value !== '' && this.openSample($('sample').value);
    for (const name of EXAMPLES) {
      $('chips').append(element('li', {}, element('button', { type: 'button', onclick: () => this.openSample(name) }, titleOf(name))));
    }
    for (const mode of ['wireframe', 'heat', 'tree']) $(mode).onclick = () => this.toggle(mode);
    $('play').onclick = () => this.play(!this.views.isPlaying);
    $('reset').onclick = () => this.views.frame();
    $('cancel').onclick = () => this.cancel();
    $('download').onclick = () => this.download();
    $('report').onclick = () => this.report();
    document.addEventListener('keydown', (event) => this.onKey(event));
    this.listenForDrops();
  }

  listenForDrops() {
    const mark = (on) => document.body.classList.toggle('dragging', on);
    document.addEventListener('dragover', (event) => {
      event.preventDefault();
      mark(true);
    });
    document.addEventListener('dragleave', (event) => event.relatedTarget === null && mark(false));
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      mark(false);
      this.openFiles([...event.dataTransfer.files]);
    });
  }

  onKey(event) {
    if (event.key === 'Escape' && this.isBusy) this.cancel();
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches('input, select')) return;
    const mode = { w: 'wireframe', e: 'heat', c: 'tree' }[event.key.toLowerCase()];
    if (mode !== undefined && !$('work').hidden && !$(mode).disabled) this.toggle(mode);
    if (event.key.toLowerCase() === 'p' && !$('play').hidden) this.play(!this.views.isPlaying);
  }

  // ---- files

  async openSample(name) {
    await this.open(`${name}.glb`, async () => {
      const response = await fetch(`vendor/samples/${name}.glb`);
      if (!response.ok) throw new FileError(`There is no sample ${name}.glb.`);
      return { bytes: new Uint8Array(await response.arrayBuffer()), ignored: [] };
    });
  }

  /** @param {File[]} files that were dropped or chosen together */
  async openFiles(files) {
    if (files.length === 0) return;
    const { model, parts, others } = chooseModel(files);
    await this.open(model.name, async () => {
      checkFileSize(model.size);
      const { bytes, unused } = await wholeGlb(model.name, new Uint8Array(await model.arrayBuffer()), parts);
      return { bytes, ignored: [...others, ...unused].map(({ name }) => name) };
    });
    $('file').value = '';
    $('sample').value = '';
  }

  /** A file that cannot be read leaves the current one in place. */
  async open(name, read) {
    this.say('error', '');
    try {
      const { bytes, ignored } = await read();
      const { json } = readGlb(bytes);
      checkDocument(json);
      checkSize(json);
      this.file = { name, bytes, json, ignored };
    } catch (error) {
      this.say('error', `${name}: ${error instanceof FileError ? error.message : `The file is damaged (${error.message}).`}`);
      return;
    }
    this.isNew = true;
    this.views?.clear();
    $('original-size').textContent = '';
    $('play').hidden = true;
    this.clearFigures();
    this.compress();
  }

  showWork() {
    const hadFocus = $('drop').contains(document.activeElement);
    $('drop').hidden = true;
    $('work').hidden = false;
    $('actions').hidden = false;
    $('file-name').hidden = false;
    $('file-name').textContent = this.file.name;
    if (this.views !== undefined) return;
    this.views = new LinkedViews({ original: $('original'), compressed: $('compressed') });
    if (hadFocus) $('original').focus({ preventScroll: true });
  }

  // ---- work

  get isBusy() {
    return this.job?.isRunning || this.run?.isComparing;
  }

  compress() {
    if (this.file === undefined) return;
    this.stop();
    this.say('error', '');
    this.notes = ignoredNotes(this.file);
    this.note();
    try {
      this.showWork();
    } catch (error) {
      this.fail(`The viewer needs WebGL, which this browser does not provide (${error.message}).`);
      return;
    }
    this.result = { sourceBytes: this.file.bytes.length };
    $('waiting').textContent = this.isNew ? 'Compressing…' : '';
    $('work').classList.add('busy');
    this.enable(false);
    this.progress('Reading', undefined);
    // Messages from a run that was stopped may still be on their way.
    const run = this.run = { stopping: new AbortController() };
    if (this.isNew) this.inOrder(() => this.showBlocks(run, this.views.original, this.file.bytes));
    const request = { bytes: this.file.bytes, options: this.options.value };
    this.job = new Job('./workers/compressor.mjs', request, (message) => run === this.run && this.onMessage(message, run));
  }

  async onMessage(message, run) {
    const { result } = this;
    try {
      switch (message.name) {
        case 'stage': this.progress(message.text, undefined); break;
        case 'source': await this.onSource(message); break;
        case 'encoded': this.onEncoded(message, run); break;
        case 'compressed': await this.onCompressed(message); break;
        case 'errors': this.onErrors(message); break;
        case 'tree': this.onTree(message); break;
        case 'done': await this.compare(run); break;
        case 'error': this.fail(message.message); break;
      }
      if (run === this.run && result.glb !== undefined) this.showFigures();
    } catch (error) {
      if (run === this.run) this.fail(error.message);
    }
  }

  // A picture takes time to load. Later steps wait for it, and are skipped if another run has
  // begun.
  async inOrder(step) {
    const { run } = this;
    this.picture = (this.picture ?? Promise.resolve()).catch(() => {}).then(() => run === this.run && step());
    await this.picture;
  }

  async onSource({ bytes, isCompressed }) {
    this.source = bytes;
    this.options.showUsed(readGlb(bytes).json);
    Object.assign(this.result, { isCompressed, sourceBytes: bytes.length });
    $('original-size').textContent = `${formatCount(bytes.length)} bytes${isCompressed ? ' decoded' : ''}`;
    if (isCompressed) {
      this.note(`This file is compressed with mesh collapse already: it has ${formatCount(this.file.bytes.length)} bytes and decodes to `
        + `${formatCount(bytes.length)}. The original shown here is what it decodes to, and is compressed anew.`);
    }
    if (!this.isNew) return;
    this.isNew = false;
    await this.inOrder(async () => {
      this.play(false);
      await this.views.showOriginal(bytes);
      $('play').hidden = !this.views.isAnimated;
    });
  }

  /** The result may be large: its blocks are shown while the worker still decodes the whole of it. */
  onEncoded({ glb }, run) {
    this.inOrder(() => {
      this.views.clearCompressed();
      return this.showBlocks(run, this.views.compressed, glb);
    });
  }

  async onCompressed({ glb, report, bytes, payloads }) {
    const figure = hasTargets(readGlb(this.source).json) ? 'allBytes' : 'bytes';
    const ours = { [figure]: sum(report.payloads, 'bytes'), streams: streamsOf(report), errors: [] };
    Object.assign(this.result, { glb, report, payloads, codecs: { ours, draco: { errors: [] }, meshopt: { errors: [] } } });
    $('compressed-size').textContent = `${formatCount(glb.length)} bytes, ${formatPercent(glb.length / this.result.sourceBytes)}`;
    $('download').disabled = false;
    if (report.copied) this.note('Compression would not make this file smaller, so the result is the source.');
    if (this.result.isCompressed && glb.length >= this.file.bytes.length) this.note('The file as it was is not larger than the result.');
    await this.inOrder(() => this.views.showCompressed(bytes));
    $('waiting').textContent = '';
  }

  onErrors(message) {
    this.result.errors = message;
    this.inOrder(() => {
      this.views.setErrors(message);
      $('heat').disabled = false;
      this.showLegend();
    });
  }

  onTree({ primitives }) {
    this.result.tree = primitives;
    this.inOrder(() => {
      this.views.setTree(primitives);
      $('tree').disabled = sum(primitives.map(({ edges }) => edges), 'length') === 0;
      this.showLegend();
    });
  }

  /** Shows the previews of a compressed file, and its blocks one after the other, before all of it is decoded. */
  async showBlocks(run, view, bytes) {
    const shown = view.canvas.dataset;
    delete shown.previews;
    delete shown.blocks;
    const isInBlocks = hasBlocks(bytes);
    if (!isInBlocks && !hasPreviews(bytes)) return;
    const { json } = readGlb(bytes);
    this.pool ??= createDecoderPool();
    const onPreview = (block) => {
      if (block.box === undefined) return;
      this.views.showBlock(view, block, json);
      shown.previews = Number(shown.previews ?? 0) + 1;
    };
    const onBlock = (block) => {
      if (block.blockCount === 1 || block.box === undefined) return;
      this.views.showBlock(view, block, json);
      shown.blocks = `${block.index + 1} of ${block.blockCount}`;
    };
    try {
      const { pool: { decodeBlocks } } = this;
      await loadGlb(bytes, { decodeBlocks, signal: run.stopping.signal, onPreview, onBlock: isInBlocks ? onBlock : undefined });
    } catch {
      this.views.clearBlocks(view); // the compressor says what is wrong; a preview does not matter to it
    }
  }

  async compare(run) {
    $('work').classList.remove('busy');
    run.isComparing = true;
    const { result, source, options: { bits, lossless, value: options } } = this;
    const { signal } = run.stopping;
    try {
      await compareCodecs({ source, payloads: result.payloads, options, bits, lossless }, {
        signal,
        onStep: (text, done) => !signal.aborted && this.progress(text, done),
        onFigures: (codecs) => {
          for (const codec of Object.keys(codecs)) Object.assign(result.codecs[codec], codecs[codec]);
          if (!signal.aborted) this.showFigures();
        },
      });
    } catch (error) {
      if (!signal.aborted) throw error;
      return;
    }
    this.finish(run);
  }

  /** All figures are there, or will not come. */
  finish(run) {
    if (run !== undefined) run.isComparing = false;
    for (const codec of Object.values(this.result.codecs)) codec.isComplete = true;
    this.showFigures();
    this.progress('');
    $('report').disabled = false;
    this.announce();
  }

  announce() {
    const { glb, sourceBytes } = this.result;
    $('status').textContent = `${this.file.name}: ${formatCount(sourceBytes)} bytes became ${formatCount(glb.length)}.`;
  }

  stop() {
    this.job?.stop();
    this.run?.stopping.abort();
    this.run = undefined;
  }

  cancel() {
    const hadResult = this.result?.glb !== undefined;
    this.stop();
    if (hadResult) this.finish();
    this.progress('');
    $('work').classList.remove('busy');
    $('waiting').textContent = hadResult ? '' : 'Cancelled';
    this.say('notice', hadResult ? 'Cancelled; some figures are missing.' : 'Cancelled. Change an option to compress again.');
  }

  fail(text) {
    this.stop();
    this.progress('');
    $('work').classList.remove('busy');
    $('waiting').textContent = '';
    if (this.result?.glb === undefined) {
      this.clearFigures();
      this.views?.clearCompressed();
    }
    this.say('error', `${this.file.name}: ${text}`);
  }

  /** Nothing of another file, or of other options, remains. */
  clearFigures() {
    this.result = {};
    for (const id of ['compressed-size', 'summary', 'codecs', 'streams', 'remarks']) $(id).replaceChildren();
    $('figures').hidden = true;
    if (this.views !== undefined) this.showLegend();
  }

  // ---- what is seen

  /** @param {'error' | 'notice'} kind */
  say(kind, text) {
    $(kind).textContent = text;
    $(kind).hidden = text === '';
    if (kind === 'notice') $('status').textContent = text;
  }

  /** Adds a sentence to the notice. */
  note(text) {
    if (text !== undefined) this.notes.push(text);
    this.say('notice', this.notes.join(' '));
  }

  /** @param {string} text empty: nothing is under way @param {number} [done] from 0 to 1, if that is known */
  progress(text, done) {
    $('progress').hidden = text === '';
    this.showElapsed(text);
    $('progress-text').textContent = text === '' ? '' : `${text}…`;
    if (text !== '') $('status').textContent = `${text}…`;
    if (done === undefined) $('progress-bar').removeAttribute('value');
    else $('progress-bar').value = done;
  }

  /** Shows the seconds since a text was first shown; they are hidden from screen readers. */
  showElapsed(text) {
    if (text === this.stageText) return;
    clearInterval(this.clock);
    this.stageText = text;
    $('progress-time').textContent = '';
    if (text === '') return;
    const begin = performance.now();
    this.clock = setInterval(() => {
      $('progress-time').textContent = `${Math.round((performance.now() - begin) / 1000)} s`;
    }, 1000);
  }

  enable(on) {
    for (const id of ['download', 'report', 'heat', 'tree']) $(id).disabled = !on;
  }

  /**
   * Errors and collapse order are painted on the same surface, so only one of them is shown at a
   * time.
   */
  toggle(mode) {
    const on = !this.views.modes[mode];
    const modes = { [mode]: on };
    if (on && mode === 'heat') modes.tree = false;
    if (on && mode === 'tree') {
      modes.heat = false;
      this.play(false);
    }
    this.setModes(modes);
  }

  setModes(modes) {
    this.views.setModes(modes);
    for (const id of ['wireframe', 'heat', 'tree']) $(id).setAttribute('aria-pressed', String(this.views.modes[id]));
    this.showLegend();
  }

  /** The collapse order is drawn on models at rest. */
  play(on) {
    if (on) this.setModes({ tree: false });
    this.views.play(on);
    $('play').setAttribute('aria-pressed', String(on));
  }

  showLegend() {
    const { modes } = this.views;
    const { errors, tree } = this.result;
    let legend;
    if (modes.heat && errors !== undefined) legend = errorLegend(errors);
    if (modes.tree && tree !== undefined) legend = orderLegend(tree);
    $('legend').hidden = legend === undefined;
    if (legend === undefined) return;
    $('legend-title').textContent = legend.title;
    $('legend-bar').style.background = legend.ramp.gradient;
    $('legend-low').textContent = legend.low;
    $('legend-high').textContent = legend.high;
  }

  get remarks() {
    const { lossless, keepsOrder } = this.options;
    return remarksOn(this.result, { lossless, keepsOrder });
  }

  showFigures() {
    const { codecs } = this.result;
    $('figures').hidden = false;
    showSummary($('summary'), summaryOf(this.result));
    showCodecs($('codecs'), codecs);
    showStreams($('streams'), codecs);
    $('remarks').textContent = this.remarks.join(' ');
  }

  async download() {
    await saveFiles([new File([this.result.glb], this.nameOf('.mcc.glb'), { type: 'model/gltf-binary' })]);
  }

  nameOf(ending) {
    return this.file.name.replace(/(\.glb|\.gltf)?$/i, ending);
  }

  /** Saves the figures for programs, and a picture of them for people. */
  async report() {
    const { file, result, options, remarks } = this;
    const json = reportOf({ file, result, options: options.value, remarks });
    const picture = await drawReport(this.views, { name: file.name, date: json.date, summary: summaryOf(result), codecs: result.codecs, remarks });
    const text = `${JSON.stringify(json, undefined, 2)}\n`;
    await saveFiles([
      new File([text], this.nameOf('.report.json'), { type: 'application/json' }),
      new File([picture], this.nameOf('.report.png'), { type: 'image/png' }),
    ], { mayShare: true });
    this.say('notice', '');
    $('status').textContent = 'The report is saved.';
  }
}

/** Whether a payload of a file is in blocks. */
function hasBlocks(bytes) {
  const { json: { bufferViews = [], ...json }, bin } = readGlb(bytes);
  const views = extensionsOf(json).map((extension) => bufferViews[extension?.bufferView]);
  return views.some((view) => view !== undefined && claimsBlocks(bin.subarray(view.byteOffset ?? 0)));
}

const hasPreviews = (bytes) => extensionsOf(readGlb(bytes).json).some((extension) => extension?.preview !== undefined);

/** The extension objects of all primitives; undefined for those that have none. */
const extensionsOf = ({ meshes = [] }) => meshes.flatMap(({ primitives = [] }) => primitives).map(({ extensions }) => extensions?.[EXTENSION_NAME]);

/** Says what of the files that were opened together is not shown. */
function ignoredNotes({ name, ignored }) {
  if (ignored.length === 0) return [];
  const list = ignored.slice(0, 3).join(', ') + (ignored.length > 3 ? ` and ${ignored.length - 3} more` : '');
  return [`Only ${name} is opened; ${list} ${ignored.length === 1 ? 'is' : 'are'} ignored.`];
}

function checkSize({ meshes = [], accessors = [] }) {
  const counts = meshes.flatMap(({ primitives = [] }) => primitives).map(({ indices }) => accessors[indices]?.count ?? 0);
  const corners = counts.reduce((a, b) => a + b, 0);
  if (corners / 3 <= MAX_TRIANGLES) return;
  throw new FileError(`The file has ${formatCount(corners / 3)} triangles; this page takes ${formatCount(MAX_TRIANGLES)} at most. `
    + 'The command line tool takes more: gltf-mcc convert model.glb small.glb');
}

const errorLegend = ({ most, side }) => ({
  title: 'Distance to the original',
  ramp: ERROR_RAMP,
  low: '0',
  high: most === 0 ? '0: exact' : `${formatSmall(most)} units = ${formatSmall(most / side)} of the box`,
});

const orderLegend = (tree) => ({
  title: 'Order of contraction',
  ramp: ORDER_RAMP,
  low: 'first',
  high: `last of ${formatCount(sum(tree.map(({ edges }) => edges), 'length') / 2)}`,
});

new Page();
