// Distances, angles and radii between points that somebody clicks, drawn over the picture.

import { Raycaster, Vector2, Vector3 } from "three";

/** The number of points that each kind takes, and the words before. */
export const KINDS = {
  distance: [2, "Click two points."],
  angle: [3, "Click three points; the angle is at the second."],
  radius: [3, "Click three points of a circle."],
};

// A click this near to a corner of the face takes the corner; so far may a finger slip; in pixels.
const SNAP = 11;
const SLIP = 6;

const SVG = "http://www.w3.org/2000/svg";

function shape(tag, attributes) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

/** The circle through three points, or null if they are on a line. */
function circleThrough([a, b, c]) {
  const [u, v] = [b.clone().sub(a), c.clone().sub(a)];
  const normal = u.clone().cross(v);
  const square = normal.lengthSq();
  if (square < 1e-18) return null;
  const arm = u.clone().multiplyScalar(v.lengthSq()).sub(v.clone().multiplyScalar(u.lengthSq()))
    .cross(normal).multiplyScalar(-1 / (2 * square));
  return { center: a.clone().add(arm), radius: arm.length(), normal: normal.normalize() };
}

export class Measure {
  constructor(view) {
    this.view = view;
    this.kind = null;
    this.points = [];
    this.overlay = shape("svg", { class: "overlay", "aria-hidden": "true" });
    view.host.append(this.overlay);
    view.canvas.addEventListener("pointerdown", (event) => { this.pressed = event; });
    view.canvas.addEventListener("pointerup", (event) => this.released(event));
  }

  released(event) {
    if (!this.kind || !this.pressed || event.button > 0) return;
    const slipped = Math.hypot(event.clientX - this.pressed.clientX,
      event.clientY - this.pressed.clientY);
    const box = this.view.canvas.getBoundingClientRect();
    if (slipped <= SLIP) this.take(event.clientX - box.left, event.clientY - box.top);
  }

  /** Begin to measure a distance, an angle or a radius; null ends it. */
  start(kind) {
    this.kind = kind;
    this.view.host.classList.toggle("measuring", kind !== null);
    this.clear();
  }

  clear() {
    this.points = [];
    this.marked = null;
    this.tell(this.kind ? KINDS[this.kind][1] : "");
    this.view.draw();
  }

  stand(onDark) {
    this.overlay.classList.toggle("on-dark", onDark);
  }

  /** Enter takes the point in the middle of the picture, Escape forgets all points. */
  key(event) {
    if (event.key === "Escape" && (this.points.length || this.marked)) this.clear();
    else if (event.key === "Enter" && this.kind) {
      const { clientWidth, clientHeight } = this.view.host;
      this.take(clientWidth / 2, clientHeight / 2);
    } else return false;
    return true;
  }

  take(x, y) {
    const point = this.hit(x, y);
    if (!point) return;
    if (this.points.length === KINDS[this.kind][0]) this.points = [];
    this.points.push(point);
    this.tell(this.sentence());
    this.view.draw();
  }

