// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { Application, Asset, Color, Entity, Vec3 } from '/engines/playcanvas/build/playcanvas.mjs';

const canvas = document.querySelector('canvas');
const app = new Application(canvas, { graphicsDeviceOptions: { preserveDrawingBuffer: true } });
app.scene.ambientLight = new Color(0.5, 0.5, 0.5);
app.start();
const camera = new Entity('camera');
camera.addComponent('camera', { clearColor: new Color(1, 1, 1) });
app.root.addChild(camera);

globalThis.draw = async (url) => {
  const asset = new Asset('model', 'container', { url });
  await new Promise((resolve, reject) => {
    asset.once('load', resolve);
    asset.once('error', (message) => reject(new Error(message)));
    app.assets.add(asset);
    app.assets.load(asset);
  });
  const entity = asset.resource.instantiateRenderEntity();
  app.root.addChild(entity);
  const { center, halfExtents } = entity.findComponents('render')[0].meshInstances[0].aabb;
  camera.setPosition(new Vec3(0.5, 0.6, 1).normalize().mulScalar(2.5 * halfExtents.length()).add(center));
  camera.lookAt(center);
  await new Promise((resolve) => app.once('frameend', () => app.once('frameend', resolve)));
  const picture = canvas.toDataURL();
  entity.destroy();
  asset.unload();
  app.assets.remove(asset);
  return picture;
};
