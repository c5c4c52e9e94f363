// The scene: its layers, the eye, and a picture whenever something changed.

import { AmbientLight, DirectionalLight, Plane, Scene, Vector3 } from "three";
import { Eye, VIEWS } from "./eye.js";
import { Layer } from "./layer.js";
import { Measure } from "./measure.js";
import { Pace, STILL } from "./pace.js";
import { Screen } from "./screen.js";

// Degrees between two faces above which their edge is sharp.
const CREASE = 25;

// Beyond this many triangles edges are a grey haze, and finding them takes seconds.
const MOST_FOR_EDGES = 100_000;

// Beyond this many, smooth normals would take seconds; faces this small look smooth anyway.
const MOST_FOR_SMOOTH = 3_000_000;

// After so many milliseconds without a change the view stands still.
const REST = 180;

export class View {
  constructor(host, model) {
    this.host = host;
    this.model = model;
    this.plane = new Plane(new Vector3(0, 0, -1), 0);
    this.screen = new Screen(this.triangles);
    this.pace = new Pace(this.screen.renderer.getContext());
    this.canvas = this.screen.canvas;
    this.scene = new Scene();
    this.layers = model.layers.map((layer, order, all) => (
      new Layer(layer, order, all.length, this.plane)));
    this.layers.forEach((layer) => { layer.share = layer.triangles / this.triangles; });
    this.layers.forEach((layer) => this.scene.add(layer.group));
    const sides = model.high.map((high, axis) => (high - model.low[axis]) / model.longest);
    const clouds = model.layers.map(({ positions }) => positions);
    this.eye = new Eye(this.canvas, new Vector3(...sides), clouds);
    this.light();
    host.append(this.canvas);
    this.settings = this.initial();
    this.measure = new Measure(this);
    this.watch();
    this.eye.look();
    this.dressed = this.dress();
    this.drawLines(this.settings.lines);
  }

  initial() {
    const paints = this.paints;
    return {
      crease: this.triangles <= MOST_FOR_SMOOTH ? CREASE : 0,
      paint: paints.includes(this.model.paint) ? this.model.paint : "",
      lines: this.triangles <= MOST_FOR_EDGES ? "features" : "none",
      opacity: 1, explode: 0, section: { axis: -1, share: 0.5, flipped: false },
    };
  }

  get triangles() {
    return this.model.layers.reduce((sum, layer) => sum + layer.triangles, 0);
  }

  /** Names of the ways in which some layer can be coloured. */
  get paints() {
    return [...new Set(this.model.layers.flatMap(({ paints }) => paints.map((p) => p.name)))];
  }

  light() {
    this.lamp = new DirectionalLight(0xffffff, 2.3);
    // Over the viewer's left shoulder, as in the painter's pictures.
    this.over = new Vector3(-0.25, 0.45, 0.85);
    this.scene.add(new AmbientLight(0xffffff, 1.1), this.lamp, this.lamp.target);
  }

