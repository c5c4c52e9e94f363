// The interactive view of one model: layers of triangles, edges, a section. Bundled with three.js
// into viewer.js by scripts/viewer; loader.js gives it unpacked models.

import {
  AlwaysStencilFunc, AmbientLight, BackSide, BufferAttribute, BufferGeometry, Color,
  DecrementWrapStencilOp, DirectionalLight, DoubleSide, FrontSide, Group, IncrementWrapStencilOp,
  LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial,
  NotEqualStencilFunc, PerspectiveCamera, Plane, PlaneGeometry, ReplaceStencilOp, Scene, Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const FIELD_OF_VIEW = 30;
const HOME = new Vector3(1, -1, 1);
const CREASE = Math.cos((25 * Math.PI) / 180);
// Beyond this many triangles edges are a grey haze, and finding them takes seconds.
const MOST_FOR_EDGES = 100_000;
const TURN = Math.PI / 24;
const ZOOM = 1.15;

/** Corners of faces as a geometry whose longest side goes from -1 to 1. */
function geometryOf(layer) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(layer.positions, 3));
  geometry.setIndex(new BufferAttribute(layer.indices, 1));
  return geometry;
}

function normalsOf({ positions, indices }) {
  const normals = new Float32Array(indices.length);
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  for (let at = 0; at < indices.length; at += 3) {
    a.fromArray(positions, 3 * indices[at]);
    b.fromArray(positions, 3 * indices[at + 1]).sub(a);
    c.fromArray(positions, 3 * indices[at + 2]).sub(a);
    b.cross(c).normalize().toArray(normals, at);
  }
  return normals;
}

/** Pairs of vertices: edges of one face only, and those where two faces meet at an angle. */
function featureEdges(layer) {
  const { positions, indices } = layer;
  const normals = normalsOf(layer);
  const count = positions.length / 3;
  const open = new Map();
  const pairs = [];
  for (let at = 0; at < indices.length; at += 1) {
    const face = at - (at % 3);
    const [p, q] = [indices[at], indices[face + ((at + 1) % 3)]];
    const key = Math.min(p, q) * count + Math.max(p, q);
    const other = open.get(key);
    if (other === undefined) {
      open.set(key, face);
      continue;
    }
    open.delete(key);
    const cosine = normals[face] * normals[other] + normals[face + 1] * normals[other + 1]
      + normals[face + 2] * normals[other + 2];
    if (cosine < CREASE) pairs.push(p, q);
  }
  for (const key of open.keys()) pairs.push(Math.floor(key / count), key % count);
  return pairs;
}

/** One layer as it is drawn: faces, edges, and the cap where the section cuts it. */
class Layer {
  constructor(given, order, count, plane) {
    this.given = given;
    this.plane = plane;
    this.group = new Group();
    this.group.visible = given.shown;
    this.geometry = geometryOf(given);
    const seeThrough = given.opacity < 1;
    this.looks = { color: new Color(given.colour), transparent: seeThrough, opacity: given.opacity };
    this.material = new MeshLambertMaterial({
      ...this.looks, flatShading: true, side: DoubleSide, depthWrite: !seeThrough,
      polygonOffset: true, // Where layers touch, the later one is seen; edges are in front of all.
      polygonOffsetFactor: count - order, polygonOffsetUnits: 4 * (count - order),
    });
    const faces = new Mesh(this.geometry, this.material);
    faces.renderOrder = 100 + order;
    this.group.add(faces);
    this.cap = given.closed ? this.makeCap(order) : null;
  }

  // Where more back faces than front faces lie behind the cut, the cut is inside the solid.
  makeCap(order) {
    const cap = new Group();
    for (const [side, operation] of
      [[BackSide, IncrementWrapStencilOp], [FrontSide, DecrementWrapStencilOp]]) {
      const counter = new Mesh(this.geometry, new MeshBasicMaterial({
        side, depthWrite: false, depthTest: false, colorWrite: false, stencilWrite: true,
        stencilFunc: AlwaysStencilFunc, stencilFail: operation, stencilZFail: operation,
        stencilZPass: operation, clippingPlanes: [this.plane],
        transparent: this.looks.transparent,
      }));
      counter.renderOrder = 3 * order;
      cap.add(counter);
    }
    const lid = new Mesh(new PlaneGeometry(8, 8), new MeshBasicMaterial({
      ...this.looks, side: DoubleSide, stencilWrite: true, stencilRef: 0,
      stencilFunc: NotEqualStencilFunc, stencilFail: ReplaceStencilOp,
      stencilZFail: ReplaceStencilOp, stencilZPass: ReplaceStencilOp,
      polygonOffset: true, polygonOffsetFactor: 0, polygonOffsetUnits: -2 * order,
    }));
    lid.material.color.multiplyScalar(0.8);
    lid.renderOrder = 3 * order + 1;
    lid.onAfterRender = (renderer) => renderer.clearStencil();
    this.lid = lid;
    cap.add(lid);
    cap.visible = false;
    this.group.add(cap);
    return cap;
  }

