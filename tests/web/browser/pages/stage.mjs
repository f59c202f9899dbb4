// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the pages of all engines share.

export const WIDTH = 320;
export const HEIGHT = 240;
/** From the middle of the model to the camera. */
export const TOWARDS_CAMERA = [0.5, 0.6, 1];
/** The distance of the camera, in radii of the model's sphere. */
export const DISTANCE = 2;
export const FIELD_OF_VIEW_DEGREES = 45;
/** Weights of morph targets, and turns of joints: the rest pose would hide wrong targets and weights. */
export const MORPH_WEIGHT = 0.6;
export const JOINT_ANGLE = 0.25;

/** A canvas in the page, in place of that of the model before. */
export function newCanvas() {
  const canvas = document.createElement('canvas');
  canvas.width = WIDTH;
  canvas.height = HEIGHT;
  document.body.replaceChildren(canvas);
  return canvas;
}

let runs = 0;

/**
 * Runs a snippet of the README. It finds its model as "model.glb", beside the page, and the variables of an application, like
 * `scene`, as globals.
 */
export async function runSnippet(name, model, globals) {
  history.replaceState(null, '', `/models/${model}/`);
  Object.assign(globalThis, globals);
  return import(`/snippets/${name}.mjs?run=${++runs}`);
}
