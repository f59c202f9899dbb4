// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows two pictures of a model with the same camera: the original, and what compression made of
// it.
import { AnimationMixer, BackSide, Box3, BoxGeometry, BufferAttribute, BufferGeometry, Color, DirectionalLight, Group, HemisphereLight,
  LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, MeshStandardMaterial, PerspectiveCamera, PMREMGenerator, Quaternion, Scene, Sphere,
  Spherical, SphereGeometry, Vector3, WebGLRenderer } from './vendor/three/build/three.module.js';
import { OrbitControls } from './vendor/three/examples/jsm/controls/OrbitControls.js';
import { GLTFLoader } from './vendor/three/examples/jsm/loaders/GLTFLoader.js';
import { ERROR_RAMP, ORDER_RAMP } from './ramps.mjs';

const STEP_RADIANS = Math.PI / 24;
const ZOOM = 1.15;
// Draws a surface a little farther away than it is, so that it does not hide the lines on it.
const BEHIND = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };

const nameOf = ({ mesh, primitive }) => `${mesh}/${primitive}`;

function dispose({ geometry, material }) {
  geometry.dispose();
  material.dispose();
}

/** A picture and its contents. */
class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.scene.environmentIntensity = 0.5;
    this.sun = new DirectionalLight(0xffffff, 2);
    this.scene.add(this.sun, this.sun.target, new HemisphereLight(0xffffff, 0x8a93a3, 1));
    this.meshes = [];
    this.lines = [];
    this.animations = [];
  }

  /** @param {Uint8Array} glb */
  async load(glb) {
    const { scene, parser, animations } = await new GLTFLoader().parseAsync(glb.slice().buffer, '');
    this.clear();
    this.model = scene;
    this.animations = animations;
    this.scene.add(scene);
    scene.updateMatrixWorld(true);
    scene.traverse((object) => {
      if (object.isMesh) this.meshes.push(new Surface(object, parser.associations.get(object)));
    });
    // Metal shows only its surroundings.
    if (this.meshes.some(({ own }) => own.metalness > 0.1)) this.scene.environment ??= surroundings(this.renderer);
  }

  /** Adds a block of a model that is not there yet, or a preview. @param {Matrix4[]} places where it is drawn */
  addBlock({ attributes, parts, box, isPreview }, use, places) {
    const { part, attributes: numbers } = use;
    this.blocks ??= new Group();
    const geometry = new BufferGeometry();
    for (const [name, number] of [['position', numbers.POSITION], ['normal', numbers.NORMAL]]) {
      if (number === undefined) continue;
      const { array, componentCount, normalized } = attributes[number];
      geometry.setAttribute(name, new BufferAttribute(array, componentCount, normalized));
    }
    geometry.setIndex(new BufferAttribute(parts[part].indices, 1));
    if (!attributes[0].normalized) {
      geometry.boundingSphere = new Box3(new Vector3(...box.min), new Vector3(...box.max)).getBoundingSphere(new Sphere());
    }
    const material = paper(geometry);
    for (const place of places) {
      const mesh = new Mesh(geometry, material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.copy(place);
      mesh.userData.previewOf = isPreview ? nameOf(use) : undefined;
      this.blocks.add(mesh);
    }
    this.scene.add(this.blocks);
  }

  /** Removes the previews of a primitive, all of whose blocks are there. */
  clearPreviews(use) {
    const meshes = this.blocks?.children.filter(({ userData }) => userData.previewOf === nameOf(use)) ?? [];
    meshes.forEach(dispose);
    this.blocks?.remove(...meshes);
  }

  clearBlocks() {
    this.blocks?.children.forEach(dispose);
    this.blocks?.removeFromParent();
    this.blocks = undefined;
  }

  clear() {
    this.clearBlocks();
    this.setTree(undefined);
    for (const surface of this.meshes) surface.dispose();
    this.meshes = [];
    if (this.model !== undefined) this.scene.remove(this.model);
    this.model = undefined;
    this.animations = [];
    this.mixer = undefined;
  }

  /** @param {number | undefined} seconds since all animations began; undefined: the model is at rest */
  pose(seconds) {
    if (seconds === undefined) {
      this.mixer?.stopAllAction();
      this.mixer = undefined;
    } else if (this.animations.length !== 0) {
      if (this.mixer === undefined) {
        this.mixer = new AnimationMixer(this.model);
        for (const clip of this.animations) this.mixer.clipAction(clip).play();
      }
      this.mixer.setTime(seconds);
    }
  }

  /** @param {{ mesh: number, primitive: number, edges: Uint32Array }[] | undefined} primitives edges: pairs of vertices in their order */
  setTree(primitives) {
    for (const line of this.lines) {
      line.removeFromParent();
      line.geometry.dispose();
      line.material.dispose();
    }
    this.lines = [];
    for (const { mesh, primitive, edges } of primitives ?? []) {
      const surfaces = this.meshes.filter((surface) => surface.isOf(mesh, primitive));
      for (const surface of surfaces) this.lines.push(surface.drawEdges(edges));
    }
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    this.renderer.setSize(clientWidth, clientHeight, false);
    return clientWidth / Math.max(clientHeight, 1);
  }

  render(camera, target) {
    this.sun.position.copy(camera.position).addScaledVector(camera.up, 0.4 * camera.position.distanceTo(target));
    this.sun.target.position.copy(target);
    this.renderer.render(this.scene, camera);
  }
}

