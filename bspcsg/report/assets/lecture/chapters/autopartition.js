// Chapter 2: autopartitions, step by step, and how many fragments they have.
const ROOM = [420, 380];
const WHOLE = [[0, 0], ROOM];

/** The number of random orders in the statistics. */
const ORDERS = 400;

/** Segments that can be dragged, an order, and what is drawn whenever either changes. */
class SegmentScene {
  constructor(plane, changed) {
    this.plane = plane;
    this.changed = changed;
    this.handles = [];
    this.segments = [];
    this.order = [];
  }

  set(segments, order = segments.map((_, i) => i)) {
    this.handles.forEach((handle) => handle.remove());
    this.segments = segments;
    this.order = order;
    this.handles = segments.flatMap((segment, i) => segment.map((end, k) =>
      this.plane.handle(`Segment ${i + 1}, ${k ? "second" : "first"} end`, end, (to) => this.moved(i, k, to), colour(i))));
    this.changed();
  }

  moved(i, k, to) {
    const other = this.segments[i][1 - k];
    if (Math.hypot(to[0] - other[0], to[1] - other[1]) < 8) return this.segments[i][k];
    this.segments[i][k] = to;
    this.changed();
    return to;
  }

  partition() {
    return autopartition(2, this.segments, this.order, WHOLE);
  }
}

/** The look of an autopartition after `step` of its nodes have been made. */
class Growth {
  constructor(view, step) {
    this.view = view;
    this.step = step;
    this.made = view.nodes.slice(0, step);
  }

  isMade(number) {
    return number !== null && number < this.step;
  }

  /** Regions that are not divided yet, with the node that will divide them, if any. */
  open() {
    if (!this.step) return [{ walls: this.view.whole, node: this.view.nodes.length ? 0 : null }];
    return this.made.flatMap((node) => node.children.map((child, k) => ({ walls: node.halves[k], node: child })).filter(({ node: child }) => !this.isMade(child)));
  }

  /** Parts of segments, as they are cut so far. */
  parts() {
    const waiting = this.open().flatMap(({ node }) => (node === null ? [] : this.view.nodes[node].list));
    return [...this.made.flatMap((node) => node.coplanar), ...waiting];
  }
}

function drawGrowth(plane, growth, lit = null) {
  const { view, step } = growth;
  plane.clear();
  growth.open().forEach(({ walls, node }) => plane.region(walls, { class: `region ${node === null ? "empty" : ""}` }));
  const now = lit === null ? step - 1 : lit;
  const node = view.nodes[now];
  if (node && now < step) node.halves.forEach((walls, k) => plane.region(walls, { class: `half ${k ? "plus" : "minus"}` }));
  growth.made.forEach((made, number) => {
    plane.span(made.span, { class: `cut ${colour(made.pivot)} ${number === now ? "now" : ""}` });
  });
  const parts = growth.parts();
  const original = new Map();
  for (const { facet, corners } of parts) {
    plane.line(...corners, { class: `facet ${colour(facet)}` });
    original.set(facet, (original.get(facet) ?? []).concat([corners]));
  }
  for (const pieces of original.values()) {
    const joints = pieces.flat().map((p) => p.map((x) => x.toFixed(3)).join());
    pieces.flat().forEach((p, i) => {
      if (joints.indexOf(joints[i]) !== i) plane.dot(p, 3.4, { class: "joint" });
    });
  }
}

function growthTree(view, growth, lit, number = 0) {
  const k = (child, side, parent) => {
    if (growth.isMade(child)) return { ...growthTree(view, growth, lit, child) };
    const waiting = child === null ? 0 : view.nodes[child].list.length;
    return { leaf: true, name: waiting || "", look: waiting ? "waiting" : "", id: parent };
  };
  if (!growth.isMade(number)) return { leaf: true, name: view.nodes[0]?.list.length ?? 0, look: "waiting" };
  const node = view.nodes[number];
  const now = lit === null ? growth.step - 1 : lit;
  const look = `${colour(node.pivot)} ${number === now ? "now" : ""}`;
  return { name: node.pivot + 1, look, id: number, children: node.children.map((child, side) => k(child, side, number)) };
}

