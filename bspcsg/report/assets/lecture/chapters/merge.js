// Chapter 6: sets as trees, a tree cut by a line, and two trees merged.
const CASE_NAMES = {
  Leaf: "leaf",
  Same: "the same line, same side",
  Opposite: "the same line, sides exchanged",
  MinusMinus: "one-sided: P in T⁻, cut on H⁻",
  MinusPlus: "one-sided: P in T⁻, cut on H⁺",
  PlusMinus: "one-sided: P in T⁺, cut on H⁻",
  PlusPlus: "one-sided: P in T⁺, cut on H⁺",
  Crossing: "mixed: both cut each other",
};

const CASE_WORDS = {
  Leaf: "The subtree is a leaf: both halves are that leaf.",
  Same: "H is this node's own line: its two subtrees are the two halves, unchanged.",
  Opposite: "H is this node's own line turned round: the halves are its subtrees, exchanged.",
  OneSided: "H touches only one side of this node. That subtree is split; the node and its other subtree live on, whole, in one half.",
  Crossing: "H crosses the node's own cut. Both subtrees are split, and each half gets a node with its part of the cut.",
};

const caseName = (found) => (typeof found === "string" ? found : found.OneSided.deep + found.OneSided.home);
const caseWords = (found) => CASE_WORDS[typeof found === "string" ? found : "OneSided"];

/** Shares of an edge at which its name may stand, the best first. */
const NAME_PLACES = [0.5, 0.38, 0.62, 0.26, 0.74];

/** The least distance of two names: badges have a radius of 9. */
const NAMES_APART = 20;

/** Return where the name of an edge covers none of those that stand, or the middle if it must. */
function freePlace(a, b, taken) {
  const isFree = (p) => taken.every((q) => distance(p, q) >= NAMES_APART);
  return NAME_PLACES.map((share) => between(a, b, share)).find(isFree) ?? between(a, b);
}

/** A set's tree as a picture; `mark` gives a node by its place in preorder a look and a note. */
function setTree(nodes, mark = () => ({}), leafMark = () => ({})) {
  let next = 0;
  const grow = () => {
    const number = next;
    next += 1;
    const node = nodes[number];
    if (node.label) return { leaf: true, look: node.label === "In" ? "in" : "out", name: node.label === "In" ? "in" : "", ...leafMark(number) };
    const looks = mark(number);
    const children = [grow(), grow()];
    return { name: node.name, look: looks.look ?? "", note: looks.note, edge: looks.edge, children };
  };
  return grow();
}

/** A polygon whose corners can be dragged. */
class Outline {
  constructor(plane, name, corners, look, changed) {
    this.corners = corners;
    corners.forEach((corner, i) => plane.handle(`${name}, corner ${i + 1}`, corner, (to) => {
      const before = this.corners[i];
      this.corners[i] = to;
      if (isSimple(this.corners)) {
        changed();
        return to;
      }
      this.corners[i] = before;
      return before;
    }, look));
  }
}

/** Return whether a polygon goes round counterclockwise without touching itself. */
function isSimple(corners) {
  const n = corners.length;
  const edges = corners.map((corner, i) => [corner, corners[(i + 1) % n]]);
  const area = edges.reduce((sum, [a, b]) => sum + a[0] * b[1] - a[1] * b[0], 0);
  if (area < 400) return false;
  return edges.every((edge, i) => edges.every((other, j) => {
    const apart = Math.min((j - i + n) % n, (i - j + n) % n);
    return apart < 2 || !meet(edge, other);
  })) && edges.every(([a, b], i) => turn(a, b, edges[(i + 1) % n][1]) !== 0 || between(a, edges[(i + 1) % n][1]).every(Number.isFinite));
}

