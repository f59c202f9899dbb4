// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The form with the options of encodeGlb().
import { element } from './element.mjs';
import { trianglePrimitivesOf } from './glb.mjs';

const BITS = [
  { name: 'positionBits', semantic: 'POSITION', title: 'Positions', least: 4, most: 24, value: 14 },
  { name: 'normalBits', semantic: 'NORMAL', title: 'Normals', least: 4, most: 16, value: 10 },
  { name: 'texcoordBits', semantic: 'TEXCOORD', title: 'Texture coordinates', least: 4, most: 24, value: 12 },
  { name: 'colorBits', semantic: 'COLOR', title: 'Colours', least: 2, most: 16, value: 8 },
  { name: 'tangentBits', semantic: 'TANGENT', title: 'Tangents', least: 4, most: 16, value: 12 },
  { name: 'weightBits', semantic: 'WEIGHTS', title: 'Weights', least: 4, most: 16, value: 12 },
];

const FLOAT = 5126;

export class Options {
  /** @param {HTMLFormElement} form @param {() => void} onChange when the user has made up their mind */
  constructor(form, onChange) {
    this.form = form;
    this.bitsField = form.querySelector('#bits');
    for (const { name, title, least, most, value } of BITS) {
      const output = element('output', { class: 'number', htmlFor: name }, String(value));
      const input = element('input', { type: 'range', id: name, name, min: least, max: most, step: 1 });
      input.value = value;
      input.oninput = () => { output.value = input.value; };
      this.bitsField.append(element('label', { class: 'slider', htmlFor: name }, element('span', {}, title), output, input));
    }
    form.onsubmit = (event) => event.preventDefault();
    form.onchange = () => {
      this.bitsField.disabled = this.lossless;
      onChange();
    };
  }

  /** Shows the bits of attributes that the document has as floats; integers are never quantised. */
  showUsed(json) {
    const used = new Set(trianglePrimitivesOf(json).flatMap(({ definition: { attributes } }) => Object.entries(attributes))
      .filter(([, index]) => json.accessors[index].componentType === FLOAT)
      .map(([name]) => name.replace(/_\d+$/, '')));
    for (const { name, semantic } of BITS) this.form.elements[name].parentElement.hidden = !used.has(semantic);
    this.bitsField.hidden = used.size === 0;
  }

  get lossless() {
    return this.form.elements.lossless.checked;
  }

  get bits() {
    return Object.fromEntries(BITS.map(({ name }) => [name, Number(this.form.elements[name].value)]));
  }

  get keepsOrder() {
    const { keepVertexOrder, keepTriangleOrder } = this.form.elements;
    return keepVertexOrder.checked || keepTriangleOrder.checked;
  }

  /** The options for encodeGlb(). */
  get value() {
    const { keepVertexOrder, keepTriangleOrder } = this.form.elements;
    const orders = { keepVertexOrder: keepVertexOrder.checked, keepTriangleOrder: keepTriangleOrder.checked };
    return { ...this.lossless ? {} : this.bits, lossless: this.lossless, ...orders };
  }
}
