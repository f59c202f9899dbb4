// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The colours of a scale from 0 to 1. The legends show the same stops.
import { Color, SRGBColorSpace } from './vendor/three/build/three.module.js';

const SHADES = 1024;

class Ramp {
  constructor(stops) {
    this.stops = stops;
    const colors = stops.map((stop) => new Color().setStyle(stop, SRGBColorSpace));
    const color = new Color();
    this.shades = new Float32Array(3 * SHADES);
    for (let i = 0; i < SHADES; ++i) {
      const place = i / (SHADES - 1) * (colors.length - 1);
      const below = Math.min(Math.floor(place), colors.length - 2);
      color.lerpColors(colors[below], colors[below + 1], place - below).toArray(this.shades, 3 * i);
    }
  }

  /**
   * Returns the colours of `count` values of `valueAt`, which are from 0 to 1; three components
   * each.
   */
  colorsOf(count, valueAt) {
    const colors = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) {
      const shade = 3 * Math.round(Math.min(Math.max(valueAt(i), 0), 1) * (SHADES - 1));
      for (let c = 0; c < 3; ++c) colors[3 * i + c] = this.shades[shade + c];
    }
    return colors;
  }

  get gradient() {
    return `linear-gradient(to right in srgb-linear, ${this.stops.join(', ')})`;
  }
}

// Lightness grows evenly, and the colours can be told apart with any kind of colour vision.
export const ERROR_RAMP = new Ramp(['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725']);
// Bright on a dark surface.
export const ORDER_RAMP = new Ramp(['#3f6fff', '#1fb6ff', '#2ee6c5', '#a8e84a', '#ffd23f', '#ff8a4c', '#ff5d8f']);