/** A mesh of the model, and how it is painted. */
class Surface {
  constructor(object, place) {
    this.object = object;
    this.place = place;
    this.colors = object.geometry.getAttribute('color');
    this.own = isPlain(object.material) ? paper(object.geometry) : object.material;
    Object.assign(this.own, BEHIND);
    this.wire = new MeshBasicMaterial({ color: 0x0b1220, wireframe: true, transparent: true, opacity: 0.45, depthWrite: false });
    this.dark = new MeshLambertMaterial({ color: 0x262b36, ...BEHIND, side: this.own.side });
    this.heat = new MeshLambertMaterial({ vertexColors: true, ...BEHIND, side: this.own.side, flatShading: this.own.flatShading });
  }

  isOf(mesh, primitive) {
    return this.place?.meshes === mesh && (this.place.primitives ?? 0) === primitive;
  }

  paint({ wireframe, heat, tree }) {
    const { object, colors } = this;
    const { geometry } = object;
    const base = heat ? this.heat : tree ? this.dark : this.own;
    // The model's own vertex colours are replaced.
    const wanted = heat ? this.heatColors : colors;
    if (wanted !== undefined) geometry.setAttribute('color', wanted);
    else geometry.deleteAttribute('color');
    geometry.clearGroups();
    object.material = base;
    if (!wireframe) return;
    geometry.addGroup(0, Infinity, 0);
    geometry.addGroup(0, Infinity, 1);
    object.material = [base, this.wire];
  }

  /** @param {Float32Array} errors by vertex */
  setErrors(errors, most) {
    const scale = most === 0 ? 0 : 1 / most;
    this.heatColors = new BufferAttribute(ERROR_RAMP.colorsOf(errors.length, (i) => scale * errors[i]), 3);
  }

  drawEdges(edges) {
    const points = new Float32Array(3 * edges.length);
    const point = new Vector3();
    for (let i = 0; i < edges.length; ++i) this.object.getVertexPosition(edges[i], point).toArray(points, 3 * i);
    const last = Math.max(edges.length / 2 - 1, 1);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(points, 3));
    // Contractions happen in the reverse of decoding order.
    geometry.setAttribute('color', new BufferAttribute(ORDER_RAMP.colorsOf(edges.length, (i) => 1 - (i >> 1) / last), 3));
    const lines = new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, toneMapped: false }));
    lines.frustumCulled = false;
    this.object.add(lines);
    return lines;
  }

  dispose() {
    const { object } = this;
    object.geometry.dispose();
    for (const material of [this.own, this.wire, this.dark, this.heat]) {
      for (const value of Object.values(material)) if (value?.isTexture) value.dispose();
      material.dispose();
    }
    object.skeleton?.dispose();
  }
}

// By glTF's defaults, primitives without a material are mirrors, and GLTFLoader shows them so.
const isPlain = (material) => material.name === '' && material.metalness === 1 && material.roughness === 1 && material.map === null;

const paper = (geometry) => new MeshStandardMaterial({ color: 0xa9b3c4, roughness: 0.8, metalness: 0,
  flatShading: geometry.getAttribute('normal') === undefined, vertexColors: geometry.getAttribute('color') !== undefined });

