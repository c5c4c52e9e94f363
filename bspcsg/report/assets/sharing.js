// Hands the viewer to the frames of a notebook that ask for it, and to those that asked before.
"use strict";

(() => {
  const name = "VIEWER_NAME";
  const answer = { [name]: "VIEWER_CODE" };
  if (window[name]) return;
  window[name] = true;
  window.addEventListener("message", (event) => {
    if (event.data === name) event.source.postMessage(answer, "*");
  });
  for (const frame of document.querySelectorAll("iframe.bspcsg")) {
    frame.contentWindow?.postMessage(answer, "*");
  }
})();