const named = (facets) => (facets.length ? facets.map((i) => `<b class="${colour(i)}">s<sub>${i + 1}</sub></b>`).join(", ") : "none");

function stepWords(view, step) {
  if (!step) return `One region, ${view.nodes[0]?.list.length ?? 0} segments, no cut yet. Step forward.`;
  const node = view.nodes[step - 1];
  const listOf = (child) => (child === null ? [] : [...new Set(view.nodes[child].list.map((p) => p.facet))]);
  const [minus, plus] = node.children.map(listOf);
  const only = (list) => list.filter((i) => !node.cut.includes(i));
  const cut = node.cut.length ? ` It cuts ${named(node.cut)} in two.` : " It cuts none.";
  const in_ = node.list.length > 1 ? `The region holds ${node.list.length} fragments; ${named([node.pivot])} comes first in the order, so its line divides.` : `${named([node.pivot])} is alone in its region; its line divides it into two empty leaves.`;
  const sides = node.list.length > 1 ? ` To the minus side go ${named(only(minus))}, to the plus side ${named(only(plus))}.${cut}` : "";
  return in_ + sides;
}

/** Bars of how many random orders gave how many fragments, and where the shown order stands. */
function histogram(host) {
  const [width, height] = [420, 150];
  const plot = drawn("svg", { viewBox: `0 0 ${width} ${height}`, class: "plot", role: "img" });
  host.append(plot);
  return (counts, mine, bound, n) => {
    plot.replaceChildren();
    const low = n;
    const high = Math.max(Math.max(...counts) + 1, mine + 1, Math.ceil(bound) + 1);
    const x = (value) => 24 + ((value - low) / (high - low)) * (width - 48);
    const bars = new Map();
    counts.forEach((count) => bars.set(count, (bars.get(count) ?? 0) + 1));
    const most = Math.max(...bars.values());
    const wide = Math.max(2, (x(low + 1) - x(low)) * 0.8);
    for (const [value, count] of bars) {
      const tall = (count / most) * (height - 62);
      plot.append(drawn("rect", { x: x(value) - wide / 2, y: height - 26 - tall, width: wide, height: tall, class: value === mine ? "bar mine" : "bar" }));
    }
    const mean = counts.reduce((a, b) => a + b, 0) / counts.length;
    const mark = (value, words, look, y) => {
      plot.append(drawn("line", { x1: x(value), x2: x(value), y1: y, y2: height - 26, class: `mark ${look}` }));
      const anchor = x(value) > width - 120 ? "end" : "start";
      plot.append(drawn("text", { x: x(value) + (anchor === "end" ? -4 : 4), y: y + 9, class: "axis-name", style: `text-anchor:${anchor}` }, words));
    };
    mark(mean, `mean ${rounded(mean, 1)}`, "", 18);
    mark(bound, `n + 2n ln n = ${rounded(bound, 1)}`, "limit", 2);
    plot.append(drawn("line", { x1: 20, x2: width - 20, y1: height - 26, y2: height - 26, class: "axis" }));
    for (const value of new Set([low, Math.round((low + high) / 2), high])) {
      plot.append(drawn("text", { x: x(value), y: height - 11, class: "axis-name", style: "text-anchor:middle" }, String(value)));
    }
    plot.append(drawn("text", { x: width / 2, y: height - 1, class: "axis-name", style: "text-anchor:middle" }, "fragments"));
    plot.setAttribute("aria-label", `Fragments over ${counts.length} random orders: mean ${rounded(mean, 1)}, bound ${rounded(bound, 1)}, this order ${mine}`);
  };
}