  /** The point of the surface under a place of the canvas, or the corner next to it. */
  hit(x, y) {
    const { view } = this;
    const { clientWidth: width, clientHeight: height } = view.host;
    const caster = new Raycaster();
    view.scene.updateMatrixWorld();
    caster.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), view.eye.camera);
    const seen = view.layers.filter(({ group }) => group.visible).map(({ fine }) => fine);
    const isCut = view.settings.section.axis >= 0;
    const found = caster.intersectObjects(seen, false)
      .find(({ point }) => !isCut || view.plane.distanceToPoint(point) >= 0);
    return found ? this.snapped(found, x, y) : null;
  }

  snapped({ point, face, object }, x, y) {
    const { position } = object.geometry.attributes;
    let [best, nearest] = [point, SNAP];
    for (const index of [face.a, face.b, face.c]) {
      const corner = object.localToWorld(new Vector3().fromBufferAttribute(position, index));
      const [u, v] = this.onCanvas(corner);
      const distance = Math.hypot(u - x, v - y);
      const isCut = this.view.settings.section.axis >= 0;
      const isThere = !isCut || this.view.plane.distanceToPoint(corner) >= -1e-6;
      if (distance < nearest && isThere) [best, nearest] = [corner, distance];
    }
    return best;
  }

  /** A length of the scene in the model's unit. */
  length(value) {
    const { longest, unit } = this.view.model;
    return `${Number(((value * longest) / 2).toPrecision(5))}${unit && ` ${unit}`}`;
  }

  place(point) {
    const { low, high, longest } = this.view.model;
    const values = point.toArray().map((value, axis) => {
      const exact = (low[axis] + high[axis]) / 2 + (value * longest) / 2;
      // Single precision is a ten-millionth of the model.
      return Number((Math.abs(exact) < longest * 1e-7 ? 0 : exact).toPrecision(5));
    });
    return `(${values.join(", ")})`;
  }

  sentence() {
    const [wanted, advice] = KINDS[this.kind];
    const { points } = this;
    if (points.length < wanted) return `${points.length} of ${wanted}: ${this.place(points.at(-1))}. ${advice}`;
    if (this.kind === "distance") {
      const step = points[1].clone().sub(points[0]);
      const parts = step.toArray().map((value, axis) => (
        `Δ${"xyz"[axis]} ${this.length(Math.abs(value) < 1e-7 ? 0 : value)}`));
      return `Distance ${this.length(step.length())} · ${parts.join(", ")}`;
    }
    if (this.kind === "angle") {
      const [u, v] = [points[0], points[2]].map((point) => point.clone().sub(points[1]));
      return `Angle ${Number(((u.angleTo(v) * 180) / Math.PI).toFixed(2))}°`;
    }
    const circle = circleThrough(points);
    if (!circle) return "The three points are on a line.";
    return `Radius ${this.length(circle.radius)} · diameter ${this.length(2 * circle.radius)}`
      + ` · center ${this.place(circle.center)}`;
  }

  tell(sentence) {
    this.onTell?.(sentence);
  }

  ring(place) {
    this.marked = place;
  }

  onCanvas(point) {
    const { clientWidth: width, clientHeight: height } = this.view.host;
    const { x, y, z } = point.clone().project(this.view.eye.camera);
    return [((x + 1) * width) / 2, ((1 - y) * height) / 2, Math.abs(z) <= 1];
  }

  /** The lines of the overlay in pixels: each a list of places. */
  lines() {
    const { points } = this;
    if (this.kind === "radius" && points.length === 3) {
      const circle = circleThrough(points);
      if (!circle) return [];
      const u = points[0].clone().sub(circle.center);
      const v = circle.normal.clone().cross(u);
      const round = Array.from({ length: 73 }, (_, step) => {
        const angle = (step * Math.PI) / 36;
        return circle.center.clone().addScaledVector(u, Math.cos(angle))
          .addScaledVector(v, Math.sin(angle));
      });
      return [round];
    }
    return points.length > 1 && this.kind !== "radius" ? [points] : [];
  }

  draw() {
    this.overlay.replaceChildren();
    for (const line of this.lines()) {
      const places = line.map((point) => this.onCanvas(point).slice(0, 2).join(",")).join(" ");
      this.overlay.append(shape("polyline", { points: places }));
    }
    for (const point of this.points) {
      const [cx, cy] = this.onCanvas(point);
      this.overlay.append(shape("circle", { cx, cy, r: 4 }));
    }
    if (this.marked) {
      const [cx, cy] = this.onCanvas(this.marked);
      this.overlay.append(shape("circle", { cx, cy, r: 14, class: "ring" }));
    }
    if (this.kind && this.points.length < KINDS[this.kind][0]) this.drawAim();
  }

  /** The place at which Enter takes a point. */
  drawAim() {
    const { clientWidth: width, clientHeight: height } = this.view.host;
    const [x, y] = [width / 2, height / 2];
    const path = `M${x - 9} ${y}h18M${x} ${y - 9}v18`;
    this.overlay.append(shape("path", { d: path, class: "aim" }));
  }

  /** Paint what was measured onto a picture of so many pixels each. */
  paint(context, scale) {
    Object.assign(context, { strokeStyle: "#d1203a", fillStyle: "#d1203a", lineWidth: 2 * scale });
    for (const line of this.lines()) {
      context.beginPath();
      line.map((point) => this.onCanvas(point)).forEach(([x, y]) => context.lineTo(x * scale, y * scale));
      context.stroke();
    }
    for (const [x, y] of this.points.map((point) => this.onCanvas(point))) {
      context.beginPath();
      context.arc(x * scale, y * scale, 4 * scale, 0, 2 * Math.PI);
      context.fill();
    }
    if (this.points.length < (KINDS[this.kind]?.[0] ?? Infinity)) return;
    context.font = `${15 * scale}px system-ui, sans-serif`;
    context.fillText(this.sentence(), 12 * scale, 24 * scale);
  }

  close() {
    this.overlay.remove();
  }
}
