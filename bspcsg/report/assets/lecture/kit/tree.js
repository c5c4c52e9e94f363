// Pictures of trees: leaves side by side, parents above the middle of their children.
const LEAF_WIDTH = 30;
const LEVEL = 46;

/**
 * A tree's picture. A node is { name, look, note, leaf, children, id }: `look` is its class, `note`
 * stands below it, `leaf` draws a square.
 */
class TreePicture {
  constructor(host, label, picked = null) {
    this.host = element("div", { class: "tree-scroll", tabindex: 0, role: "img", "aria-label": label });
    this.label = label;
    this.picked = picked;
    this.svg = drawn("svg", { class: "tree", "aria-hidden": "true" });
    this.host.append(this.svg);
    host.append(this.host);
  }

  show(root, words = "") {
    this.host.setAttribute("aria-label", `${this.label}. ${words}`);
    this.svg.replaceChildren();
    if (!root) return;
    const edges = drawn("g", { class: "edges" });
    const marks = drawn("g");
    const state = { next: 0, deepest: 0, edges, marks };
    this.place(root, 0, state);
    const width = Math.max(state.next, 1) * LEAF_WIDTH;
    const height = state.deepest * LEVEL + 56;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.style.maxWidth = `${Math.max(width * 1.5, 90)}px`;
    this.svg.style.minWidth = `${Math.round(width * 0.55)}px`;
    this.svg.append(edges, marks);
  }

  /** Lay out a subtree; return where its root is. */
  place(node, depth, state) {
    state.deepest = Math.max(state.deepest, depth);
    const y = depth * LEVEL + 22;
    const children = (node.children ?? []).filter(Boolean);
    const below = children.map((child) => [child, this.place(child, depth + 1, state)]);
    const x = below.length
      ? below.reduce((sum, [, at]) => sum + at, 0) / below.length
      : (state.next++ + 0.5) * LEAF_WIDTH;
    below.forEach(([child, at], index) => {
      const look = `edge ${child.edge ?? ""}`;
      state.edges.append(drawn("line", { x1: x, y1: y, x2: at, y2: y + LEVEL, class: look }));
      if (depth === 0 && below.length === 2) {
        const sign = drawn("text", { x: (x + at) / 2 + (index ? 9 : -9), y: y + LEVEL / 2, class: "sign" });
        sign.append(index ? "+" : "−");
        state.edges.append(sign);
      }
    });
    state.marks.append(this.mark(node, x, y));
    return x;
  }

  mark(node, x, y) {
    const mark = drawn("g", { class: `node ${node.leaf ? "leaf" : ""} ${node.look ?? ""}`, transform: `translate(${x} ${y})` });
    mark.append(
      node.leaf
        ? drawn("rect", { x: -9, y: -9, width: 18, height: 18, rx: 4 })
        : drawn("circle", { r: 12 }),
    );
    if (node.name !== undefined) mark.append(drawn("text", {}, String(node.name)));
    if (node.note) mark.append(drawn("text", { y: 21, class: "note" }, String(node.note)));
    if (this.picked && node.id !== undefined) {
      mark.classList.add("pickable");
      mark.addEventListener("pointerenter", () => this.picked(node.id));
      mark.addEventListener("pointerdown", () => this.picked(node.id));
      mark.addEventListener("pointerleave", () => this.picked(null));
    }
    return mark;
  }
}
