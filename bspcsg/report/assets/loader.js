// Unpacks the viewer, gzip in base64, and opens a view where the page has a model.
"use strict";

const bspcsgViews = (() => {
  // Browsers keep about sixteen drawing contexts a page alive; a few are enough to compare.
  const MOST_OPEN = 4;
  // In a notebook the viewer may come from a cell that is not there.
  const PATIENCE = 5000;
  const WAITS = "To turn this, run the first cell that shows a solid: it holds the viewer for all.";
  const opened = [];
  let bundle = null;

  async function unpacked(base64) {
    const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  /** The viewer of this page, or, in a notebook, that which a cell holds for all. */
  function packedViewer() {
    const { textContent, dataset: { ask } } = document.getElementById("bspcsg-viewer");
    if (!ask) return textContent.trim();
    return new Promise((resolve) => {
      addEventListener("message", ({ source, data }) => {
        if (source === parent && typeof data?.[ask] === "string") resolve(data[ask]);
      });
      parent.postMessage(ask, "*");
    });
  }

  function viewer() {
    bundle ??= (async () => {
      const code = await unpacked(await packedViewer());
      const script = document.createElement("script");
      script.textContent = new TextDecoder().decode(code);
      document.head.append(script);
      return bspcsgViewer;
    })();
    return bundle;
  }

  function tell(host, sentence) {
    host.querySelector(".say")?.remove();
    const say = Object.assign(document.createElement("p"), {
      className: "say", textContent: sentence, role: "status",
    });
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
    const waiting = setTimeout(() => tell(host, WAITS), PATIENCE);
    try {
      const { open: start } = await viewer();
      clearTimeout(waiting);
      host.querySelector(".say")?.remove();
      const stage = Object.assign(document.createElement("div"), { className: "stage" });
      host.classList.add("open");
      host.prepend(stage);
      const entry = { host, stage };
      entry.shut = () => shut(entry);
      const text = document.getElementById(host.dataset.model).textContent;
      const close = closable ? entry.shut : null;
      entry.view = await start(stage, text, { title: host.dataset.title, close });
      stage.view = entry.view;
      stage.after(entry.view.bar);
      if (host.dataset.live) entry.view.remember(host.dataset.live);
      opened.push(entry);
      if (opened.length > MOST_OPEN) opened[0].shut();
      return entry.view;
    } catch (error) {
      clearTimeout(waiting);
      host.classList.remove("open");
      host.querySelector(".stage")?.remove();
      return tell(host, `The 3D view could not be opened: ${error.message}`);
    }
  }

  function shut(entry) {
    entry.view.close();
    entry.stage.remove();
    entry.view.bar.remove();
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
