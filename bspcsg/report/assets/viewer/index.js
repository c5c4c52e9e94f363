// The interactive view of one model. Bundled with three.js into viewer.js by scripts/viewer;
// loader.js says where it goes.

import { Controls } from "./controls.js";
import { modelOf } from "./unpacking.js";
import { View } from "./view.js";

/** Draw a model, JSON text, into an element; throws if the browser has no WebGL.
 *
 * Returns the view, whose `bar` is the element with its controls.
 */
export async function open(host, text, { title = "", close = null } = {}) {
  const view = new View(host, await modelOf(text));
  view.canvas.setAttribute("role", "application");
  const keys = "arrow keys turn, plus and minus zoom, Home resets; more keys below “more”";
  view.canvas.setAttribute("aria-label", `3D view of ${title}: ${keys}`);
  view.controls = new Controls(view, { title, close });
  view.bar = view.controls.bar;
  await view.dressed;
  return view;
}
