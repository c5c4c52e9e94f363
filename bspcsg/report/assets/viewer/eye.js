// From where the model is seen: two cameras on one set of controls.

import { OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const FIELD_OF_VIEW = 30;
const HALF_TANGENT = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
const TURN = Math.PI / 24;
const ZOOM = 1.15;
const PAN = 0.06;

// The picture is so much larger than what it has to hold.
const MARGIN = 1.08;

// Not quite along z, so that y is up in the picture.
const STEEP = 1e-4;

/** Views to look from, as in the painter's pictures. */
export const VIEWS = {
  iso: [1, -1, 1], front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0],
  top: [0, -STEEP, 1], bottom: [0, STEEP, -1],
};

export class Eye {
  /** `box` holds half the sides of the model's box, around the origin, `clouds` its vertices. */
  constructor(canvas, box, clouds) {
    this.box = box;
    this.clouds = clouds;
    this.radius = box.length() || 1;
    this.spread = 1;
    this.aspect = 1;
    this.perspective = new PerspectiveCamera(FIELD_OF_VIEW);
    this.parallel = new OrthographicCamera();
    this.perspective.up.set(0, 0, 1);
    this.parallel.up.set(0, 0, 1);
    this.camera = this.perspective;
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, { minDistance: 0.02, maxDistance: 60, maxZoom: 400,
      minZoom: 0.02 });
    // The side that the picture is fitted to, until somebody looks from elsewhere.
    this.fitted = null;
    this.controls.addEventListener("start", () => { this.fitted = null; });
  }

  get isParallel() {
    return this.camera === this.parallel;
  }

  /** Half of what is seen upwards at the target, in the model's lengths. */
  get halfHeight() {
    return this.isParallel ? this.parallel.top / this.parallel.zoom
      : HALF_TANGENT * this.arm.length();
  }

  get arm() {
    return this.camera.position.clone().sub(this.controls.target);
  }

  /** Change the projection; what is at the target stays as large. */
  project(isParallel) {
    if (isParallel === this.isParallel) return;
    const [half, arm] = [this.halfHeight, this.arm];
    this.camera = isParallel ? this.parallel : this.perspective;
    this.controls.object = this.camera;
    if (!isParallel) arm.setLength(half / HALF_TANGENT);
    this.camera.position.copy(this.controls.target).add(arm);
    if (isParallel) this.frame(half);
    this.controls.update();
  }

  frame(half) {
    Object.assign(this.parallel, { top: half, bottom: -half, left: -half * this.aspect,
      right: half * this.aspect, zoom: 1 });
  }

  resize(aspect) {
    this.aspect = aspect;
    this.perspective.aspect = aspect;
    const { top } = this.parallel;
    Object.assign(this.parallel, { left: -top * aspect, right: top * aspect });
    if (this.fitted) this.look(this.fitted);
  }

  get reach() {
    return this.radius * this.spread;
  }

  /** Look at everything from one of the usual sides, as closely as the picture holds it. */
  look(name = "iso") {
    this.controls.target.set(0, 0, 0);
    this.camera.position.fromArray(VIEWS[name]).setLength(2 * this.reach);
    this.camera.lookAt(0, 0, 0);
    this.camera.updateMatrix();
    if (this.isParallel) this.frame(this.neededHalf());
    else this.camera.position.setLength(this.neededDistance());
    this.controls.update();
    this.fitted = name;
  }

  /** The most that a function of a point gives, over all that may be seen.
   *
   * Points are as the camera sees them: right, up and towards it.
   */
  most(measure) {
    const turn = this.camera.quaternion.clone().invert();
    const point = new Vector3();
    let most = -Infinity;
    for (const cloud of this.spread > 1 ? [this.corners()] : this.clouds) {
      for (let at = 0; at < cloud.length; at += 3) {
        point.fromArray(cloud, at).multiplyScalar(this.spread).applyQuaternion(turn);
        most = Math.max(most, measure(point));
      }
    }
    return most;
  }

  /** The corners of the box, between which parts may move apart. */
  corners() {
    const { x, y, z } = this.box;
    return Array.from({ length: 8 }, (_, corner) => (
      [x, y, z].map((half, axis) => ((corner >> axis) & 1 ? half : -half)))).flat();
  }

  /** Half of the picture's height that a point takes, seen without perspective. */
  share({ x, y }) {
    return MARGIN * Math.max(Math.abs(x) / this.aspect, Math.abs(y));
  }

  neededHalf() {
    return Math.max(this.most((point) => this.share(point)), this.radius / 100);
  }

  neededDistance() {
    const distance = this.most((point) => point.z + this.share(point) / HALF_TANGENT);
    return Math.max(distance, this.radius / 100);
  }

  /** Look at a place closely, from where the eye is. */
  approach(place, size) {
    this.fitted = null;
    const arm = this.arm.setLength(Math.max(size, this.radius / 8) / HALF_TANGENT);
    this.controls.target.copy(place);
    this.camera.position.copy(place).add(arm);
    if (this.isParallel) this.frame(Math.max(size, this.radius / 8));
    this.controls.update();
  }

  /** Spend the digits of depth on the model alone. */
  enclose() {
    const distance = this.camera.position.length();
    const reach = 1.01 * this.reach;
    const near = distance - reach;
    this.camera.near = this.isParallel ? near : Math.max(near, reach / 200);
    this.camera.far = distance + reach;
    this.camera.updateProjectionMatrix();
  }

  /** Do what a key says; false if it says nothing. */
  key(event) {
    const moves = {
      ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
    };
    const names = Object.keys(VIEWS);
    if (event.key === "Home") this.look();
    else if (event.key === "+" || event.key === "=") this.zoom(1 / ZOOM);
    else if (event.key === "-") this.zoom(ZOOM);
    else if (event.shiftKey && moves[event.key]) this.pan(...moves[event.key]);
    else if (moves[event.key]) this.turn(...moves[event.key].map((step) => step * TURN));
    else if (/^[1-7]$/.test(event.key)) this.look(names[event.key - 1]);
    else return false;
    return true;
  }

  zoom(farther) {
    this.fitted = null;
    if (this.isParallel) this.parallel.zoom /= farther;
    else this.camera.position.copy(this.controls.target).addScaledVector(this.arm, farther);
    this.controls.update();
  }

  pan(right, down) {
    this.fitted = null;
    const step = PAN * 2 * this.halfHeight;
    const shift = new Vector3().setFromMatrixColumn(this.camera.matrix, 0)
      .multiplyScalar(right * step);
    shift.addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrix, 1), -down * step);
    this.controls.target.add(shift);
    this.camera.position.add(shift);
    this.controls.update();
  }

  turn(sideways, down) {
    this.fitted = null;
    const { arm } = this;
    const distance = arm.length();
    const around = Math.atan2(arm.y, arm.x) + sideways;
    const tilt = Math.min(Math.max(Math.acos(arm.z / distance) + down, 0.01), Math.PI - 0.01);
    const across = distance * Math.sin(tilt);
    arm.set(across * Math.cos(around), across * Math.sin(around), distance * Math.cos(tilt));
    this.camera.position.copy(arm.add(this.controls.target));
    this.controls.update();
  }

  /** The record that is kept to look from here again. */
  state() {
    return {
      parallel: this.isParallel, position: this.camera.position.toArray(),
      target: this.controls.target.toArray(), half: this.halfHeight,
    };
  }

  restore({ parallel, position, target, half }) {
    this.fitted = null;
    this.project(parallel);
    this.controls.target.fromArray(target);
    this.camera.position.fromArray(position);
    if (parallel) this.frame(half);
    this.controls.update();
  }
}