  showEdges(shown) {
    if (shown && !this.edges) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", this.geometry.getAttribute("position"));
      geometry.setIndex(featureEdges(this.given));
      const opacity = Math.min(1, 0.4 + this.given.opacity / 2);
      this.edges = new LineSegments(geometry, new LineBasicMaterial({
        color: 0x1a1c20, transparent: opacity < 1, opacity,
        clippingPlanes: this.material.clippingPlanes,
      }));
      this.edges.renderOrder = 200;
      this.group.add(this.edges);
    }
    if (this.edges) this.edges.visible = shown;
  }

  cut(active) {
    for (const material of [this.material, this.edges?.material]) {
      if (!material) continue;
      material.clippingPlanes = active ? [this.plane] : [];
    }
    if (!this.cap) return;
    this.cap.visible = active;
    this.plane.coplanarPoint(this.lid.position);
    this.lid.lookAt(this.lid.position.clone().sub(this.plane.normal));
  }
}

/** The scene, its camera, and a picture whenever something changed. */
class View {
  constructor(host, model) {
    this.host = host;
    this.model = model;
    this.plane = new Plane(new Vector3(0, 0, -1), 0);
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, stencil: true });
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.canvas = this.renderer.domElement;
    this.scene = new Scene();
    this.layers = model.layers.map((layer, order, all) => (
      new Layer(layer, order, all.length, this.plane)));
    this.layers.forEach((layer) => this.scene.add(layer.group));
    this.aim();
    this.light();
    host.append(this.canvas);
    this.watch();
    this.home();
  }

  light() {
    const lamp = new DirectionalLight(0xffffff, 2.3);
    // Over the viewer's left shoulder, as in the painter's pictures.
    lamp.position.set(-0.25, 0.45, 0.85);
    this.camera.add(lamp, lamp.target);
    this.scene.add(new AmbientLight(0xffffff, 1.1), this.camera);
  }

  aim() {
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.minDistance = 0.02;
    this.controls.maxDistance = 40;
  }

  /** Look from the right front top, so far away that everything is in the picture. */
  home() {
    const half = Math.min(FIELD_OF_VIEW, FIELD_OF_VIEW * this.camera.aspect) * (Math.PI / 360);
    const distance = (1.02 * this.model.radius) / Math.sin(half);
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(HOME).setLength(distance);
    this.controls.update();
    this.draw();
  }

  watch() {
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.host);
    this.resize();
    this.canvas.tabIndex = 0;
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.enclose();
      this.renderer.render(this.scene, this.camera);
      this.host.dataset.drawn = "yes";
    });
  }

  /** Spend the digits of depth on the model alone. */
  enclose() {
    const distance = this.camera.position.length();
    const reach = 1.01 * this.model.radius;
    this.camera.near = Math.max(distance - reach, reach / 200);
    this.camera.far = distance + reach;
    this.camera.updateProjectionMatrix();
  }

  key(event) {
    const moves = {
      ArrowLeft: [-TURN, 0, 1], ArrowRight: [TURN, 0, 1], ArrowUp: [0, -TURN, 1],
      ArrowDown: [0, TURN, 1], "+": [0, 0, 1 / ZOOM], "-": [0, 0, ZOOM],
    };
    if (event.key === "Home") this.home();
    else if (moves[event.key]) this.turn(...moves[event.key]);
    else return;
    event.preventDefault();
  }

  turn(sideways, down, farther) {
    const arm = this.camera.position.clone().sub(this.controls.target);
    const distance = arm.length() * farther;
    const around = Math.atan2(arm.y, arm.x) + sideways;
    const tilt = Math.acos(arm.z / arm.length()) + down;
    const bent = Math.min(Math.max(tilt, 0.01), Math.PI - 0.01);
    const reach = distance * Math.sin(bent);
    arm.set(reach * Math.cos(around), reach * Math.sin(around), distance * Math.cos(bent));
    this.camera.position.copy(arm.add(this.controls.target));
    this.controls.update();
    this.draw();
  }

  /** Cut at the place on this axis (0, 1, 2), open to where `home` looks from, or null for none. */
  section(axis, place) {
    if (axis !== null) {
      const way = -Math.sign(HOME.getComponent(axis));
      this.plane.normal.set(0, 0, 0).setComponent(axis, way);
      this.plane.constant = -way * place;
    }
    this.layers.forEach((layer) => layer.cut(axis !== null));
    this.draw();
  }

  get drawsEdges() {
    return this.model.layers.reduce((sum, { indices }) => sum + indices.length / 3, 0)
      <= MOST_FOR_EDGES;
  }

  edges(shown) {
    this.layers.forEach((layer) => layer.showEdges(shown));
    this.cutAgain();
    this.draw();
  }

  cutAgain() {
    this.layers.forEach((layer) => layer.cut(layer.material.clippingPlanes?.length > 0));
  }

  show(index, shown) {
    this.layers[index].group.visible = shown;
    this.draw();
  }

  close() {
    cancelAnimationFrame(this.pending);
    this.observer.disconnect();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }
}

/** Draw a model into an element; throws if the browser has no WebGL. */
export function open(host, model) {
  return new View(host, model);
}
