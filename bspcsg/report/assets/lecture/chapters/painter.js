// Chapter 3: the painter's order.
function painterFigure(figure) {
  const plane = new Plane(figure.querySelector(".room-pane"), "Segments and the eye", ...ROOM);
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "The tree, nodes numbered in the painter's order");
  const strip = filmStrip(figure.querySelector(".strip-pane"));
  const state = { eye: [205, 196], view: null, order: [], sides: [], painted: 0 };
  const stepper = new Stepper(figure.querySelector(".steps"), draw, words);
  const scene = new SegmentScene(plane, renew);

  /** The fragments from the farthest to the nearest, each with its node. */
  const fragments = () => state.order.flatMap((number) => state.view.nodes[number].coplanar.map((part) => ({ ...part, node: number })));

  function words(step) {
    if (!state.view) return "";
    const part = fragments()[step - 1];
    if (!part) return "Nothing is painted yet. Step forward: the farthest fragment comes first.";
    const side = { "-1": "minus", 0: "neither", 1: "plus" }[state.sides[part.node]];
    return `Stroke ${step}: a fragment of ${named([part.facet])}. The eye is on the ${side} side of its line, so all on the other side has been painted, and what is on the eye's side will be painted over it.`;
  }

  function draw(step) {
    if (!state.view) return;
    const { view, eye } = state;
    drawGrowth(plane, new Growth(view, view.nodes.length), -1);
    const all = fragments();
    all.forEach((part, rank) => {
      plane.polygon([eye, ...part.corners], { class: `sight ${colour(part.facet)} ${rank === step - 1 ? "now" : ""} ${rank < step ? "" : "later"}` });
    });
    all.forEach((part, rank) => {
      plane.line(...part.corners, { class: `facet ${colour(part.facet)} ${rank < step ? "" : "later"} ${rank === step - 1 ? "now" : ""}` });
      plane.badge(between(...part.corners), rank + 1, { class: `${colour(part.facet)} ${rank < step ? "" : "later"}` });
    });
    strip(eye, all.slice(0, step));
    const rank = new Map(state.order.map((number, place) => [number, place + 1]));
    const root = (number) => {
      if (number === null) return { leaf: true };
      const node = view.nodes[number];
      const near = state.sides[number] > 0 ? 1 : 0;
      const children = node.children.map((child, k) => ({ ...root(child), edge: k === near ? "near" : "far" }));
      const last = all[step - 1];
      return { name: rank.get(number), look: `${colour(node.pivot)} ${last && last.node === number ? "now" : ""}`, note: `s${node.pivot + 1}`, children };
    };
    tree.show(root(0), `painter's order ${state.order.map((number) => view.nodes[number].pivot + 1).join(", ")}`);
  }

  function renew() {
    using(scene.partition(), (p) => {
      state.view = treeOf(p, scene.order);
      [state.order, state.sides] = JSON.parse(p.order(...state.eye, 0));
    });
    const count = fragments().length;
    stepper.reset(count, stepper.count ? Math.min(stepper.at + (stepper.at === stepper.count ? count : 0), count) : count);
  }

  scene.set(randomSegments(6, ...ROOM, 23, { longest: 170 }));
  plane.handle("The eye", state.eye, (to) => {
    state.eye = to;
    renew();
    return to;
  }, "eye");
  const random = randomOf(8);
  button(figure.querySelector(".buttons"), "another order", () => {
    scene.order = shuffled(scene.order, random);
    renew();
  });
}

/** The view of the eye all around, painted stroke by stroke: directions from west over north and east. */
function filmStrip(host) {
  const [width, height] = [420, 34];
  const strip = drawn("svg", { viewBox: `0 0 ${width} ${height + 18}`, class: "strip", role: "img", "aria-label": "What the eye sees all around" });
  host.append(strip);
  const across = (angle) => ((Math.PI - angle) / (2 * Math.PI)) * width;
  return (eye, parts) => {
    strip.replaceChildren(drawn("rect", { width, height, class: "sky" }));
    const angle = (p) => Math.atan2(p[1] - eye[1], p[0] - eye[0]);
    for (const { corners, facet } of parts) {
      let [from, to] = corners.map(angle).map(across).sort((a, b) => a - b);
      const spans = to - from > width / 2 ? [[0, from], [to, width]] : [[from, to]];
      for (const [left, right] of spans) {
        strip.append(drawn("rect", { x: left, y: 3, width: Math.max(right - left, 0.5), height: height - 6, class: `stroke ${colour(facet)}` }));
      }
    }
    ["west", "north", "east", "south", "west"].forEach((name, k) => {
      const anchor = ["start", "middle", "middle", "middle", "end"][k];
      strip.append(drawn("text", { x: (k * width) / 4, y: height + 13, class: "axis-name", style: `text-anchor:${anchor}` }, name));
    });
  };
}
