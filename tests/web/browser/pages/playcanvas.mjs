// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { Application, Color, Entity, Vec3 } from 'playcanvas';
import { DISTANCE, FIELD_OF_VIEW_DEGREES, JOINT_ANGLE, MORPH_WEIGHT, TOWARDS_CAMERA, newCanvas, runSnippet } from './stage.mjs';

const canvas = newCanvas();
const app = new Application(canvas, { graphicsDeviceOptions: { preserveDrawingBuffer: true } });
app.scene.ambientLight = new Color(0.4, 0.4, 0.4);
app.start();

const camera = new Entity('camera');
camera.addComponent('camera', { clearColor: new Color(1, 1, 1), fov: FIELD_OF_VIEW_DEGREES });
const light = new Entity('light');
light.addComponent('light', { type: 'directional' });
light.setEulerAngles(45, 30, 0);
app.root.addChild(camera);
app.root.addChild(light);

globalThis.draw = async (model) => {
  const others = new Set(app.root.children);
  await runSnippet('PlayCanvas', model, { app });
  const entities = app.root.children.filter((child) => !others.has(child));
  const instances = entities.flatMap((entity) => entity.findComponents('render')).flatMap((render) => render.meshInstances);
  pose(instances);
  placeCamera(instances);
  await new Promise((resolve) => app.once('frameend', () => app.once('frameend', resolve)));
  const picture = canvas.toDataURL();
  for (const entity of entities) entity.destroy();
  for (const asset of app.assets.list()) forget(asset);
  return picture;
};

// The engine keeps what it has loaded by its URL, which is that of the next model, too.
function forget(asset) {
  asset.unload();
  app.assets.remove(asset);
}

function pose(instances) {
  const joints = new Set();
  for (const { morphInstance: morphs, skinInstance: skin } of instances) {
    for (let i = 0; i < (morphs?.morph.targets.length ?? 0); ++i) morphs.setWeight(i, MORPH_WEIGHT);
    for (const bone of skin?.bones ?? []) joints.add(bone);
  }
  for (const joint of joints) joint.rotateLocal(0, 0, JOINT_ANGLE * 180 / Math.PI);
}

function placeCamera(instances) {
  const box = instances[0].aabb.clone();
  for (const { aabb } of instances) box.add(aabb);
  const radius = box.halfExtents.length();
  const direction = new Vec3(...TOWARDS_CAMERA).normalize();
  camera.setPosition(new Vec3().add2(box.center, direction.mulScalar(DISTANCE * radius)));
  camera.lookAt(box.center);
  camera.camera.nearClip = radius / 10;
  camera.camera.farClip = radius * 10;
}
