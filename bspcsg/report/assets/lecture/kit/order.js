// The order in which facets become pivots, as chips.
class Order {
  constructor(host, label, changed) {
    this.changed = changed;
    this.order = [];
    this.list = element("div", { class: "order", role: "group", "aria-label": `${label}: press a chip to move it to the front, arrow keys move it by one` });
    host.append(this.list);
  }

  set(order) {
    this.order = order.slice();
    this.list.replaceChildren(...this.order.map((facet) => this.chip(facet)));
  }

  chip(facet) {
    const made = element("button", { type: "button", class: `chip ${colour(facet)}`, "data-facet": facet, "aria-label": `segment ${facet + 1}` }, String(facet + 1));
    made.addEventListener("click", () => this.move(facet, -this.order.length));
    made.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!way) return;
      event.preventDefault();
      this.move(facet, way);
    });
    return made;
  }

  move(facet, way) {
    const from = this.order.indexOf(facet);
    const to = clamp(from + way, 0, this.order.length - 1);
    const order = this.order.filter((other) => other !== facet);
    order.splice(to, 0, facet);
    this.set(order);
    this.list.querySelector(`[data-facet="${facet}"]`).focus({ preventScroll: true });
    this.changed(order);
  }

  /** Mark the facets that have had their turn. */
  mark(done) {
    for (const chip of this.list.children) chip.classList.toggle("done", done.has(Number(chip.dataset.facet)));
  }
}
