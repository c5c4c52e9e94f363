// Chapter 1: a hyperplane has two sides; many of them on a line are a search tree.
function hyperplaneFigure(figure) {
  const size = [420, 300];
  const plane = new Plane(figure.querySelector(".room-pane"), "A line and a point", ...size);
  const tell = tiles(figure.querySelector(".read"), [["n", "normal n"], ["d", "offset d"], ["value", "n·x + d"], ["side", "side of x"]]);
  const ends = [[110, 60], [330, 215]];
  let point = [236, 262];

  function show() {
    const room = [[0, 0], size];
    const partition = autopartition(2, [ends], [0], room);
    const [view, sides] = using(partition, (p) => [treeOf(p, [0]), JSON.parse(p.order(...point, 0))[1]]);
    const { halves, span, hyperplane } = view.nodes[0];
    plane.clear();
    plane.region(halves[0], { class: "half minus" });
    plane.region(halves[1], { class: "half plus" });
    plane.span(span, { class: "cut now" });
    halves.forEach((half, k) => plane.text(centre(outline(half)), k ? "H⁺" : "H⁻", { class: "big-name" }));
    const from = centre(ends);
    const [a, b, , d] = hyperplane;
    plane.line(from, [from[0] + a * 42, from[1] + b * 42], { class: "arrow", "marker-end": "url(#arrow-head)" });
    plane.text([from[0] + a * 54, from[1] + b * 54], "n", { class: "small-name" });
    const foot = a * point[0] + b * point[1] + d;
    plane.line(point, [point[0] - a * foot, point[1] - b * foot], { class: "dashed" });
    plane.text([point[0], point[1] + 16], "x", { class: "small-name" });
    const name = { "-1": "minus: inside H⁻", 0: "on the hyperplane", 1: "plus: inside H⁺" }[sides[0]];
    tell({ n: `(${rounded(a)}, ${rounded(b)})`, d: rounded(d, 1), value: rounded(foot, 1), side: name });
  }

  ends.forEach((end, k) => plane.handle(`${k ? "Second" : "First"} point of the line`, end, (to) => {
    if (to[0] === ends[1 - k][0] && to[1] === ends[1 - k][1]) return ends[k];
    ends[k] = to;
    show();
    return to;
  }));
  plane.handle("The point x", point, (to) => {
    point = to;
    show();
    return to;
  }, "eye");
  show();
}

function searchFigure(figure) {
  const [width, height] = [420, 96];
  const middle = 52;
  const plane = new Plane(figure.querySelector(".room-pane"), "Points on a line", width, height);
  const tree = new TreePicture(figure.querySelector(".tree-pane"), "The tree of the points");
  const tell = tiles(figure.querySelector(".read"), [["steps", "cuts asked"], ["depth", "depth of the tree"], ["interval", "region of x"]]);
  const chips = new Order(figure.querySelector(".order-pane"), "Order of the points", (order) => {
    state.order = order;
    show();
  });
  const state = { points: [62, 118, 176, 214, 270, 322, 372], order: [3, 1, 5, 0, 2, 4, 6], asked: 243 };

  function rooted(view, sides, number, region, onPath) {
    if (number === null) {
      if (onPath) state.region = region;
      return { leaf: true, look: onPath ? "hit" : "" };
    }
    const node = view.nodes[number];
    const at = state.points[node.pivot];
    const way = sides[number] > 0 ? 1 : 0;
    if (onPath) state.steps += 1;
    const child = (k) => {
      const on = onPath && k === way;
      const part = k ? [at, region[1]] : [region[0], at];
      return { ...rooted(view, sides, node.children[k], part, on), edge: on ? "hit" : "" };
    };
    return { name: node.pivot + 1, look: `${colour(node.pivot)} ${onPath ? "hit" : ""}`, children: [child(0), child(1)] };
  }

  function show() {
    const partition = autopartition(1, state.points.map((x) => [[x]]), state.order, [[0], [width]]);
    const [view, sides] = using(partition, (p) => [treeOf(p, state.order), JSON.parse(p.order(state.asked, 0, 0))[1]]);
    state.steps = 0;
    const root = rooted(view, sides, 0, [0, width], true);
    plane.clear();
    plane.line([state.region[0], middle], [state.region[1], middle], { class: "band" });
    plane.line([0, middle], [width, middle], { class: "axis" });
    state.points.forEach((x, i) => {
      plane.line([x, middle - 13], [x, middle + 13], { class: `facet ${colour(i)}` });
      plane.text([x, 18], i + 1, { class: "small-name" });
    });
    plane.text([state.asked, middle + 26], "x", { class: "small-name" });
    tree.show(root, `depth ${view.depth}`);
    chips.set(state.order);
    tell({ steps: state.steps, depth: view.depth, interval: `${state.region[0]} … ${state.region[1]}` });
  }

  state.points.forEach((x, i) => plane.handle(`Point ${i + 1}`, [x, middle], ([to]) => {
    if (state.points.some((other, j) => j !== i && Math.abs(other - to) < 2)) return [state.points[i], middle];
    state.points[i] = to;
    show();
    return [to, middle];
  }));
  plane.handle("The point x that is looked for", [state.asked, middle], ([to]) => {
    state.asked = to;
    show();
    return [to, middle];
  }, "eye");
  const buttons = figure.querySelector(".buttons");
  const byPlace = (order) => order.sort((i, j) => state.points[i] - state.points[j]);
  button(buttons, "middle first", () => {
    const sorted = byPlace(state.order.slice());
    const halving = (list) => (list.length ? [list[list.length >> 1], ...halving(list.slice(0, list.length >> 1)), ...halving(list.slice((list.length >> 1) + 1))] : []);
    state.order = halving(sorted);
    show();
  });
  button(buttons, "left to right", () => {
    state.order = byPlace(state.order.slice());
    show();
  });
  show();
}
