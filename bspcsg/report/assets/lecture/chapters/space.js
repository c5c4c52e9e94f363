// Chapter 7: the same in space. What is drawn is drawn without a depth buffer, in the tree's order.
const CUBE = [[0, 0, 0], [100, 100, 100]];

const minus3 = (a, b) => a.map((x, k) => x - b[k]);
const dot3 = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
const cross3 = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** A camera that circles the middle of the cube; `turned` is told whenever it moves. */
class Orbit {
  constructor(host, label, turned, elevation = 0.42) {
    this.size = [420, 380];
    this.azimuth = 0.62;
    this.elevation = elevation;
    this.turned = turned;
    this.picture = drawn("g", { "aria-hidden": "true" });
    this.svg = drawn("svg", { viewBox: `0 0 ${this.size.join(" ")}`, class: "room orbit", tabindex: 0, role: "application", "aria-label": `${label}; drag or arrow keys turn it` }, this.picture);
    host.append(this.svg);
    this.aim();
    this.listen();
  }

  listen() {
    let last = null;
    this.svg.addEventListener("pointerdown", (event) => {
      this.svg.setPointerCapture(event.pointerId);
      last = [event.clientX, event.clientY];
    });
    this.svg.addEventListener("pointermove", (event) => {
      if (!last || !this.svg.hasPointerCapture(event.pointerId)) return;
      this.turn((last[0] - event.clientX) / 150, (event.clientY - last[1]) / 150);
      last = [event.clientX, event.clientY];
    });
    this.svg.addEventListener("pointerup", () => {
      last = null;
    });
    this.svg.addEventListener("keydown", (event) => {
      const way = KEYS[event.key];
      if (!way) return;
      event.preventDefault();
      this.turn(way[0] * 0.12, way[1] * 0.12);
    });
  }

  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = clamp(this.elevation + elevation, -1.4, 1.4);
    this.aim();
    this.turned();
  }

  aim() {
    const [sa, ca, se, ce] = [Math.sin(this.azimuth), Math.cos(this.azimuth), Math.sin(this.elevation), Math.cos(this.elevation)];
    this.back = [sa * ce, -ca * ce, se];
    this.right = [ca, sa, 0];
    this.up = cross3(this.back, this.right);
    this.eye = this.back.map((x) => Math.round((50 + 330 * x) * 100) / 100);
  }

  /** The place of a point of space in the picture. */
  at(point) {
    const from = minus3(point, [50, 50, 50]);
    const zoom = 860 / (330 - dot3(from, this.back));
    return [this.size[0] / 2 + dot3(from, this.right) * zoom, this.size[1] / 2 - dot3(from, this.up) * zoom];
  }

  faces(corners) {
    const [a, b, c] = corners;
    return dot3(cross3(minus3(b, a), minus3(c, a)), minus3(this.eye, a)) > 0;
  }

  polygon(corners, looks) {
    const points = corners.map((p) => this.at(p).map((x) => x.toFixed(1)).join(",")).join(" ");
    this.picture.append(drawn("polygon", { points, ...looks }));
  }

  /** The brightness of a polygon, from 0 to 1. */
  light(corners) {
    const normal = cross3(minus3(corners[1], corners[0]), minus3(corners[2], corners[0]));
    const length = Math.hypot(...normal) || 1;
    return 0.6 + 0.4 * Math.abs(dot3(normal, [0.36, -0.48, 0.8]) / length);
  }

  /** The edges of the cube, those behind or those in front. */
  frame() {
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((k) => ((i >> k) & 1) * 100));
    corners.forEach((a, i) => corners.forEach((b, j) => {
      if (i < j && [1, 2, 4].includes(i ^ j)) {
        const [[x1, y1], [x2, y2]] = [this.at(a), this.at(b)];
        this.picture.append(drawn("line", { x1, y1, x2, y2, class: "frame" }));
      }
    }));
  }
}

/** A bar between two points of the cube, as a quadrilateral that lies flat in z or is tilted. */
const quad = (...corners) => corners;

