// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import * as THREE from 'three';
import { DISTANCE, FIELD_OF_VIEW_DEGREES, HEIGHT, JOINT_ANGLE, MORPH_WEIGHT, TOWARDS_CAMERA, WIDTH, newCanvas, runSnippet }
  from './stage.mjs';

const renderer = new THREE.WebGLRenderer({ canvas: newCanvas(), antialias: true });
renderer.setSize(WIDTH, HEIGHT, false);

let shown;

globalThis.draw = async (model, snippet = 'three.js') => {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xffffff);
  const light = new THREE.DirectionalLight(0xffffff, 2);
  light.position.set(1, 2, 3);
  scene.add(light, new THREE.HemisphereLight(0xffffff, 0x444444, 1.5));
  await runSnippet(snippet, model, { scene });
  scene.traverse(pose);
  renderer.render(scene, cameraFor(scene));
  shown = scene;
  return renderer.domElement.toDataURL();
};

/** The types of the arrays that the graphics card has got, by attribute, and their bytes. */
globalThis.uploads = () => {
  const arrays = new Map();
  shown.traverse(({ geometry }) => {
    for (const [name, attribute] of Object.entries(geometry?.attributes ?? {})) arrays.set((attribute.data ?? attribute).array, name);
  });
  const types = Object.fromEntries([...arrays].map(([array, name]) => [name, array.constructor.name]));
  return { types, bytes: [...arrays.keys()].reduce((sum, { byteLength }) => sum + byteLength, 0) };
};

function pose(object) {
  object.morphTargetInfluences?.fill(MORPH_WEIGHT);
  if (object.isBone) object.rotateZ(JOINT_ANGLE);
}

function cameraFor(scene) {
  const sphere = new THREE.Box3().setFromObject(scene).getBoundingSphere(new THREE.Sphere());
  const camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW_DEGREES, WIDTH / HEIGHT, sphere.radius / 10, sphere.radius * 10);
  const direction = new THREE.Vector3(...TOWARDS_CAMERA).normalize();
  camera.position.copy(sphere.center).addScaledVector(direction, DISTANCE * sphere.radius);
  camera.lookAt(sphere.center);
  return camera;
}
