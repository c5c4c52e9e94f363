// Chapter 4: a ray through the tree, near side first.
function rayFigure(figure) {
  const plane = new Plane(figure.querySelector(".room-pane"), "Segments and a ray", ...ROOM);
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "The tree, with the nodes that the ray visits numbered in their order");
  const tell = tiles(figure.querySelector(".read"), [["nodes", "nodes visited, C(T)"], ["inner", "inner nodes among them"], ["leaves", "stabbed leaves"], ["tests", "segments tested"], ["depth", "depth(T)"], ["bound", "depth · stabbed leaves"]]);
  const state = { from: [30, 60], through: [210, 150], view: null, events: [], path: null };
  const stepper = new Stepper(figure.querySelector(".steps"), draw, words);
  const scene = new SegmentScene(plane, renew);

  const at = (t) => [0, 1].map((k) => state.from[k] + (state.through[k] - state.from[k]) * t);

  /** The length at which a ray is drawn that meets nothing. */
  const beyond = () => 2 * Math.hypot(...ROOM) / Math.hypot(...[0, 1].map((k) => state.through[k] - state.from[k]));

  const reach = (event) => {
    const [kind, step] = Object.entries(event)[0];
    if (kind === "Test") return step.at ?? 0;
    return Math.min(step.to ?? Infinity, beyond());
  };

  function words(step) {
    if (!state.view) return "";
    if (!step) return "The ray has not started. Each step visits one node, tests one segment or stabs one leaf.";
    const [kind, event] = Object.entries(state.events[step - 1])[0];
    if (kind === "Leaf") return "A leaf is stabbed. It is an empty region, so there is nothing in it to meet, and the ray goes on.";
    const pivot = named([state.view.nodes[event.node].pivot]);
    if (kind === "Visit") {
      const both = event.at !== null && event.at > event.from && (event.to === null || event.at < event.to);
      return `The node of ${pivot}: the ray starts on its ${event.near.toLowerCase()} side, which is visited first. ${both ? "The ray crosses the line inside this region, so the far side may follow." : "The ray does not cross the line inside this region, so the other side is never visited."}`;
    }
    return event.at === null ? `The ray crosses the line of ${pivot}, but not the segment itself.` : `The ray meets the segment of ${pivot}. All that is still waiting lies behind it: done.`;
  }

  function draw(step) {
    if (!state.view) return;
    const { view, events } = state;
    const seen = events.slice(0, step);
    const [kind, last] = step ? Object.entries(events[step - 1])[0] : [null, null];
    plane.clear();
    view.nodes.forEach((node) => node.halves.forEach((walls, k) => {
      if (node.children[k] === null) plane.region(walls, { class: "region empty" });
    }));
    for (const event of seen) {
      if (!event.Leaf || !event.Leaf.place) continue;
      const [above, half] = event.Leaf.place;
      plane.region(view.nodes[above].halves[half === "Plus" ? 1 : 0], { class: `stabbed ${event.Leaf === last ? "now" : ""}` });
    }
    if (kind === "Visit") view.nodes[last.node].halves.forEach((walls, k) => plane.region(walls, { class: `half ${k ? "plus" : "minus"}` }));
    const visited = new Set(seen.filter((event) => event.Visit).map((event) => event.Visit.node));
    view.nodes.forEach((node, number) => plane.span(node.span, { class: `cut ${colour(node.pivot)} ${visited.has(number) ? "now" : ""}` }));
    scene.segments.forEach((segment, i) => {
      plane.line(...segment, { class: `facet ${colour(i)}` });
      plane.badge(between(...segment), i + 1, { class: colour(i) });
    });
    const hit = state.path.hit;
    plane.line(state.from, at(beyond()), { class: "ray ahead" });
    const done = seen.length === events.length;
    const far = done && hit ? hit[1] : Math.max(0, ...seen.filter((e) => !e.Visit).map(reach));
    plane.line(state.from, at(done && !hit ? beyond() : far), { class: "ray" });
    if (done && hit) plane.dot(at(hit[1]), 6.5, { class: "hit" });
    showTree(seen, last);
    const leaves = seen.filter((event) => event.Leaf).length;
    // Leaves are nodes as well.
    const depth = view.depth + 1;
    const tests = seen.filter((event) => event.Test).length;
    tell({ nodes: visited.size + leaves, inner: visited.size, leaves, tests, depth, bound: `${depth} · ${leaves} = ${depth * leaves}` });
  }

  function showTree(seen, last) {
    const { view } = state;
    const turns = new Map();
    const leaves = new Map();
    let count = 0;
    for (const event of seen) {
      if (event.Visit) turns.set(event.Visit.node, (count += 1));
      if (event.Leaf && event.Leaf.place) leaves.set(event.Leaf.place.join(), (count += 1));
    }
    const root = (number, place) => {
      if (number === null) {
        const turn = leaves.get(place);
        return { leaf: true, look: turn ? "hit" : "", name: turn ?? "", edge: turn ? "hit" : "" };
      }
      const node = view.nodes[number];
      const turn = turns.get(number);
      const now = last && last.node === number;
      return {
        name: turn ?? "",
        note: `s${node.pivot + 1}`,
        edge: turn ? "hit" : "",
        look: `${colour(node.pivot)} ${turn ? "" : "pale"} ${now ? "now" : ""}`,
        children: node.children.map((child, k) => root(child, `${number},${k ? "Plus" : "Minus"}`)),
      };
    };
    tree.show(root(0), `${count} nodes visited`);
  }

  function renew() {
    using(scene.partition(), (p) => {
      state.view = treeOf(p, scene.order);
      const [dx, dy] = [0, 1].map((k) => state.through[k] - state.from[k]);
      [state.path, state.events] = JSON.parse(p.shoot(...state.from, 0, dx, dy, 0));
    });
    stepper.reset(state.events.length, state.events.length);
    const share = rounded(state.view.cost);
    figure.querySelector(".expected").textContent = share;
  }

  scene.set([[[96, 250], [70, 340]], [[150, 96], [190, 210]], [[250, 60], [300, 170]], [[250, 240], [330, 260]], [[150, 300], [230, 340]], [[360, 120], [384, 250]], [[90, 30], [190, 40]], [[300, 310], [380, 340]]], [3, 1, 6, 4, 2, 0, 5, 7]);
  plane.handle("The start of the ray", state.from, (to) => {
    if (to[0] === state.through[0] && to[1] === state.through[1]) return state.from;
    state.from = to;
    renew();
    return to;
  }, "eye");
  plane.handle("The direction of the ray", state.through, (to) => {
    if (to[0] === state.from[0] && to[1] === state.from[1]) return state.through;
    state.through = to;
    renew();
    return to;
  }, "aim");
  const random = randomOf(21);
  button(figure.querySelector(".buttons"), "another order", () => {
    scene.order = shuffled(scene.order, random);
    renew();
  });
}