const BARS = [
  quad([4, 16, 30], [92, 16, 66], [92, 36, 66], [4, 36, 30]),
  quad([64, 4, 30], [84, 4, 30], [84, 92, 66], [64, 92, 66]),
  quad([96, 64, 30], [96, 84, 30], [8, 84, 66], [8, 64, 66]),
  quad([16, 96, 30], [16, 8, 66], [36, 8, 66], [36, 96, 30]),
];

const ROOMS = [
  quad([8, 8, 10], [92, 8, 10], [92, 92, 10], [8, 92, 10]),
  quad([50, 14, 12], [50, 62, 12], [50, 62, 78], [50, 14, 78]),
  quad([14, 62, 12], [70, 62, 12], [70, 62, 70], [14, 62, 70]),
  quad([20, 20, 50], [44, 20, 50], [44, 44, 50], [20, 44, 50]),
  quad([62, 24, 30], [86, 30, 30], [86, 30, 66], [62, 24, 66]),
  quad([30, 74, 20], [84, 84, 20], [84, 84, 54], [30, 74, 54]),
];

function spaceFigure(figure) {
  const orbit = new Orbit(figure.querySelector(".room-pane"), "Polygons in space", () => draw(stepper.at), 0.95);
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "The tree of the polygons");
  const tell = tiles(figure.querySelector(".read"), [["n", "polygons"], ["fragments", "fragments"], ["depth", "depth"], ["cost", "C(T), points"]]);
  const state = { facets: BARS, order: [0, 1, 2, 3], partition: null, view: null, sorted: true };
  const stepper = new Stepper(figure.querySelector(".steps"), draw, (step) => {
    if (!state.view) return "";
    const words = stepWords(state.view, step);
    return step ? words.replaceAll("line", "plane") : words.replace("segments", "polygons");
  });

  function draw(step) {
    if (!state.view) return;
    const { view } = state;
    orbit.picture.replaceChildren();
    orbit.frame();
    const growth = new Growth(view, step);
    const done = step === view.nodes.length;
    const [order] = JSON.parse(state.partition.order(...orbit.eye));
    const painted = order.flatMap((number) => view.nodes[number].coplanar.map((part) => ({ ...part, node: number })));
    const parts = state.sorted ? painted : growth.parts().sort((p, q) => p.facet - q.facet);
    parts.forEach(({ facet, corners }) => orbit.polygon(corners, { class: `face ${colour(facet)} ${done && state.sorted ? "cut-edges" : ""}`, style: `--light:${orbit.light(corners)}` }));
    const node = view.nodes[step - 1];
    if (node && !done) orbit.polygon(node.span, { class: `knife ${colour(node.pivot)}` });
    tree.show(growthTree(view, growth, null), `${step} of ${view.nodes.length} nodes made`);
    tell({ n: state.facets.length, fragments: growth.parts().length, depth: view.depth, cost: rounded(view.cost) });
  }

  function renew(at = null) {
    state.partition?.free();
    state.partition = autopartition(3, state.facets, state.order, CUBE);
    state.view = treeOf(state.partition, state.order);
    stepper.reset(state.view.nodes.length, at ?? state.view.nodes.length);
  }

  const buttons = figure.querySelector(".buttons");
  choice(buttons, "Scene", [["bars", "four bars in a ring"], ["rooms", "walls"]], (name) => {
    state.facets = name === "bars" ? BARS : ROOMS;
    state.order = state.facets.map((_, i) => i);
    renew();
  });
  choice(buttons, "Drawing order", [["tree", "the tree's order"], ["input", "the input's order"]], (name) => {
    state.sorted = name === "tree";
    draw(stepper.at);
  });
  const random = randomOf(4);
  button(buttons, "another order", () => {
    state.order = shuffled(state.order, random);
    renew();
  });
  renew();
}

