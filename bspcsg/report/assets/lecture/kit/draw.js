// Elements, and figures of the plane: y points up, as in the notes.
const SVG = "http://www.w3.org/2000/svg";

function drawn(tag, looks = {}, ...children) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(looks)) {
    if (value !== undefined && value !== null && value !== false) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

function element(tag, looks = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(looks)) {
    if (value !== undefined && value !== null && value !== false) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/** The class that gives facet `i` its colour, the same in region and tree. */
const colour = (i) => `c${i % 12}`;

/** The corners of a convex region from its walls, in order around it. */
function outline(walls) {
  const corners = walls.flat();
  if (!corners.length) return [];
  const middle = centre(corners);
  const angle = ([x, y]) => Math.atan2(y - middle[1], x - middle[0]);
  return corners.sort((a, b) => angle(a) - angle(b));
}

function centre(points) {
  const sum = (axis) => points.reduce((total, p) => total + p[axis], 0) / points.length;
  return [sum(0), sum(1)];
}

const between = (a, b, share = 0.5) => [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];

const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/** A picture of a room of the plane, with handles that stay while the picture is drawn anew. */
class Plane {
  constructor(host, label, width, height) {
    this.width = width;
    this.height = height;
    this.picture = drawn("g", { "aria-hidden": "true" });
    this.handles = drawn("g");
    this.svg = drawn(
      "svg",
      { viewBox: `0 0 ${width} ${height}`, role: "group", "aria-label": label, class: "room" },
      this.picture,
      this.handles,
    );
    host.append(this.svg);
  }

  clear() {
    this.picture.replaceChildren();
  }

  at([x, y]) {
    return [x, this.height - y];
  }

  add(tag, looks, ...children) {
    const made = drawn(tag, looks, ...children);
    this.picture.append(made);
    return made;
  }

  region(walls, looks) {
    const points = outline(walls).map((p) => this.at(p).map((x) => x.toFixed(2)).join(",")).join(" ");
    return this.add("polygon", { points, ...looks });
  }

  polygon(corners, looks) {
    const points = corners.map((p) => this.at(p).map((x) => x.toFixed(2)).join(",")).join(" ");
    return this.add("polygon", { points, ...looks });
  }

  line(a, b, looks) {
    const [[x1, y1], [x2, y2]] = [this.at(a), this.at(b)];
    return this.add("line", { x1, y1, x2, y2, ...looks });
  }

  /** The part of a line inside a region; none if the line passes outside the room. */
  span(ends, looks) {
    if (ends.length === 2) this.line(...ends, looks);
  }

  dot(p, r, looks) {
    const [cx, cy] = this.at(p);
    return this.add("circle", { cx, cy, r, ...looks });
  }

  text(p, words, looks) {
    const [x, y] = this.at(p);
    return this.add("text", { x, y, ...looks }, words);
  }

  /** The name of a facet on a small disc, so that lines below do not cross it. */
  badge(p, words, looks = {}) {
    this.dot(p, 9, { class: `badge ${looks.class ?? ""}` });
    this.text(p, words, { class: "badge-text" });
  }

  /** The point of the room under a pointer. */
  under(event) {
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * this.width;
    const y = ((event.clientY - box.top) / box.height) * this.height;
    return [clamp(Math.round(x), 0, this.width), clamp(Math.round(this.height - y), 0, this.height)];
  }

  /**
   * A point that is dragged, or moved by the arrow keys; `moved` is told the new place and answers
   * the place that it takes.
   */
  handle(label, place, moved, look = "") {
    return new Handle(this, label, place, moved, look);
  }
}

/** Steps of the arrow keys, plain and with shift. */
const KEY_STEP = 8;
const FINE_STEP = 1;
const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

class Handle {
  constructor(plane, label, place, moved, look) {
    this.plane = plane;
    this.moved = moved;
    this.place = place;
    this.node = drawn(
      "g",
      { class: `handle ${look}`, tabindex: 0, role: "slider", "aria-label": `${label}; arrow keys move it` },
      drawn("circle", { r: 18, class: "grip" }),
      look === "aim" ? drawn("rect", { x: -5.5, y: -5.5, width: 11, height: 11, class: "knob" }) : drawn("circle", { r: 6.5, class: "knob" }),
    );
    plane.handles.append(this.node);
    this.listen();
    this.show();
  }

  listen() {
    this.node.addEventListener("pointerdown", (event) => {
      this.node.setPointerCapture(event.pointerId);
      event.preventDefault();
      event.stopPropagation();
      this.node.focus({ preventScroll: true });
    });
    this.node.addEventListener("pointermove", (event) => {
      if (this.node.hasPointerCapture(event.pointerId)) this.move(this.plane.under(event));
    });
    this.node.addEventListener("keydown", (event) => {
      const way = KEYS[event.key];
      if (!way) return;
      event.preventDefault();
      const step = event.shiftKey ? FINE_STEP : KEY_STEP;
      this.move([this.place[0] + way[0] * step, this.place[1] + way[1] * step]);
    });
  }

  move([x, y]) {
    const { width, height } = this.plane;
    this.set(this.moved([clamp(x, 0, width), clamp(y, 0, height)]) ?? this.place);
  }

  set(place) {
    this.place = place;
    this.show();
  }

  show() {
    const [x, y] = this.plane.at(this.place);
    this.node.setAttribute("transform", `translate(${x} ${y})`);
    this.node.setAttribute("aria-valuenow", Math.round(this.place[0]));
    this.node.setAttribute("aria-valuemin", 0);
    this.node.setAttribute("aria-valuemax", this.plane.width);
    this.node.setAttribute("aria-valuetext", `x ${Math.round(this.place[0])}, y ${Math.round(this.place[1])}`);
  }

  remove() {
    this.node.remove();
  }
}