  watch() {
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.host);
    this.resize();
    this.canvas.tabIndex = 0;
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    this.eye.controls.addEventListener("change", () => this.move());
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (!width || !height) return;
    this.screen.resize(width, height);
    this.eye.resize(width / height);
    this.draw();
  }

  /** Draw roughly now, and finely when the eye stands still. */
  move() {
    this.isMoving = true;
    clearTimeout(this.stop);
    this.stop = setTimeout(() => {
      this.isMoving = false;
      this.draw();
      this.note();
    }, REST);
    this.draw();
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.render();
    });
  }

  render() {
    const began = performance.now();
    const { pace, eye: { camera } } = this;
    const isMoving = Boolean(this.isMoving);
    const way = isMoving ? pace.way : STILL;
    this.layers.forEach((layer) => layer.hurry(way.rough));
    this.eye.enclose();
    this.lamp.position.copy(this.over).applyQuaternion(camera.quaternion);
    this.screen.draw(this.scene, camera, way);
    this.measure.draw();
    if (this.isDressed) this.learn(began, isMoving);
  }

  /** Time a picture, for the pace of those to come; the first takes longer than any other. */
  learn(began, isMoving) {
    if (!this.host.dataset.drawn) this.draw();
    else this.pace.time(began, isMoving);
    this.host.dataset.drawn = "yes";
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (!this.eye.key(event) && !this.measure.key(event) && !this.onKey?.(event)) return;
    event.preventDefault();
    this.move();
  }

  look(name) {
    this.eye.look(name);
    this.move();
  }

  home() {
    this.measure.clear();
    this.look("iso");
  }

  project(isParallel) {
    this.eye.project(isParallel);
    this.move();
  }

  /** Cut at the share of the box along an axis (0, 1, 2; -1 for none). */
  section({ axis, share, flipped }) {
    this.settings.section = { axis, share, flipped };
    if (axis >= 0) {
      const side = this.model.high[axis] - this.model.low[axis];
      // Open to where the first picture is seen from.
      const way = -Math.sign(VIEWS.iso[axis]) * (flipped ? -1 : 1);
      this.plane.normal.set(0, 0, 0).setComponent(axis, way);
      this.plane.constant = (-way * (share * 2 - 1) * side) / this.model.longest;
    }
    this.layers.forEach((layer) => layer.cut(axis >= 0));
    this.move();
  }

  /** The coordinate of the section, in the model's unit. */
  sectionPlace() {
    const { axis, share } = this.settings.section;
    const { low, high } = this.model;
    return low[axis] + share * (high[axis] - low[axis]);
  }

  async dress(changes = {}) {
    Object.assign(this.settings, changes);
    const { crease, paint } = this.settings;
    await Promise.all(this.layers.map((layer) => (
      layer.dress(crease, layer.given.paints.find(({ name }) => name === paint)))));
    this.isDressed = true;
    this.draw();
  }

  drawLines(lines) {
    this.settings.lines = lines;
    this.layers.forEach((layer) => layer.drawLines(lines));
    this.draw();
  }

  fade(opacity) {
    this.settings.opacity = opacity;
    this.layers.forEach((layer) => layer.fade(opacity));
    this.move();
  }

  explode(share) {
    this.settings.explode = share;
    this.eye.spread = 1 + share;
    this.layers.forEach((layer) => layer.explode(share));
    this.measure.clear();
    this.move();
  }

  show(index, shown) {
    this.layers[index].group.visible = shown;
    this.draw();
  }

  /** Say whether the canvas is dark. */
  stand(onDark) {
    this.layers.forEach((layer) => layer.stand(onDark));
    this.measure.stand(onDark);
    this.draw();
  }

  /** Look at a place of the model's list closely, and mark it. */
  visit({ at, size }) {
    const place = new Vector3(...at);
    this.eye.approach(place, size);
    this.measure.ring(place);
    this.move();
  }

  /** A PNG file of what is seen, on the ground's colour. */
  picture(ground) {
    this.render();
    const made = document.createElement("canvas");
    Object.assign(made, { width: this.canvas.width, height: this.canvas.height });
    const context = made.getContext("2d");
    context.fillStyle = ground;
    context.fillRect(0, 0, made.width, made.height);
    context.drawImage(this.canvas, 0, 0);
    this.measure.paint(context, this.canvas.width / this.host.clientWidth);
    return new Promise((done) => { made.toBlob(done, "image/png"); });
  }

  /** Look from where the page of this name was left, and keep that from now on. */
  remember(name) {
    this.memory = `bspcsg:${name}`;
    const kept = sessionStorage.getItem(this.memory);
    if (kept) this.eye.restore(JSON.parse(kept));
    this.draw();
  }

  note() {
    if (this.memory) sessionStorage.setItem(this.memory, JSON.stringify(this.eye.state()));
  }

  close() {
    cancelAnimationFrame(this.pending);
    clearTimeout(this.stop);
    this.observer.disconnect();
    this.measure.close();
    this.eye.controls.dispose();
    this.screen.close();
  }
}