function splitFigure(figure) {
  const plane = new Plane(figure.querySelector(".room-pane"), "A polygon and the line H", ...ROOM);
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "The polygon's tree T");
  const halves = [".minus-pane", ".plus-pane"].map((name, k) => new TreePicture(figure.querySelector(name), `The half of T on the ${k ? "plus" : "minus"} side`));
  const state = { ends: [[70, 330], [350, 70]], found: null };
  const stepper = new Stepper(figure.querySelector(".steps"), draw, words);

  const splits = () => state.found.steps.filter((step) => step.Split);

  function words(step) {
    if (!state.found) return "";
    const all = splits();
    if (!step) return `H is handed to the root of T. ${all.length} nodes and leaves will be met.`;
    const { root, case: found } = all[step - 1].Split;
    const who = root.Second !== undefined ? `Node <b>${state.found.second.nodes[state.found.second.inner[root.Second]].name}</b>` : `A leaf <b>${root.Leaf.toLowerCase()}</b>`;
    return `${who}. Case: <b>${CASE_NAMES[caseName(found)]}</b>. ${caseWords(found)}`;
  }

  function draw(step) {
    if (!state.found) return;
    const { second, sides, span } = state.found;
    plane.clear();
    sides.forEach((side, k) => side.nodes.forEach((node) => {
      if (node.label) plane.region(node.region, { class: `cell ${node.label === "In" ? "in" : "out"} ${k ? "plus" : "minus"}` });
    }));
    const all = splits();
    const now = step ? all[step - 1].Split.root.Second : undefined;
    second.inner.forEach((place, number) => {
      const node = second.nodes[place];
      plane.span(node.span, { class: `cut plain ${number === now ? "now" : ""}` });
    });
    plane.polygon(outlineOf.corners, { class: "shape a hollow" });
    const { corners } = outlineOf;
    corners.forEach((corner, i) => plane.badge(between(corner, corners[(i + 1) % corners.length]), `a${i + 1}`, { class: "grey" }));
    plane.span(span, { class: "cut h" });
    const [, b] = span;
    plane.text(between(span[0], b, 0.06), "H", { class: "big-name" });
    const cases = new Map();
    all.slice(0, step).forEach(({ Split }) => {
      if (Split.root.Second !== undefined) cases.set(second.inner[Split.root.Second], caseName(Split.case));
    });
    tree.show(setTree(second.nodes, (number) => ({ look: `grey ${cases.has(number) ? "hit" : ""} ${number === second.inner[now] ? "now" : ""}` })), `${cases.size} nodes met`);
    halves.forEach((picture, k) => picture.show(setTree(sides[k].nodes, () => ({ look: "grey" }))));
  }

  function renew() {
    state.found = JSON.parse(wasm_bindgen.split(2, new Float64Array(outlineOf.corners.flat()), new Int32Array([0, outlineOf.corners.length]), new Float64Array(state.ends.flat()), new Float64Array(WHOLE.flat())));
    stepper.reset(splits().length, splits().length);
  }

  const outlineOf = new Outline(plane, "The polygon", [[80, 90], [330, 60], [360, 240], [220, 170], [120, 320]], "a", renew);
  state.ends.forEach((end, k) => plane.handle(`${k ? "Second" : "First"} point of H`, end, (to) => {
    const other = state.ends[1 - k];
    if (Math.hypot(to[0] - other[0], to[1] - other[1]) < 8) return state.ends[k];
    state.ends[k] = to;
    renew();
    return to;
  }, "eye"));
  renew();
}

const OPERATIONS = [["union", "A ∪ B"], ["intersection", "A ∩ B"], ["difference", "A \\ B"], ["xor", "A △ B"]];

