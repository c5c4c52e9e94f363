// Chapter 5: what a tree costs, and trees that learn from their rays.
const POLICY_WORDS = { first: "in the order given", random: "random order", "least-splits": "fewest cuts", balanced: "best balance", "least-cost": "least expected cost" };

function policiesFigure(figure) {
  const scenes = {
    fence: Array.from({ length: 9 }, (_, i) => [[42 + 42 * i, 60 + 13 * (i % 4)], [42 + 42 * i + 8, 320 - 17 * (i % 3)]]),
    scattered: randomSegments(11, ...ROOM, 31, { longest: 140 }),
    outline: Array.from({ length: 10 }, (_, i) => [i, i + 1].map((k) => [210 + 150 * Math.cos((k * Math.PI) / 5), 190 + 150 * Math.sin((k * Math.PI) / 5)].map(Math.round))),
  };
  const plane = new Plane(figure.querySelector(".room-pane"), "The tree that the chosen rule makes", ...ROOM);
  const table = figure.querySelector("tbody");
  const state = { segments: scenes.fence, policy: "balanced" };

  function show() {
    const order = state.segments.map((_, i) => i);
    const partition = autopartition(2, state.segments, order, WHOLE);
    using(partition, (p) => {
      const rows = JSON.parse(p.policies(7));
      const best = { fragments: Math.min(...rows.map((r) => r.fragments)), depth: Math.min(...rows.map((r) => r.depth)), cost: Math.min(...rows.map((r) => r.cost)) };
      table.replaceChildren(...rows.map((row) => {
        const name = element("button", { type: "button", "aria-pressed": row.name === state.policy, class: "policy" }, POLICY_WORDS[row.name]);
        name.addEventListener("click", () => {
          state.policy = row.name;
          show();
          table.querySelector("[aria-pressed=true]").focus({ preventScroll: true });
        });
        const cell = (key, digits) => element("td", { class: rounded(row[key], digits) === rounded(best[key], digits) ? "best" : "" }, rounded(row[key], digits));
        return element("tr", {}, element("td", {}, name), cell("fragments", 0), cell("depth", 0), cell("cost", 2));
      }));
      const chosen = rows.find((row) => row.name === state.policy);
      plane.clear();
      chosen.leaves.forEach(({ walls, depth }) => plane.region(walls, { class: "region shade", style: `--depth:${depth / 10}` }));
      chosen.spans.forEach(([pivot, span]) => plane.span(span, { class: `cut ${colour(pivot)}` }));
      state.segments.forEach((segment, i) => plane.line(...segment, { class: `facet ${colour(i)}` }));
    });
  }

  choice(figure.querySelector(".buttons"), "Scene", [["fence", "a fence"], ["scattered", "scattered"], ["outline", "an outline"]], (name) => {
    state.segments = scenes[name];
    show();
  });
  show();
}

