// The meaning of the colours of a paint.

import { element } from "./dom.js";

// Labels above which the rest is counted only.
const MOST_LABELS = 24;

function number(value) {
  return String(Number(value.toPrecision(4)));
}

/** Labels that some face has, each once, whatever layers have it. */
function labelLegend(paints) {
  const seen = new Map();
  for (const { labels, colours, values } of paints) {
    const used = new Set(values);
    labels.forEach((label, index) => {
      if (used.has(index)) seen.set(`${label} ${colours[index]}`, [label, colours[index]]);
    });
  }
  const entries = [...seen.values()].slice(0, MOST_LABELS).map(([label, colour]) => {
    const swatch = element("span", { className: "swatch" });
    swatch.style.background = colour;
    return element("span", {}, swatch, label);
  });
  const more = seen.size - entries.length;
  return more ? [...entries, element("span", {}, `and ${more} more`)] : entries;
}

function scaleLegend({ name, stops, low, high, isCapped }, unit) {
  const bar = element("span", { className: "scale" });
  bar.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
  const end = `${isCapped ? "≥ " : ""}${number(high)}${unit && ` ${unit}`}`;
  return [element("span", {}, name), element("span", {}, number(low)), bar,
    element("span", {}, end)];
}

/** The entries for the paint that is on; nothing where colours speak for themselves. */
export function legendOf(view) {
  const on = view.model.layers.flatMap(({ paints }) => paints)
    .filter(({ name }) => name === view.settings.paint);
  const scale = on.find(({ kind }) => kind === "scale");
  if (scale) return scaleLegend(scale, view.model.unit);
  return labelLegend(on.filter(({ kind }) => kind === "labels"));
}