/** A room of soft light. */
function surroundings(renderer) {
  const room = new Scene();
  room.add(new Mesh(new SphereGeometry(10, 16, 8), new MeshBasicMaterial({ color: 0x9aa3b2, side: BackSide })));
  for (const [x, y, z, width, light] of [[0, 8, 0, 7, 9], [7, 2, 4, 4, 4], [-7, 1, 4, 4, 2.5], [0, -8, 0, 9, 0.4]]) {
    const lamp = new Mesh(new BoxGeometry(width, 0.5, width), new MeshBasicMaterial({ color: new Color(light, light, light) }));
    lamp.position.set(x, y, z);
    lamp.lookAt(0, 0, 0);
    lamp.rotateX(Math.PI / 2);
    room.add(lamp);
  }
  const generator = new PMREMGenerator(renderer);
  const { texture } = generator.fromScene(room, 0.04);
  generator.dispose();
  return texture;
}

/** Returns where the scene of a document has each of its meshes: matrices by the mesh's number. */
function placesOf({ nodes = [], scenes = [], scene = 0 }) {
  const places = new Map();
  const seen = new Set(); // a damaged document may have cycles
  const waiting = (scenes[scene]?.nodes ?? [...nodes.keys()]).map((number) => ({ number, above: new Matrix4() }));
  while (waiting.length > 0) {
    const { number, above } = waiting.pop();
    const node = nodes[number];
    if (node === undefined || seen.has(number)) continue;
    seen.add(number);
    const own = new Matrix4();
    if (node.matrix !== undefined) own.fromArray(node.matrix);
    else own.compose(new Vector3(...node.translation ?? [0, 0, 0]), new Quaternion(...node.rotation ?? [0, 0, 0, 1]), new Vector3(...node.scale ?? [1, 1, 1]));
    own.premultiply(above);
    if (node.mesh !== undefined) places.set(node.mesh, [...places.get(node.mesh) ?? [], own]);
    for (const child of node.children ?? []) waiting.push({ number: child, above: own });
  }
  return places;
}

/** Returns the box of a document's scene, of which nothing has been decoded yet. */
function boxOfDocument({ meshes = [], accessors = [] }, places) {
  const box = new Box3();
  for (const [mesh, matrices] of places) {
    for (const { attributes } of meshes[mesh]?.primitives ?? []) {
      const { min, max } = accessors[attributes?.POSITION] ?? {};
      if (min === undefined || max === undefined) continue;
      for (const matrix of matrices) box.union(new Box3(new Vector3(...min), new Vector3(...max)).applyMatrix4(matrix));
    }
  }
  return box;
}

export class LinkedViews {
  /** @param {{ original: HTMLCanvasElement, compressed: HTMLCanvasElement }} canvases */
  constructor({ original, compressed }) {
    this.original = new View(original);
    this.compressed = new View(compressed);
    this.views = [this.original, this.compressed];
    this.camera = new PerspectiveCamera(35, 1, 0.01, 100);
    this.target = new Vector3();
    this.modes = { wireframe: false, heat: false, tree: false };
    this.controls = this.views.map(({ canvas }) => this.listen(canvas));
    const observer = new ResizeObserver(() => this.resize());
    for (const { canvas } of this.views) observer.observe(canvas);
  }

  // Both controls turn the same camera around the same point.
  listen(canvas) {
    const controls = new OrbitControls(this.camera, canvas);
    controls.target = this.target;
    canvas.style.touchAction = 'pan-y'; // so that a phone can also scroll the page on its pictures
    controls.addEventListener('change', () => this.draw());
    canvas.addEventListener('keydown', (event) => this.onKey(event));
    return controls;
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const moves = {
      ArrowLeft: () => this.turn(-STEP_RADIANS, 0), ArrowRight: () => this.turn(STEP_RADIANS, 0),
      ArrowUp: () => this.turn(0, -STEP_RADIANS), ArrowDown: () => this.turn(0, STEP_RADIANS),
      '+': () => this.zoom(1 / ZOOM), '=': () => this.zoom(1 / ZOOM), '-': () => this.zoom(ZOOM),
      Home: () => this.frame(),
    };
    if (moves[event.key] === undefined) return;
    event.preventDefault();
    moves[event.key]();
    this.draw();
  }

  turn(right, down) {
    const offset = this.camera.position.clone().sub(this.target);
    const spherical = new Spherical().setFromVector3(offset);
    spherical.theta -= right;
    spherical.phi += down;
    this.camera.position.setFromSpherical(spherical.makeSafe()).add(this.target);
    this.camera.lookAt(this.target);
  }

  zoom(factor) {
    this.camera.position.sub(this.target).multiplyScalar(factor).add(this.target);
  }

  /** Shows a model. The first model positions the camera. */
  async showOriginal(glb) {
    await this.original.load(glb);
    this.compressed.clear();
    this.frame();
    this.paint();
  }