function adaptiveFigure(figure) {
  const plane = new Plane(figure.querySelector(".room-pane"), "Segments, and rays that you paint: press and sweep", ...ROOM);
  plane.svg.classList.add("painted");
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "The tree as rays have grown it, with the visits of each node");
  const tell = tiles(figure.querySelector(".read"), [["rays", "rays"], ["divisions", "leaves divided"], ["mine", "work per ray, last 40"], ["other", "static tree, random order"], ["most", "most hit segment"]]);
  const plotted = costCurve(figure.querySelector(".plot-pane"));
  const state = { segments: randomSegments(12, ...ROOM, 41, { longest: 120 }), from: [40, 190], aim: [150, 196], threshold: 6, grown: null, still: null, costs: [], trails: [], hits: [] };
  const random = randomOf(77);

  function restart() {
    const flat = new Float64Array(state.segments.flat(2));
    const room = new Float64Array(WHOLE.flat());
    state.grown?.free();
    state.still?.free();
    const ranks = shuffled(state.segments.map((_, i) => i + 1), randomOf(3));
    state.grown = new wasm_bindgen.SelfOrganising(flat, room, state.threshold, new Uint32Array(state.segments.length));
    state.still = new wasm_bindgen.SelfOrganising(flat, room, 0, new Uint32Array(ranks));
    state.costs = [];
    state.trails = [];
    state.hits = state.segments.map(() => 0);
    show();
  }

  function shoot(from, through) {
    const [dx, dy] = [through[0] - from[0], through[1] - from[1]];
    if (!dx && !dy) return;
    const mine = JSON.parse(state.grown.shoot(...from, dx, dy));
    const other = JSON.parse(state.still.shoot(...from, dx, dy));
    state.costs.push([mine.nodes + mine.tests, other.nodes + other.tests]);
    if (mine.facet !== null) state.hits[mine.facet] += 1;
    const length = 900 / Math.hypot(dx, dy);
    state.trails.push([from, mine.point ?? [from[0] + dx * length, from[1] + dy * length]]);
    if (state.trails.length > 60) state.trails.shift();
  }

  function show() {
    const nodes = JSON.parse(state.grown.view());
    plane.clear();
    const most = Math.max(1, ...nodes.filter((n) => !n.children).map((n) => n.visits));
    nodes.forEach((node) => {
      if (!node.children) plane.region(node.region, { class: "region shade", style: `--depth:${(node.visits / most) * 0.55}` });
    });
    nodes.forEach((node) => {
      if (node.children) plane.span(node.span, { class: `cut now ${colour(node.facets[0][0])}` });
    });
    state.trails.forEach(([from, to], i) => plane.line(from, to, { class: "trail", style: `--age:${(i + 1) / state.trails.length}` }));
    const peak = Math.max(1, ...state.hits);
    state.segments.forEach((segment, i) => {
      plane.line(...segment, { class: `facet ${colour(i)}`, style: `stroke-width:${3.5 + 6 * (state.hits[i] / peak)}` });
      plane.badge(between(...segment), i + 1, { class: colour(i) });
    });
    plane.line(state.from, state.aim, { class: "ray" });
    const root = (number) => {
      const node = nodes[number];
      if (!node.children) return { leaf: true, name: node.facets.length || "", note: node.visits, look: node.facets.length > 1 ? "waiting" : "" };
      return { name: node.facets[0][0] + 1, note: node.visits, look: colour(node.facets[0][0]), children: node.children.map(root) };
    };
    tree.show(root(0), `${nodes.length} nodes`);
    const recent = state.costs.slice(-40);
    const mean = (k) => (recent.length ? rounded(recent.reduce((sum, cost) => sum + cost[k], 0) / recent.length, 1) : "–");
    const best = state.hits.indexOf(Math.max(...state.hits));
    tell({ rays: state.costs.length, divisions: nodes.filter((n) => n.children).length, mine: mean(0), other: mean(1), most: state.hits[best] ? `s${best + 1}: ${state.hits[best]} hits` : "–" });
    plotted(state.costs);
  }

  function fan(count, spread) {
    for (let k = 0; k < count; k += 1) {
      const [dx, dy] = [0, 1].map((axis) => state.aim[axis] - state.from[axis]);
      const angle = Math.atan2(dy, dx) + (random() + random() - 1) * spread;
      shoot(state.from, [state.from[0] + 100 * Math.cos(angle), state.from[1] + 100 * Math.sin(angle)]);
    }
    show();
  }

  let start = null;
  plane.svg.addEventListener("pointerdown", (event) => {
    start = plane.under(event);
    plane.svg.setPointerCapture(event.pointerId);
    state.from = start;
    from.set(start);
  });
  plane.svg.addEventListener("pointermove", (event) => {
    if (!start || !plane.svg.hasPointerCapture(event.pointerId)) return;
    const to = plane.under(event);
    if (Math.hypot(to[0] - start[0], to[1] - start[1]) < 12) return;
    state.aim = to;
    aim.set(to);
    shoot(start, to);
    show();
  });
  plane.svg.addEventListener("pointerup", () => {
    start = null;
  });
  const from = plane.handle("The start of the rays", state.from, (to) => {
    state.from = to;
    show();
    return to;
  }, "eye");
  const aim = plane.handle("The direction of the rays", state.aim, (to) => {
    state.aim = to;
    show();
    return to;
  }, "aim");
  const buttons = figure.querySelector(".buttons");
  button(buttons, "one ray", () => fan(1, 0), { class: "shoot-one" });
  button(buttons, "40 rays around it", () => fan(40, 0.3), { class: "shoot-many" });
  button(buttons, "40 rays anywhere", () => {
    for (let k = 0; k < 40; k += 1) shoot([random() * ROOM[0], random() * ROOM[1]], [random() * ROOM[0], random() * ROOM[1]]);
    show();
  });
  button(buttons, "forget all", restart);
  const table = figure.querySelector("tbody");
  slider(buttons, "threshold", { min: 1, max: 40, value: state.threshold }, (threshold) => {
    state.threshold = threshold;
    restart();
    compareRays(table, threshold);
  });
  restart();
  compareRays(table, state.threshold);
  fan(40, 0.3);
}

/** Rays of a comparison, and how many at its beginning and at its end are counted. */
const COMPARED = 600;
const COUNTED = 150;

/** The scenes of each comparison, whose mean is shown: one alone is good or bad luck. */
const SEEDS = [41, 43, 47];

