// Elements of the page that controls are made of.

export function element(tag, looks = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(looks)) {
    if (name in made) made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

export function button(label, act, looks = {}) {
  const made = element("button", { type: "button", ...looks }, ...[label].flat());
  made.addEventListener("click", act);
  return made;
}

/** A button that is pressed or not. */
export function toggle(label, pressed, act) {
  const made = button(label, () => {
    const on = made.getAttribute("aria-pressed") !== "true";
    made.setAttribute("aria-pressed", on);
    act(on);
  });
  made.setAttribute("aria-pressed", pressed);
  return made;
}

/** A choice among names; `options` are pairs of value and text. */
export function choice(label, options, chosen, act) {
  const made = element("select", { "aria-label": label },
    ...options.map(([value, text]) => element("option", { value }, text)));
  made.value = chosen;
  made.addEventListener("change", () => act(made.value));
  return made;
}

/** A slider with its name before it; `tell` says what a value is called. */
export function slider(label, { min, max, step, value }, tell, act) {
  const input = element("input", { type: "range", min, max, step, value });
  const output = element("output");
  const say = () => {
    output.textContent = tell(Number(input.value));
    input.setAttribute("aria-valuetext", output.textContent);
  };
  input.addEventListener("input", () => {
    act(Number(input.value));
    say();
  });
  say();
  return element("label", { className: "slider" }, element("span", {}, label), input, output);
}
