// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { ArcRotateCamera } from '@babylonjs/core/Cameras/arcRotateCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { DirectionalLight } from '@babylonjs/core/Lights/directionalLight.js';
import { HemisphericLight } from '@babylonjs/core/Lights/hemisphericLight.js';
import { SceneLoaderFlags } from '@babylonjs/core/Loading/sceneLoaderFlags.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import { DISTANCE, FIELD_OF_VIEW_DEGREES, JOINT_ANGLE, MORPH_WEIGHT, TOWARDS_CAMERA, newCanvas, runSnippet } from './stage.mjs';

SceneLoaderFlags.ShowLoadingScreen = false;
const canvas = newCanvas();
const engine = new Engine(canvas, true, { preserveDrawingBuffer: true });

let types;

globalThis.draw = async (model, snippet = 'Babylon.js') => {
  const scene = new Scene(engine);
  scene.clearColor = new Color4(1, 1, 1, 1);
  scene.useRightHandedSystem = true;
  new HemisphericLight('sky', new Vector3(0, 1, 0), scene).intensity = 0.8;
  new DirectionalLight('sun', new Vector3(-1, -2, -3), scene).intensity = 1.5;
  try {
    await runSnippet(snippet, model, { scene });
    types = Object.fromEntries(scene.meshes.flatMap((mesh) => mesh.getVerticesDataKinds().map((kind) => [kind, mesh.getVertexBuffer(kind).type])));
    pose(scene);
    placeCamera(scene);
    await scene.whenReadyAsync();
    scene.render();
    return canvas.toDataURL();
  } finally {
    scene.dispose();
  }
};

/** The component types of the attributes that the graphics card has got. */
globalThis.uploads = () => ({ types });

function pose(scene) {
  for (const group of scene.animationGroups) group.stop();
  for (const { morphTargetManager: morphs } of scene.meshes) {
    for (let i = 0; i < (morphs?.numTargets ?? 0); ++i) morphs.getTarget(i).influence = MORPH_WEIGHT;
  }
  for (const bone of scene.skeletons.flatMap((skeleton) => skeleton.bones)) {
    bone.getTransformNode().rotate(new Vector3(0, 0, 1), JOINT_ANGLE);
  }
}

function placeCamera(scene) {
  const { min, max } = scene.getWorldExtends();
  const radius = max.subtract(min).length() / 2;
  const camera = new ArcRotateCamera('camera', 0, 0, 1, max.add(min).scale(0.5), scene);
  camera.setPosition(camera.target.add(new Vector3(...TOWARDS_CAMERA).normalize().scale(DISTANCE * radius)));
  camera.fov = FIELD_OF_VIEW_DEGREES * Math.PI / 180;
  camera.minZ = radius / 10;
  camera.maxZ = radius * 10;
}