function autopartitionFigure(figure) {
  const plane = new Plane(figure.querySelector(".room-pane"), "Segments and the regions of their autopartition", ...ROOM);
  const state = { view: null, lit: null, seed: 11, count: 8, statistics: 0 };
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "The tree of the autopartition", (id) => {
    state.lit = id;
    draw(stepper.at);
  });
  const tell = tiles(figure.querySelector(".read"), [["n", "segments n"], ["fragments", "fragments n̄ so far"], ["cuts", "cuts so far"], ["depth", "depth"], ["nodes", "nodes at the end, 2n̄ + 1"], ["bound", "n + 2 n ln n"]]);
  const plotted = histogram(figure.querySelector(".plot-pane"));
  const stepper = new Stepper(figure.querySelector(".steps"), draw, (step) => (state.view ? stepWords(state.view, step) : ""));
  const chips = new Order(figure.querySelector(".order-pane"), "Order of the segments", (order) => {
    scene.order = order;
    renew();
  });
  const scene = new SegmentScene(plane, renew);

  function draw(step) {
    if (!state.view) return;
    const { view } = state;
    const growth = new Growth(view, step);
    drawGrowth(plane, growth, state.lit !== null && state.lit < step ? state.lit : null);
    scene.segments.forEach((segment, i) => plane.badge(between(...segment), i + 1, { class: colour(i) }));
    tree.show(view.nodes.length ? growthTree(view, growth, state.lit) : null, `${step} of ${view.nodes.length} nodes made`);
    chips.mark(new Set(growth.made.map((node) => node.pivot)));
    const n = scene.segments.length;
    const fragments = growth.parts().length;
    const bound = n + 2 * n * Math.log(n);
    const depth = Math.max(0, ...growth.made.map((node) => node.depth + 1));
    tell({ n, fragments, cuts: fragments - n, depth, nodes: 2 * view.nodes.length + 1, bound: rounded(bound, 1) });
  }

  /** Statistics wait until dragging pauses. */
  function statistics() {
    clearTimeout(state.statistics);
    state.statistics = setTimeout(() => {
      const n = scene.segments.length;
      const found = using(scene.partition(), (p) => JSON.parse(p.orders(ORDERS, 1)));
      plotted(found.fragments, state.view.fragments, n + 2 * n * Math.log(n), n);
      figure.querySelector(".crossed").hidden = !anyMeet(scene.segments);
    }, 60);
  }

  function renew() {
    state.view = using(scene.partition(), (p) => treeOf(p, scene.order));
    state.lit = null;
    chips.set(scene.order);
    stepper.reset(state.view.nodes.length);
    statistics();
  }

  const buttons = figure.querySelector(".buttons");
  const random = randomOf(5);
  const fresh = () => scene.set(randomSegments(state.count, ...ROOM, state.seed, { shortest: 100, longest: 250 }));
  button(buttons, "shuffle the order", () => {
    scene.order = shuffled(scene.order, random);
    renew();
  }, { class: "shuffle" });
  button(buttons, "best of 400", () => {
    const tries = Array.from({ length: ORDERS }, () => shuffled(scene.order, random));
    const fragments = (order) => using(autopartition(2, scene.segments, order, WHOLE), (p) => p.fragments());
    scene.order = tries.reduce((best, order) => {
      const found = fragments(order);
      return found < best[0] ? [found, order] : best;
    }, [Infinity, scene.order])[1];
    renew();
  });
  button(buttons, "other segments", () => {
    state.seed += 1;
    fresh();
  });
  slider(buttons, "n", { min: 1, max: 14, value: state.count }, (count) => {
    state.count = count;
    fresh();
  });
  fresh();
  stepper.go(3);
}

