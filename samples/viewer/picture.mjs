// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The report as a picture: both views side by side, the figures below. Its size is always the same, whatever the window's is.
import { CODECS } from './comparison.mjs';
import { rowsOf, titleOf } from './figures.mjs';

export const WIDTH = 1200, HEIGHT = 960;
const MARGIN = 24;
const VIEW = { top: 92, width: (WIDTH - 3 * MARGIN) / 2, height: 440 };
const TEXT_TOP = VIEW.top + VIEW.height + 40;
const ROW = 30, SMALL_ROW = 19;

/**
 * @param {import('./views.mjs').LinkedViews} views
 * @param {{ name: string, date: string, summary: string[][], codecs: object, remarks: string[] }} contents
 * @returns {Promise<Blob>} a PNG
 */
export function drawReport(views, { name, date, summary, codecs, remarks }) {
  const canvas = document.createElement('canvas');
  Object.assign(canvas, { width: WIDTH, height: HEIGHT });
  const pen = makePen(canvas.getContext('2d'));
  pen.box('--ground', 0, 0, WIDTH, HEIGHT);
  pen.write(shortened(name), MARGIN, 40, { size: 22, weight: 650 });
  pen.write(`Mesh collapse viewer, ${date.slice(0, 10)}`, WIDTH - MARGIN, 40, { color: '--quiet', align: 'right' });
  drawViews(pen, views);
  let y = TEXT_TOP;
  drawSummary(pen, summary, y);
  y += 96;
  y = drawTable(pen, codecs, y);
  pen.wrap(remarks.join(' '), MARGIN, y + 10, WIDTH - 2 * MARGIN);
  return new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
}

const shortened = (name) => (name.length <= 60 ? name : `${name.slice(0, 40)}…${name.slice(-18)}`);

/** Writes with the page's colours and font, hence light or dark as the page is. */
function makePen(context) {
  const style = getComputedStyle(document.documentElement);
  const colorOf = (name) => style.getPropertyValue(name).trim();
  const set = ({ size = 15, weight = 400, color = '--text', align = 'left' } = {}) => {
    context.font = `${weight} ${size}px ${style.fontFamily}`;
    context.fillStyle = colorOf(color);
    context.textAlign = align;
  };
  return {
    context,
    box(color, ...box) {
      context.fillStyle = colorOf(color);
      context.fillRect(...box);
    },
    write(text, x, y, look) {
      set(look);
      context.fillText(text, x, y);
      return context.measureText(text).width;
    },
    /** What does not fit is in the JSON. */
    wrap(text, x, y, width) {
      set({ size: 13, color: '--quiet' });
      linesOf(context, text, width).slice(0, Math.floor((HEIGHT - y) / SMALL_ROW)).forEach((line, i) => context.fillText(line, x, y + i * SMALL_ROW));
    },
  };
}

function linesOf(context, text, width) {
  const lines = [''];
  for (const word of text.split(' ')) {
    const longer = `${lines.at(-1)} ${word}`.trimStart();
    if (context.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

function drawViews(pen, views) {
  const titles = ['Original', 'Compressed'];
  views.drawEach(VIEW.width, VIEW.height, (canvas, i) => {
    const x = MARGIN + i * (VIEW.width + MARGIN);
    pen.write(titles[i], x, VIEW.top - 12, { weight: 650 });
    pen.box('--stage', x, VIEW.top, VIEW.width, VIEW.height);
    pen.context.drawImage(canvas, x, VIEW.top, VIEW.width, VIEW.height);
  });
}

function drawSummary(pen, summary, y) {
  const width = (WIDTH - 2 * MARGIN) / summary.length;
  summary.forEach(([name, figure, more = ''], i) => {
    const x = MARGIN + i * width;
    pen.write(name, x, y, { size: 13, color: '--quiet' });
    pen.write(figure, x, y + 24, { size: 17, weight: 600 });
    linesOf(pen.context, more, 1.2 * width - 40).slice(0, 2).forEach((line, l) => {
      pen.write(line, x, y + 42 + l * 16, { size: 12, color: '--quiet' });
    });
  });
}

/** Returns where it ends. */
function drawTable(pen, codecs, top) {
  const column = (i) => MARGIN + 220 + i * 310;
  let y = top;
  pen.write(titleOf(codecs), MARGIN, y, { color: '--quiet' });
  Object.entries(CODECS).forEach(([codec, name], i) => {
    pen.box(`--${codec}`, column(i), y - 10, 11, 11);
    pen.write(name, column(i) + 18, y, { color: '--quiet' });
  });
  for (const { name, cells } of rowsOf(codecs)) {
    y += ROW;
    pen.box('--line', MARGIN, y - 20, WIDTH - 2 * MARGIN, 1);
    pen.write(name, MARGIN, y);
    cells.forEach(({ text, ratio, isLeast }, i) => {
      pen.write(text, column(i) + 100, y, { align: 'right', weight: isLeast ? 700 : 400 });
      pen.write(ratio, column(i) + 116, y, { color: '--quiet' });
    });
  }
  return y + ROW;
}