  /**
   * Shows a block of a model, or a preview, which goes with the last block. The first one positions the camera, unless the original is there already.
   * @param {View} view @param {object} json of the model
   */
  showBlock(view, block, json) {
    const isFirst = view.blocks === undefined;
    if (isFirst) this.places = placesOf(json);
    const { places } = this;
    for (const use of block.uses) {
      if (block.parts[use.part].triangleCount !== 0) view.addBlock(block, use, places.get(use.mesh) ?? []);
    }
    if (!block.isPreview && block.index === block.blockCount - 1) for (const use of block.uses) view.clearPreviews(use);
    if (isFirst && this.original.model === undefined) this.frame(boxOfDocument(json, places));
    this.draw();
  }

  clearBlocks(view) {
    view.clearBlocks();
    this.draw();
  }

  clearCompressed() {
    this.tree = undefined;
    this.compressed.clear();
    this.draw();
  }

  async showCompressed(glb) {
    this.tree = undefined; // it belongs to another payload
    await this.compressed.load(glb);
    this.paint();
  }

  clear() {
    for (const view of this.views) view.clear();
    this.draw();
  }

  /** @param {{ primitives: { mesh: number, primitive: number, errors: Float32Array }[], most: number }} measured */
  setErrors({ primitives, most }) {
    for (const { mesh, primitive, errors } of primitives) {
      for (const surface of this.compressed.meshes) if (surface.isOf(mesh, primitive)) surface.setErrors(errors, most);
    }
    this.paint();
  }

  setTree(primitives) {
    this.tree = primitives;
    this.paint();
  }

  /** @param {{ wireframe?: boolean, heat?: boolean, tree?: boolean }} modes */
  setModes(modes) {
    Object.assign(this.modes, modes);
    this.paint();
  }

  get isAnimated() {
    return this.original.animations.length !== 0;
  }

  get isPlaying() {
    return this.begin !== undefined;
  }

  /** Both models move at the same time, or return to rest. */
  play(on) {
    this.begin = on ? performance.now() : undefined;
    if (!on) for (const view of this.views) view.pose(undefined);
    this.draw();
  }

  paint() {
    const { wireframe, heat, tree } = this.modes;
    for (const surface of this.original.meshes) surface.paint({ wireframe });
    for (const surface of this.compressed.meshes) {
      const isHeat = heat && surface.heatColors !== undefined;
      const isTree = tree && this.tree !== undefined;
      surface.paint({ wireframe: wireframe && !isTree, heat: isHeat, tree: isTree });
    }
    const drawn = this.compressed.lines.length !== 0;
    if (drawn && !(tree && this.tree === this.drawnTree)) this.compressed.setTree(undefined);
    if (tree && this.compressed.lines.length === 0) this.compressed.setTree(this.tree);
    this.drawnTree = this.tree;
    this.draw();
  }

  /** Shows the whole model, from its front and slightly from above. */
  frame(box = new Box3().setFromObject(this.original.model ?? this.original.blocks ?? new Group())) {
    const { center, radius } = box.getBoundingSphere(new Sphere());
    const size = radius > 0 ? radius : 1;
    this.target.copy(radius > 0 ? center : new Vector3());
    const half = Math.atan(Math.tan(this.camera.fov * Math.PI / 360) * Math.min(this.camera.aspect, 1));
    this.camera.position.set(0.5, 0.45, 1).setLength(0.9 * size / Math.sin(half)).add(this.target);
    this.camera.near = size / 200;
    this.camera.far = size * 100;
    this.camera.updateProjectionMatrix();
    this.camera.lookAt(this.target);
    this.draw();
  }

  resize() {
    for (const view of this.views) this.camera.aspect = view.resize();
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /**
   * Draws each picture in another size and calls `use(canvas, number)` before anything else is drawn, because a canvas forgets its
   * picture. The page's own pictures are back before they are seen.
   */
  drawEach(width, height, use) {
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.views.forEach((view, i) => {
      view.renderer.setSize(width, height, false);
      view.render(this.camera, this.target);
      use(view.canvas, i);
    });
    for (const view of this.views) this.camera.aspect = view.resize();
    this.camera.updateProjectionMatrix();
    for (const view of this.views) view.render(this.camera, this.target);
  }

  /** Draws in the next frame, and in all after it while the models move. */
  draw() {
    this.request ??= requestAnimationFrame((now) => {
      this.request = undefined;
      for (const view of this.views) {
        if (this.isPlaying) view.pose(Math.max(now - this.begin, 0) / 1000);
        view.render(this.camera, this.target);
      }
      if (this.isPlaying) this.draw();
    });
  }
}
