// The buttons, choices and sliders below the canvas.

import { button, choice, element, slider, toggle } from "./dom.js";
import { VIEWS } from "./eye.js";
import { legendOf } from "./legend.js";
import { KINDS } from "./measure.js";

const STEPS = 1000;

const KEYS = [
  ["drag, arrow keys", "turn"], ["wheel, pinch, + −", "zoom"],
  ["right drag, two fingers, Shift + arrow keys", "move"], ["1 … 7, Home", "usual sides"],
  ["P", "perspective or parallel"], ["E", "edges"], ["M", "measure"],
  ["Enter", "take the point in the middle"], ["Escape", "forget points"], ["S", "save a picture"],
];

const LINES = [["features", "edges"], ["all", "all edges"], ["wireframe", "wireframe"],
  ["none", "no edges"]];

export class Controls {
  constructor(view, { title, close }) {
    this.view = view;
    this.title = title;
    this.legend = element("div", { className: "legend" });
    this.told = element("output", { className: "told" });
    view.measure.onTell = (sentence) => this.tell(sentence);
    view.onKey = (event) => this.key(event);
    this.bar = element("div", { className: "tools" }, ...this.rows(close));
    view.host.append(this.told, this.legend);
    this.tell("");
    this.showLegend();
    this.followTheme();
  }

  rows(close) {
    const more = element("details", { className: "more" }, element("summary", {}, "more"),
      element("div", { className: "sheet" }, ...this.moreTools()));
    return [
      this.layerButtons(), this.paintChoice(), this.lineChoice(), this.sideChoice(),
      this.sectionTools(), this.measureChoice(), button("reset", () => this.reset()), more,
      this.places(), close && button("close", close, { className: "close" }),
    ].flat().filter(Boolean);
  }

  layerButtons() {
    const { layers } = this.view.model;
    const buttons = layers.map((layer, index) => {
      const swatch = element("span", { className: "swatch" });
      swatch.style.background = layer.colour;
      return toggle([swatch, layer.name], layer.shown, (on) => this.view.show(index, on));
    });
    return element("div", { className: "layers", role: "group", "aria-label": "Parts" }, ...buttons);
  }

  paintChoice() {
    const { paints, settings } = this.view;
    if (!paints.length) return null;
    const options = [["", "colour by part"], ...paints.map((name) => [name, `colour by ${name}`])];
    return choice("Colours", options, settings.paint, (paint) => {
      this.view.dress({ paint });
      this.showLegend();
    });
  }

  showLegend() {
    this.legend.replaceChildren(...legendOf(this.view));
    this.legend.hidden = !this.legend.childElementCount;
  }

  lineChoice() {
    const act = (lines) => this.view.drawLines(lines);
    this.lines = choice("Edges", LINES, this.view.settings.lines, act);
    return this.lines;
  }

  sideChoice() {
    const names = [["", "view from …"], ...Object.keys(VIEWS).map((name) => [name, name])];
    const made = choice("View from", names, "", (name) => {
      if (name) this.view.look(name);
      made.value = "";
    });
    this.parallel = toggle("parallel", false, (on) => this.view.project(on));
    return [made, this.parallel];
  }

  sectionTools() {
    const given = this.view.settings.section;
    const { model } = this.view;
    const axes = choice("Section", [["-1", "no section"], ...["x", "y", "z"].map((axis, index) => (
      [String(index), `section ${axis}`]))], "-1", () => act());
    const range = element("input", { type: "range", min: 0, max: STEPS, value: STEPS / 2,
      "aria-label": "Place of the section" });
    const place = element("output");
    const flip = toggle("flip", false, (flipped) => this.view.section({
      ...this.view.settings.section, flipped }));
    const act = () => {
      const axis = Number(axes.value);
      range.hidden = place.hidden = flip.hidden = axis < 0;
      const flipped = flip.getAttribute("aria-pressed") === "true";
      this.view.section({ axis, share: range.value / STEPS, flipped });
      if (axis < 0) return;
      const value = Number(this.view.sectionPlace().toPrecision(5));
      place.textContent = `${value}${model.unit && ` ${model.unit}`}`;
      range.setAttribute("aria-valuetext", place.textContent);
    };
    range.addEventListener("input", act);
    range.hidden = place.hidden = flip.hidden = given.axis < 0;
    return [axes, range, place, flip];
  }

  measureChoice() {
    const names = [["", "measure …"], ...Object.keys(KINDS).map((kind) => [kind, kind])];
    const act = (kind) => this.view.measure.start(kind || null);
    this.measure = choice("Measure", names, "", act);
    return this.measure;
  }

  moreTools() {
    const { view } = this;
    const tools = [
      slider("smooth up to", { min: 0, max: 180, step: 1, value: view.settings.crease },
        (value) => `${value}°`, (crease) => this.later(() => view.dress({ crease }))),
      slider("opacity", { min: 5, max: 100, step: 1, value: 100 },
        (value) => `${value} %`, (value) => view.fade(value / 100)),
    ];
    if (view.layers.length > 1) {
      tools.push(slider("explode", { min: 0, max: 100, step: 1, value: 0 },
        (value) => `${value} %`, (value) => view.explode(value / 50)));
    }
    this.dark = toggle("dark canvas", false, (on) => this.stand(on, true));
    const keys = element("dl", { className: "keys" }, ...KEYS.flatMap(([key, what]) => (
      [element("dt", {}, key), element("dd", {}, what)])));
    return [...tools, this.dark, button("save picture", () => this.save()), keys];
  }

  /** Places that somebody may want to see, such as what a check has found. */
  places() {
    const { places } = this.view.model;
    if (!places?.length) return null;
    const made = choice("Places", [["", "go to …"],
      ...places.map(({ name }, index) => [String(index), name])], "", (index) => {
      if (index !== "") this.view.visit(places[index]);
    });
    made.className = "places";
    return made;
  }

  later(act) {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(act, 60);
  }

  tell(sentence) {
    this.told.textContent = sentence;
    this.told.hidden = !sentence;
  }

  reset() {
    if (this.measure.value) {
      this.measure.value = "";
      this.view.measure.start(null);
    }
    this.view.home();
  }

  /** The canvas is as dark as the page, until somebody chooses. */
  followTheme() {
    const theme = matchMedia("(prefers-color-scheme: dark)");
    this.stand(theme.matches, false);
    theme.addEventListener("change", () => {
      if (!this.hasChosen) this.stand(theme.matches, false);
    });
  }

  stand(onDark, chosen) {
    this.hasChosen ||= chosen;
    this.dark.setAttribute("aria-pressed", onDark);
    this.view.host.classList.toggle("on-dark", onDark);
    this.view.stand(onDark);
  }

  async save() {
    const ground = getComputedStyle(this.view.host).backgroundColor;
    const address = URL.createObjectURL(await this.view.picture(ground));
    const name = this.title.replace(/[^\p{L}\p{N}._-]+/gu, "-").slice(0, 80) || "view";
    const link = element("a", { href: address, download: `${name}.png` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
  }

  key(event) {
    const next = (select) => {
      select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
      select.dispatchEvent(new Event("change"));
    };
    const acts = {
      p: () => this.parallel.click(), e: () => next(this.lines), m: () => next(this.measure),
      s: () => this.save(),
    };
    const act = acts[event.key.toLowerCase()];
    act?.();
    return Boolean(act);
  }
}