/** The faces of a box, counterclockwise from outside. */
function box([x0, y0, z0], [x1, y1, z1]) {
  return [
    [[x0, y0, z0], [x0, y1, z0], [x1, y1, z0], [x1, y0, z0]],
    [[x0, y0, z1], [x1, y0, z1], [x1, y1, z1], [x0, y1, z1]],
    [[x0, y0, z0], [x1, y0, z0], [x1, y0, z1], [x0, y0, z1]],
    [[x0, y1, z0], [x0, y1, z1], [x1, y1, z1], [x1, y1, z0]],
    [[x0, y0, z0], [x0, y0, z1], [x0, y1, z1], [x0, y1, z0]],
    [[x1, y0, z0], [x1, y1, z0], [x1, y1, z1], [x1, y0, z1]],
  ];
}

/** The faces of a tetrahedron, counterclockwise from outside. */
function tetrahedron(a, b, c, d) {
  return [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
}

function solidsFigure(figure) {
  const orbit = new Orbit(figure.querySelector(".room-pane"), "Two solids merged", draw);
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "Tree of the result");
  const tell = tiles(figure.querySelector(".read"), [["pairs", "pairs of nodes"], ["crossing", "mixed cases"], ["cells", "convex cells of the result"], ["nodes", "inner nodes A + B → result"]]);
  const state = { operation: "difference", apart: 0.12, found: null };
  const solids = [box([14, 18, 12], [72, 70, 62]), tetrahedron([34, 40, 30], [96, 46, 34], [56, 96, 36], [58, 56, 96])];
  const flat = (faces) => {
    const offsets = [0];
    faces.forEach((face) => offsets.push(offsets[offsets.length - 1] + face.length));
    return [new Float64Array(faces.flat(2)), new Int32Array(offsets)];
  };

  /** The cells of the result from the farthest to the nearest: far side, near side, all the way. */
  function cells() {
    const { nodes } = state.found.result;
    let next = 0;
    const walk = () => {
      const node = nodes[next];
      next += 1;
      if (node.label) return node.label === "In" ? [node.region] : [];
      const [minus, plus] = [walk(), walk()];
      const [a, b, c, d] = node.hyperplane;
      return dot3([a, b, c], orbit.eye) + d > 0 ? [...minus, ...plus] : [...plus, ...minus];
    };
    return walk();
  }

  function draw() {
    if (!state.found) return;
    orbit.picture.replaceChildren();
    orbit.frame();
    cells().forEach((walls) => {
      const points = walls.flat();
      const middle = [0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);
      const moved = walls.map((corners) => corners.map((p) => p.map((x, k) => x + (middle[k] - 50) * state.apart)));
      moved.filter((corners) => orbit.faces(corners)).forEach((corners) => orbit.polygon(corners, { class: "face solid", style: `--light:${orbit.light(corners)}` }));
    });
  }

  function renew() {
    state.found = JSON.parse(wasm_bindgen.merge(3, ...flat(solids[0]), ...flat(solids[1]), state.operation, new Float64Array(CUBE.flat())));
    const { first, second, result, steps } = state.found;
    tree.show(setTree(result.nodes, (number) => ({ look: result.nodes[number].name.startsWith("a") ? "of-a" : "of-b" })), `${result.inner.length} inner nodes`);
    tell({
      pairs: steps.filter((step) => step.Pair).length,
      crossing: steps.filter((step) => step.Split?.case === "Crossing").length,
      cells: result.nodes.filter((node) => node.label === "In").length,
      nodes: `${first.inner.length} + ${second.inner.length} → ${result.inner.length}`,
    });
    draw();
  }

  const buttons = figure.querySelector(".buttons");
  choice(buttons, "Operation", [OPERATIONS[2], OPERATIONS[0], OPERATIONS[1], OPERATIONS[3]], (operation) => {
    state.operation = operation;
    renew();
  });
  slider(buttons, "cells apart", { min: 0, max: 60, value: 12 }, (percent) => {
    state.apart = percent / 100;
    draw();
  });
  renew();
}
