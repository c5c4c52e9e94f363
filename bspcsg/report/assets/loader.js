// Unpacks models and the viewer, both gzip in base64, and gives each view its buttons.
"use strict";

const bspcsgViews = (() => {
  // Browsers keep about sixteen drawing contexts a page alive; a few are enough to compare.
  const MOST_OPEN = 4;
  const STEPS = 1000;
  const opened = [];
  let bundle = null;

  async function unpacked(base64) {
    const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  function viewer() {
    bundle ??= (async () => {
      const code = await unpacked(document.getElementById("bspcsg-viewer").textContent.trim());
      const script = document.createElement("script");
      script.textContent = new TextDecoder().decode(code);
      document.head.append(script);
      return bspcsgViewer;
    })();
    return bundle;
  }

  /** Bytes as numbers: all first bytes come first, then all second bytes, and so on. */
  function joined(bytes, at, count, width) {
    const numbers = new Uint8Array(count * width);
    for (let plane = 0; plane < width; plane += 1) {
      for (let i = 0; i < count; i += 1) numbers[i * width + plane] = bytes[at + plane * count + i];
    }
    return numbers.buffer;
  }

  function positionsOf(bytes, at, count, { quantised, step }) {
    const positions = new Float32Array(3 * count);
    if (!quantised) {
      const planar = new Float32Array(joined(bytes, at, 3 * count, 4));
      planar.forEach((value, i) => { positions[3 * (i % count) + Math.floor(i / count)] = value; });
      return positions;
    }
    const planar = new Uint16Array(joined(bytes, at, 3 * count, 2));
    for (let axis = 0; axis < 3; axis += 1) {
      let last = 0;
      for (let i = 0; i < count; i += 1) {
        last = (last + planar[axis * count + i]) & 0xffff;
        positions[3 * i + axis] = (last - 32767.5) * step[axis];
      }
    }
    return positions;
  }

  function indicesOf(bytes, at, count) {
    const indices = new Uint32Array(joined(bytes, at, count, 4));
    let last = 0;
    for (let i = 0; i < count; i += 1) {
      last += (indices[i] >>> 1) ^ -(indices[i] & 1);
      indices[i] = last;
    }
    return indices;
  }

  async function modelOf(id) {
    const model = JSON.parse(document.getElementById(id).textContent);
    const bytes = await unpacked(model.data);
    let at = 0;
    for (const layer of model.layers) {
      layer.positions = positionsOf(bytes, at, layer.vertices, model);
      at += 3 * layer.vertices * (model.quantised ? 2 : 4);
      layer.indices = indicesOf(bytes, at, 3 * layer.triangles);
      at += 12 * layer.triangles;
    }
    return model;
  }

  function element(tag, looks, ...children) {
    const made = Object.assign(document.createElement(tag), looks);
    made.append(...children);
    return made;
  }

  function toggle(label, pressed, act) {
    const button = element("button", { type: "button" }, ...label);
    const set = (on) => {
      button.setAttribute("aria-pressed", on);
      act(on);
    };
    button.setAttribute("aria-pressed", pressed);
    button.addEventListener("click", () => set(button.getAttribute("aria-pressed") !== "true"));
    return button;
  }

  function layerButtons(view, model) {
    return model.layers.map((layer, index) => {
      const swatch = element("span", { className: "swatch" });
      swatch.style.background = layer.colour;
      const act = (on) => view.show(index, on);
      return toggle([swatch, layer.name], layer.shown, act);
    });
  }

  function sectionTools(view, model) {
    const axes = element("select", {}, ...["no section", "section x", "section y", "section z"]
      .map((name, index) => element("option", { value: index - 1 }, name)));
    axes.setAttribute("aria-label", "Section");
    const slider = element("input", { type: "range", min: 0, max: STEPS, value: STEPS / 2 });
    slider.setAttribute("aria-label", "Place of the section");
    const place = element("output");
    slider.hidden = place.hidden = true;
    const act = () => {
      const axis = Number(axes.value);
      slider.hidden = place.hidden = axis < 0;
      if (axis < 0) return view.section(null);
      const share = slider.value / STEPS - 0.5;
      const side = model.high[axis] - model.low[axis];
      const value = model.low[axis] + (share + 0.5) * side;
      place.textContent = `${Number(value.toPrecision(5))}${model.unit && ` ${model.unit}`}`;
      slider.setAttribute("aria-valuetext", place.textContent);
      return view.section(axis, (share * 2 * side) / model.longest);
    };
    axes.addEventListener("change", act);
    slider.addEventListener("input", act);
    return [axes, slider, place];
  }

  function edgesButton(view) {
    const shown = view.drawsEdges;
    if (shown) view.edges(true);
    return toggle(["edges"], shown, (on) => view.edges(on));
  }

  function tools(view, model, close) {
    const reset = element("button", { type: "button" }, "reset");
    reset.addEventListener("click", () => view.home());
    const bar = element("div", { className: "tools" }, ...layerButtons(view, model),
      edgesButton(view), reset, ...sectionTools(view, model));
    if (close) {
      const button = element("button", { type: "button", className: "close" }, "close");
      button.addEventListener("click", close);
      bar.append(button);
    }
    return bar;
  }

  function tell(host, sentence) {
    host.querySelector(".say")?.remove();
    const say = element("p", { className: "say" }, sentence);
    say.setAttribute("role", "status");
    host.append(say);
  }

  function webgl() {
    const context = document.createElement("canvas").getContext("webgl2");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  }

  function obstacle() {
    if (typeof DecompressionStream === "undefined") {
      return "This browser cannot unpack the model (it has no DecompressionStream).";
    }
    return webgl() ? "" : "This browser has WebGL turned off, so there is only the picture.";
  }

  /** Open the view of an element with data-model; what was in it stays if that fails. */
  async function open(host, closable) {
    const reason = obstacle();
    if (reason) return tell(host, reason);
    try {
      const [{ open: start }, model] = await Promise.all([viewer(), modelOf(host.dataset.model)]);
      const stage = element("div", { className: "stage" });
      host.classList.add("open");
      host.prepend(stage);
      const view = start(stage, model);
      view.canvas.setAttribute("role", "application");
      const keys = "drag or arrow keys turn, wheel or + and - zoom, Home resets";
      view.canvas.setAttribute("aria-label", `3D view of ${host.dataset.title}: ${keys}`);
      const entry = { host, shut: () => shut(entry, view, stage) };
      const bar = tools(view, model, closable ? entry.shut : null);
      entry.bar = bar;
      stage.after(bar);
      opened.push(entry);
      if (opened.length > MOST_OPEN) opened[0].shut();
      return view;
    } catch (error) {
      host.classList.remove("open");
      host.querySelector(".stage")?.remove();
      return tell(host, `The 3D view could not be opened: ${error.message}`);
    }
  }

  function shut(entry, view, stage) {
    view.close();
    stage.remove();
    entry.bar.remove();
    entry.host.classList.remove("open");
    opened.splice(opened.indexOf(entry), 1);
    entry.host.querySelector("button")?.focus({ preventScroll: true });
  }

  for (const host of document.querySelectorAll("[data-model]")) {
    const button = host.querySelector("button.opener");
    if (button) button.addEventListener("click", () => open(host, true));
    else open(host, false);
  }
  return { open };
})();