function mergeFigure(figure) {
  const plane = new Plane(figure.querySelector(".room-pane"), "Two shapes and what the merge makes of them", ...ROOM);
  const pictures = Object.fromEntries(["a", "b", "c"].map((name) => [name, new TreePicture(figure.querySelector(`.tree-${name}`), { a: "Tree of A", b: "Tree of B", c: "Tree of the result" }[name])]));
  const tell = tiles(figure.querySelector(".read"), [["pairs", "pairs of nodes"], ["splits", "nodes of B met by a cut"], ["shared", "subtrees shared, not copied"], ["nodes", "inner nodes A + B → result"]]);
  const state = { operation: "union", found: null };
  const stepper = new Stepper(figure.querySelector(".steps"), draw, words);
  const options = figure.querySelector(".buttons");

  const kindOf = (step) => Object.keys(step)[0];
  const shapeName = (name, side) => {
    if (name.Leaf) return `a leaf <b>${name.Leaf.toLowerCase()}</b>`;
    const found = state.found[side];
    return `<b>${found.nodes[found.inner[name.First ?? name.Second]]?.name ?? "?"}</b>`;
  };

  function decisionWords(decision, a, b) {
    if (decision === "Divide") return `Both are divided further: B's part will be split by the line of ${shapeName(a, "first")}.`;
    const [kind, value] = Object.entries(decision)[0];
    const leaf = b.Leaf ?? a.Leaf;
    const why = { FirstIsLeaf: `A is ${(a.Leaf ?? "").toLowerCase()} here`, SecondIsLeaf: `B is ${(b.Leaf ?? "").toLowerCase()} here`, Same: "both are the same tree", Complement: "one is the other's complement" };
    const because = why[Array.isArray(value) ? value[1] : value] ?? leaf;
    const becomes = { Leaf: () => `the result is <b>${value[0].toLowerCase()}</b> in the whole region`, First: () => "A's subtree is taken as it is", FirstComplement: () => "A's subtree is taken with in and out exchanged", Second: () => "B's subtree is taken as it is", SecondComplement: () => "B's subtree is taken with in and out exchanged" };
    return `${because}, so ${becomes[kind]()}.`;
  }

  function words(step) {
    if (!state.found) return "";
    if (!step) return "The two roots form the first pair. Step forward.";
    const event = state.found.steps[step - 1];
    const [kind, at] = Object.entries(event)[0];
    if (kind === "Pair") return `<b>Pair</b> of ${shapeName(at.a, "first")} of A and ${shapeName(at.b, "second")} of B. ${decisionWords(at.decision, at.a, at.b)}`;
    if (kind === "Split") return `<b>Split</b> ${shapeName(at.root, "second")} of B. Case: <b>${CASE_NAMES[caseName(at.case)]}</b>. ${caseWords(at.case)}`;
    const outcome = at.joined.Collapsed ? `both sides became <b>${at.joined.Collapsed.toLowerCase()}</b>, so the cut is dropped` : { Shared: "nothing below changed: the node is shared", Rebuilt: "a node with the same line and new subtrees" }[at.joined];
    return `<b>Join</b> at ${shapeName(at.node, "first")} of A: ${outcome}.`;
  }

  function draw(step) {
    if (!state.found) return;
    const { first, second, result, steps, places } = state.found;
    const done = step === steps.length;
    const last = step ? steps[step - 1] : null;
    const [kind, at] = last ? Object.entries(last)[0] : [null, null];
    plane.clear();
    if (done) {
      result.nodes.forEach((node) => {
        if (node.label === "In") plane.region(node.region, { class: "cell in result" });
      });
    }
    plane.polygon(shapes.a.corners, { class: "shape a" });
    plane.polygon(shapes.b.corners, { class: "shape b" });
    const taken = [];
    for (const [name, { corners }] of Object.entries(shapes)) {
      corners.forEach((corner, i) => {
        taken.push(freePlace(corner, corners[(i + 1) % corners.length], taken));
        plane.badge(taken.at(-1), `${name}${i + 1}`, { class: `of-${name}` });
      });
    }
    const place = step ? places[step - 1] : null;
    if (place && place.length && !done) plane.region(place, { class: "focus" });
    if (done) result.inner.forEach((number) => plane.span(result.nodes[number].span, { class: "cut plain" }));
    const line = (side, number, look) => {
      const node = state.found[side].nodes[state.found[side].inner[number]];
      if (node) plane.span(node.span, { class: `cut ${look}` });
    };
    if (kind === "Pair" && at.a.First !== undefined) line("first", at.a.First, "of-a now");
    if (kind === "Pair" && at.b.Second !== undefined) line("second", at.b.Second, "of-b now");
    if (kind === "Split") {
      const cut = [...steps.slice(0, step)].reverse().find((event) => event.Pair && event.Pair.decision === "Divide");
      if (cut) line("first", cut.Pair.a.First, "of-a now");
      if (at.root.Second !== undefined) line("second", at.root.Second, "of-b now");
    }
    if (kind === "Join") line("first", at.node.First, "of-a now");
    const seen = { first: new Set(), second: new Set() };
    for (const event of steps.slice(0, step)) {
      if (event.Pair && event.Pair.a.First !== undefined) seen.first.add(event.Pair.a.First);
      const root = event.Split?.root.Second ?? event.Pair?.b.Second;
      if (root !== undefined) seen.second.add(root);
    }
    const current = { first: kind === "Pair" ? at.a.First : kind === "Join" ? at.node.First : undefined, second: kind === "Pair" ? at.b.Second : kind === "Split" ? at.root.Second : undefined };
    const show = (picture, side, look) => {
      const found = state.found[side];
      const numbers = new Map(found.inner.map((number, k) => [number, k]));
      picture.show(setTree(found.nodes, (number) => ({ look: `${look} ${seen[side].has(numbers.get(number)) ? "" : "pale"} ${numbers.get(number) === current[side] ? "now" : ""}` })));
    };
    show(pictures.a, "first", "of-a");
    show(pictures.b, "second", "of-b");
    pictures.c.show(done ? setTree(result.nodes, (number) => ({ look: result.nodes[number].name.startsWith("a") ? "of-a" : "of-b" })) : { leaf: true, look: "waiting", name: "…" });
    const shown = steps.slice(0, step);
    const shared = shown.filter((event) => event.Pair && ["First", "Second", "FirstComplement", "SecondComplement"].some((key) => event.Pair.decision[key] && [event.Pair.a, event.Pair.b].some((name) => name.First !== undefined || name.Second !== undefined)));
    tell({ pairs: shown.filter((event) => event.Pair).length, splits: shown.filter((event) => event.Split?.root.Second !== undefined).length, shared: shared.length, nodes: `${first.inner.length} + ${second.inner.length} → ${done ? result.inner.length : "…"}` });
  }

  function renew() {
    const flat = (corners) => [new Float64Array(corners.flat()), new Int32Array([0, corners.length])];
    const found = JSON.parse(wasm_bindgen.merge(2, ...flat(shapes.a.corners), ...flat(shapes.b.corners), state.operation, new Float64Array(WHOLE.flat())));
    // That halves have been made is said by the case before; it is no step of its own.
    const kept = found.steps.map((event, i) => [event, found.places[i]]).filter(([event]) => kindOf(event) !== "Halves");
    found.steps = kept.map(([event]) => event);
    found.places = kept.map(([, place]) => place);
    state.found = found;
    stepper.reset(found.steps.length, found.steps.length);
  }

  const shapes = {};
  shapes.a = new Outline(plane, "Shape A", [[60, 80], [270, 60], [290, 230], [150, 280]], "a", () => renew());
  shapes.b = new Outline(plane, "Shape B", [[180, 150], [370, 130], [340, 330], [240, 240], [160, 330]], "b", () => renew());
  choice(options, "Operation", OPERATIONS, (operation) => {
    state.operation = operation;
    renew();
  });
  renew();
}