// The pairs in which one shields the other.
function shieldFigure(figure) {
  const plane = new Plane(figure.querySelector(".room-pane"), "Segments, one of them with its line", ...ROOM);
  const scene = new SegmentScene(plane, renew);
  const table = figure.querySelector("tbody");
  const state = { cutter: 0, target: null, timer: 0 };
  const pick = element("div", { class: "order", role: "group", "aria-label": "The segment whose line is drawn" });
  figure.querySelector(".order-pane").append(pick);

  function choose(i) {
    state.cutter = i;
    state.target = null;
    renew();
  }

  function chips() {
    pick.replaceChildren(...scene.segments.map((_, i) => {
      const made = element("button", { type: "button", class: `chip ${colour(i)}`, "aria-pressed": i === state.cutter, "aria-label": `line of segment ${i + 1}` }, String(i + 1));
      made.addEventListener("click", () => {
        choose(i);
        pick.children[i].focus({ preventScroll: true });
      });
      return made;
    }));
  }

  function draw(shields) {
    plane.clear();
    const own = scene.segments[state.cutter];
    const span = state.view.nodes[0].span;
    plane.span(span, { class: `cut now ${colour(state.cutter)}` });
    scene.segments.forEach((segment, i) => {
      plane.line(...segment, { class: `facet ${colour(i)}` });
      plane.badge(beside(segment, shields[i]?.[1]), i + 1, { class: colour(i) });
    });
    const chosen = state.target !== null ? shields[state.target] : null;
    if (chosen) {
      const ends = own.slice().sort((a, b) => Math.hypot(a[0] - chosen[1][0], a[1] - chosen[1][1]) - Math.hypot(b[0] - chosen[1][0], b[1] - chosen[1][1]));
      plane.line(ends[0], chosen[1], { class: `way ${colour(state.cutter)}` });
    }
    shields.forEach((row, j) => {
      if (!row) return;
      const inWay = chosen && j !== state.target && isOnWay(own, row[1], chosen[1]);
      plane.dot(row[1], 5.5, { class: `crossing ${j === state.target ? "target" : ""} ${inWay ? "shield" : ""}` });
      plane.text([row[1][0] + 11, row[1][1] + 9], row[0], { class: "small-name" });
    });
  }

  /** The middle of a segment, or a place where no crossing covers its number. */
  const beside = (segment, crossing) => {
    const middle = between(...segment);
    return crossing && distance(middle, crossing) < 22 ? between(segment[0], middle) : middle;
  };
  const isOnWay = (own, at, end) => own.some((from) => distance(from, at) + distance(at, end) < distance(from, end) + 1e-6)
    && own.every((from) => distance(from, at) < distance(from, end));

  function rows(shields) {
    table.replaceChildren(...shields.flatMap((row, j) => {
      if (!row || j === state.cutter) return [];
      const bound = 1 / (row[0] + 2);
      const share = state.cuts[state.cutter * shields.length + j] / state.trials;
      const name = element("button", { type: "button", class: `chip ${colour(j)}`, "aria-pressed": j === state.target, "aria-label": `segment ${j + 1}, show what shields it` }, String(j + 1));
      name.addEventListener("click", () => {
        state.target = state.target === j ? null : j;
        redraw();
        table.querySelector(`[data-row="${j}"] button`).focus({ preventScroll: true });
      });
      const bar = element("span", { class: "share", style: `--share:${share};--bound:${bound}` });
      const cells = [name, String(row[0]), rounded(bound, 3), rounded(share, 3), bar].map((cell) => element("td", {}, cell));
      return [element("tr", { "data-row": j }, ...cells)];
    }));
    if (!table.children.length) table.append(element("tr", {}, element("td", { colspan: 5 }, "This line reaches no other segment.")));
  }

  function redraw() {
    draw(state.shields);
    rows(state.shields);
  }

  function renew() {
    if (!scene.segments.length) return;
    scene.order = scene.segments.map((_, i) => i);
    chips();
    using(scene.partition(), (p) => {
      state.shields = JSON.parse(p.shields(state.cutter));
    });
    const first = [state.cutter, ...scene.order.filter((i) => i !== state.cutter)];
    state.view = using(autopartition(2, scene.segments, first, WHOLE), (p) => treeOf(p, first));
    if (!state.cuts) measure();
    redraw();
    clearTimeout(state.timer);
    state.timer = setTimeout(() => {
      measure();
      redraw();
    }, 80);
  }

  function measure() {
    const found = using(scene.partition(), (p) => JSON.parse(p.orders(ORDERS * 5, 3)));
    state.cuts = found.cuts;
    state.trials = found.fragments.length;
  }

  scene.set([[[60, 190], [104, 204]], [[158, 130], [166, 300]], [[214, 150], [206, 330]], [[262, 180], [286, 340]], [[330, 160], [338, 350]], [[376, 60], [352, 128]], [[60, 300], [120, 346]], [[40, 60], [230, 84]]]);
}
