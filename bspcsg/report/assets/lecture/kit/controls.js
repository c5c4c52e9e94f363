// Buttons, sliders and the stepper, which all work from the keyboard.
function button(host, label, act, looks = {}) {
  const made = element("button", { type: "button", ...looks }, label);
  made.addEventListener("click", () => act(made));
  host.append(made);
  return made;
}

function slider(host, label, { min, max, value, step = 1 }, act) {
  const input = element("input", { type: "range", min, max, step, value });
  const shown = element("output", {}, String(value));
  const row = element("label", { class: "slider" }, element("span", {}, label), input, shown);
  input.addEventListener("input", () => {
    shown.textContent = input.value;
    act(Number(input.value));
  });
  host.append(row);
  return {
    input,
    set(next) {
      input.value = next;
      shown.textContent = input.value;
    },
  };
}

function choice(host, label, options, act) {
  const group = element("div", { class: "choice", role: "radiogroup", "aria-label": label });
  const buttons = options.map(([value, words], index) => {
    const made = button(group, words, () => pick(index), { role: "radio", "aria-checked": String(index === 0), tabindex: index ? -1 : 0 });
    made.dataset.value = value;
    return made;
  });
  const pick = (index, focus = false) => {
    buttons.forEach((made, i) => {
      made.setAttribute("aria-checked", i === index);
      made.tabIndex = i === index ? 0 : -1;
    });
    if (focus) buttons[index].focus();
    act(options[index][0]);
  };
  group.addEventListener("keydown", (event) => {
    const way = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const now = buttons.findIndex((made) => made.getAttribute("aria-checked") === "true");
    pick((now + way + buttons.length) % buttons.length, true);
  });
  host.append(group);
  return group;
}

const icon = (shape, looks = {}) => drawn("svg", { viewBox: "0 0 20 20", class: "icon", "aria-hidden": "true", ...looks }, drawn("path", { d: shape }));

/** An icon of strokes: what moves by steps, apart from what plays. */
const strokes = (shape, looks = {}) => icon(shape, { class: "icon lines", ...looks });

/** Milliseconds between two steps that play by themselves. */
const PACE = 1100;

/** Steps from 0 to `count`; `show` is told the step, `describe` puts it into words. */
class Stepper {
  constructor(host, show, describe) {
    this.show = show;
    this.describe = describe;
    this.at = 0;
    this.count = 0;
    this.timer = null;
    const bar = element("div", { class: "stepper", role: "group", "aria-label": "Steps" });
    const press = (name, drawing, act, looks = {}) => button(bar, drawing, act, { "aria-label": name, title: name, ...looks });
    press("First step", strokes("M5 4v12M15 4l-6 6 6 6"), () => this.go(0));
    press("Step back", strokes("M13 4l-6 6 6 6"), () => this.go(this.at - 1), { class: "back" });
    this.player = press("Play", icon("M6 3.5 16 10 6 16.5z", { "data-when": "still" }), () => this.play(), { "aria-pressed": false, class: "player" });
    this.player.append(strokes("M6.5 4v12M13.5 4v12", { "data-when": "playing" }));
    press("Step forward", strokes("M7 4l6 6-6 6"), () => this.go(this.at + 1), { class: "forward" });
    press("Last step", strokes("M15 4v12M5 4l6 6-6 6"), () => this.go(this.count));
    this.range = element("input", { type: "range", min: 0, max: 0, value: 0, "aria-label": "Step" });
    this.range.addEventListener("input", () => this.go(Number(this.range.value)));
    this.place = element("output", { class: "place" });
    bar.append(this.range, this.place);
    this.words = element("p", { class: "step-words", "aria-live": "polite" });
    host.append(bar, this.words);
  }

  /** Another number of steps; stays at the end if it was there. */
  reset(count, at = null) {
    const ended = this.at === this.count && this.count > 0;
    this.count = count;
    this.range.max = count;
    this.go(at ?? (ended ? count : Math.min(this.at, count)), true);
  }

  go(step, keep = false) {
    if (!keep) this.stop();
    this.at = clamp(step, 0, this.count);
    this.range.value = this.at;
    this.place.textContent = `${this.at} / ${this.count}`;
    this.show(this.at);
    this.words.innerHTML = this.describe(this.at);
  }

  play() {
    if (this.timer) return this.stop();
    if (this.at === this.count) this.go(0);
    this.player.setAttribute("aria-pressed", true);
    this.timer = setInterval(() => {
      this.go(this.at + 1, true);
      if (this.at === this.count) this.stop();
    }, PACE);
    return undefined;
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    this.player.setAttribute("aria-pressed", false);
  }
}

/** Tiles with a name and a figure each. */
function tiles(host, names) {
  const list = element("dl", { class: "tiles" });
  const values = names.map(([key, words]) => {
    const value = element("dd", { "data-key": key }, "–");
    list.append(element("div", {}, element("dt", {}, words), value));
    return [key, value];
  });
  host.append(list);
  const byKey = Object.fromEntries(values);
  return (figures) => {
    for (const [key, value] of Object.entries(figures)) byKey[key].textContent = value;
  };
}

const rounded = (x, digits = 2) => Number(x).toLocaleString("en", { maximumFractionDigits: digits, minimumFractionDigits: digits }).replace("-", "−");