function intervalsFigure(figure) {
  const [width, height] = [420, 150];
  const plane = new Plane(figure.querySelector(".room-pane"), "Two sets on a line and their combination", width, height);
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "Tree of the combined set");
  const rows = { a: 118, b: 78, c: 30 };
  const state = { a: [60, 180, 250, 330], b: [120, 290], operation: "union" };

  function show() {
    const [a, b] = [state.a, state.b].map((list) => new Float64Array(list));
    const found = JSON.parse(wasm_bindgen.merge(1, a, new Int32Array([0, a.length]), b, new Int32Array([0, b.length]), state.operation, new Float64Array([0, width])));
    plane.clear();
    for (const [name, y] of Object.entries(rows)) {
      plane.line([24, y], [width, y], { class: "axis" });
      plane.text([9, y - 4], { a: "A", b: "B", c: "C" }[name], { class: `small-name of-${name}` });
    }
    for (const [name, side] of [["a", "first"], ["b", "second"], ["c", "result"]]) {
      for (const node of found[side].nodes) {
        if (node.label !== "In") continue;
        const [from, to] = node.region.flat().map((p) => p[0]).sort((p, q) => p - q);
        plane.line([Math.max(from, 24), rows[name]], [to, rows[name]], { class: `band of-${name}` });
      }
    }
    tree.show(setTree(found.result.nodes, (number) => ({ look: found.result.nodes[number].name.startsWith("a") ? "of-a" : "of-b" })));
  }

  for (const name of ["a", "b"]) {
    state[name].forEach((x, i) => plane.handle(`Set ${name.toUpperCase()}, end ${i + 1}`, [x, rows[name]], ([to]) => {
      const list = state[name];
      list[i] = clamp(to, (list[i - 1] ?? 24) + 4, (list[i + 1] ?? width) - 4);
      show();
      return [list[i], rows[name]];
    }, name));
  }
  choice(figure.querySelector(".buttons"), "Operation", OPERATIONS, (operation) => {
    state.operation = operation;
    show();
  });
  show();
}
