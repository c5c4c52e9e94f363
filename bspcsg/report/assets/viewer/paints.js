// Ways to colour the faces of a layer: labels, scales, colours of the mesh's own, textures.

import { Color, LinearMipmapLinearFilter, RepeatWrapping, SRGBColorSpace, Texture } from "three";
import { bytesOf } from "./unpacking.js";

// The colour where a scale has no value.
const UNKNOWN = "#9aa2ab";

const FULL = 65535;

// Colours of the screen, 0 to 255, as light, 0 to 65535.
const LIGHT = Uint16Array.from({ length: 256 }, (_, value) => {
  const c = value / 255;
  return Math.round(FULL * (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
});

function lightOf(colour) {
  const { r, g, b } = new Color(colour.slice(0, 7));
  const opacity = colour.length > 7 ? parseInt(colour.slice(7, 9), 16) / 255 : 1;
  return [r, g, b, opacity].map((value) => Math.round(FULL * value));
}

/** The light of each number from 0 (unknown) to 65535 on a scale. */
function scaleLight({ stops }) {
  const lights = stops.map(lightOf);
  const steps = Array.from({ length: 257 }, (_, step) => {
    const place = (step / 256) * (lights.length - 1);
    const from = Math.min(Math.floor(place), lights.length - 2);
    return lights[from].map((value, i) => (
      Math.round(value + (place - from) * (lights[from + 1][i] - value))));
  });
  const unknown = lightOf(UNKNOWN);
  return (value) => (value === 0 ? unknown : steps[Math.round(((value - 1) / (FULL - 1)) * 256)]);
}

/** Light of all corners of some faces, four numbers each. */
export function cornerLight(paint, faces) {
  const light = new Uint16Array(12 * faces.length);
  const labels = paint.kind === "labels" ? paint.colours.map(lightOf) : null;
  const ofScale = paint.kind === "scale" ? scaleLight(paint) : null;
  const width = paint.at === "face" ? 0 : 1;
  for (let i = 0; i < 3 * faces.length; i += 1) {
    const face = faces[Math.floor(i / 3)];
    const value = width ? 3 * face + (i % 3) : face;
    if (labels) light.set(labels[paint.values[value]], 4 * i);
    else if (ofScale) light.set(ofScale(paint.values[value]), 4 * i);
    else {
      for (let c = 0; c < 3; c += 1) light[4 * i + c] = LIGHT[paint.values[4 * value + c]];
      light[4 * i + 3] = paint.values[4 * value + 3] * 257;
    }
  }
  return light;
}

/** Return whether something behind the faces is seen through them. */
export function isSeeThrough(paint) {
  if (paint.kind === "labels") return paint.colours.some((c) => c.length > 7 && !c.endsWith("ff"));
  return paint.kind === "colours" && paint.values.some((value, i) => i % 4 === 3 && value < 255);
}

/** The pictures of a paint as textures, null for labels that have none. */
export async function texturesOf(paint) {
  paint.textures ??= await Promise.all(paint.images.map(async (image) => {
    if (!image) return null;
    const blob = new Blob([bytesOf(image)]);
    const bitmap = await createImageBitmap(blob, { imageOrientation: "flipY" });
    const texture = new Texture(bitmap);
    Object.assign(texture, {
      flipY: false, colorSpace: SRGBColorSpace, wrapS: RepeatWrapping, wrapT: RepeatWrapping,
      minFilter: LinearMipmapLinearFilter, anisotropy: 4, needsUpdate: true,
    });
    return texture;
  }));
  return paint.textures;
}