/** Where the tree that organises itself pays, and where it does not. */
function compareRays(table, threshold) {
  const sizes = [[12, { longest: 120 }], [200, { shortest: 6, longest: 16, edge: 5 }]];
  const rays = [["one direction", raysAlong], ["anywhere", raysAnywhere]];
  table.replaceChildren(...sizes.flatMap(([count, looks]) => {
    const scenes = SEEDS.map((seed) => randomSegments(count, ...ROOM, seed, looks));
    return rays.map(([words, made]) => comparedRow(count, words, scenes.map((scene) => workOf(scene, made(), threshold))));
  }));
}

/** A row of the comparison, in which the smaller of two figures is marked. */
function comparedRow(count, words, works) {
  const cells = ["nodes", "first", "last"].flatMap((key) => {
    const [mine, other] = [0, 1].map((tree) => works.reduce((sum, work) => sum + work[tree][key], 0) / works.length);
    const digits = key === "nodes" ? 0 : 1;
    return [[mine, mine < other], [other, other < mine]].map(([value, best]) => element("td", { class: best ? "best" : "" }, rounded(value, digits)));
  });
  return element("tr", {}, element("td", {}, String(count)), element("td", {}, words), ...cells);
}

function raysAlong() {
  const random = randomOf(91);
  const angles = Array.from({ length: COMPARED }, () => (random() + random() - 1) * 0.1);
  return angles.map((angle) => [[4, ROOM[1] / 2], [Math.cos(angle), Math.sin(angle)]]);
}

function raysAnywhere() {
  const random = randomOf(92);
  const place = () => [random() * ROOM[0], random() * ROOM[1]];
  return Array.from({ length: COMPARED }, () => [place(), place()]).map(([from, to]) => [from, [to[0] - from[0], to[1] - from[1]]]);
}

/** The nodes of the tree that grows and of the static one, and the work of a ray at the beginning and at the end. */
function workOf(scene, rays, threshold) {
  const flat = new Float64Array(scene.flat(2));
  const room = new Float64Array(WHOLE.flat());
  const ranks = shuffled(scene.map((_, i) => i + 1), randomOf(3));
  const trees = [[threshold, new Uint32Array(scene.length)], [0, new Uint32Array(ranks)]];
  const mean = (costs) => costs.reduce((sum, cost) => sum + cost, 0) / costs.length;
  return trees.map(([limit, hits]) => using(new wasm_bindgen.SelfOrganising(flat, room, limit, hits), (tree) => {
    const costs = rays.map(([from, way]) => {
      const shot = JSON.parse(tree.shoot(...from, ...way));
      return shot.nodes + shot.tests;
    });
    return { nodes: JSON.parse(tree.view()).length, first: mean(costs.slice(0, COUNTED)), last: mean(costs.slice(-COUNTED)) };
  }));
}

/** Nodes visited and segments tested per ray as it goes: the tree that grows, and the one that does not. */
function costCurve(host) {
  const [width, height, window] = [420, 140, 20];
  const plot = drawn("svg", { viewBox: `0 0 ${width} ${height}`, class: "plot", role: "img" });
  host.append(plot);
  return (costs) => {
    plot.replaceChildren();
    const smooth = (k) => costs.map((_, i) => {
      const part = costs.slice(Math.max(0, i - window + 1), i + 1);
      return part.reduce((sum, cost) => sum + cost[k], 0) / part.length;
    });
    const curves = [smooth(0), smooth(1)];
    const high = Math.max(4, ...curves.flat());
    const x = (i) => 30 + (i / Math.max(costs.length - 1, 1)) * (width - 44);
    const y = (value) => height - 24 - (value / high) * (height - 44);
    for (const value of [0, Math.round(high / 2), Math.floor(high)]) {
      plot.append(drawn("line", { x1: 30, x2: width - 14, y1: y(value), y2: y(value), class: "grid" }));
      plot.append(drawn("text", { x: 24, y: y(value) + 4, class: "axis-name", style: "text-anchor:end" }, String(value)));
    }
    curves.forEach((curve, k) => {
      const points = curve.map((value, i) => `${x(i).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
      plot.append(drawn("polyline", { points, class: `curve ${k ? "other" : "mine"}` }));
    });
    plot.append(drawn("text", { x: 30, y: 12, class: "axis-name", style: "text-anchor:start" }, `work per ray (mean of ${window})`));
    plot.append(drawn("text", { x: width - 14, y: height - 6, class: "axis-name", style: "text-anchor:end" }, `${costs.length} rays →`));
    plot.append(drawn("text", { x: width - 14, y: 12, class: "axis-name mine", style: "text-anchor:end" }, "self-organising"));
    plot.append(drawn("text", { x: width - 110, y: 12, class: "axis-name other", style: "text-anchor:end" }, "static"));
    const last = curves.map((curve) => curve[curve.length - 1] ?? 0);
    plot.setAttribute("aria-label", `Work per ray after ${costs.length} rays: self-organising ${rounded(last[0], 1)}, static ${rounded(last[1], 1)}`);
  };
}
