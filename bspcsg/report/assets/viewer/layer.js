// One layer as it is drawn: faces, edges, and the cap where the section cuts it.

import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, FrontSide, Group, LineBasicMaterial,
  LineSegments, Mesh, MeshLambertMaterial, Vector3,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { Cap } from "./cap.js";
import { roughened } from "./detail.js";
import { cornerLight, isSeeThrough, texturesOf } from "./paints.js";
import { Surface } from "./topology.js";

// Triangles of all rough layers together, which stand for fine ones while the view moves.
const MOST_ROUGH = 20_000;

const INK = { light: 0x1a1c20, dark: 0xc9d1da };

// Opacity of edges without faces.
const WIRE = 0.45;

// Of lines that mark places, in pixels.
const LINE_WIDTH = 3;

function geometryOf({ positions, indices, normals }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  if (indices) geometry.setIndex(new BufferAttribute(indices, 1));
  if (normals) geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  return geometry;
}

/** The values of vertices, three each, at the corners of some faces. */
function atCorners(values, indices, faces) {
  const found = new Float32Array(9 * faces.length);
  for (let i = 0; i < 3 * faces.length; i += 1) {
    const from = 3 * indices[3 * faces[Math.floor(i / 3)] + (i % 3)];
    for (let axis = 0; axis < 3; axis += 1) found[3 * i + axis] = values[from + axis];
  }
  return found;
}

/** All faces, those with the same label together; and where each label begins. */
function byLabel(paint) {
  const faces = Uint32Array.from(paint.values.keys());
  faces.sort((a, b) => paint.values[a] - paint.values[b] || a - b);
  const groups = [];
  faces.forEach((face, at) => {
    const label = paint.values[face];
    const last = groups.at(-1);
    if (last?.label === label) last.count += 3;
    else groups.push({ label, start: 3 * at, count: 3 });
  });
  return { faces, groups };
}

export class Layer {
  constructor(given, order, count, plane) {
    this.given = given;
    this.plane = plane;
    this.surface = new Surface(given);
    this.order = order;
    this.offset = 4 * (count - order);
    this.group = new Group();
    this.group.visible = given.shown;
    this.opacity = 1;
    this.isCut = false;
    // Of the triangles of the whole model.
    this.share = 1;
    this.fine = new Mesh(geometryOf(given), this.material({}));
    this.fine.renderOrder = 100 + order;
    this.group.add(this.fine);
    this.rough = null;
    this.cap = given.closed && given.triangles ? new Cap(this) : null;
    if (given.segments) this.group.add(this.marks());
    this.middle = this.center();
  }

  get triangles() {
    return this.given.triangles;
  }

  get mostRough() {
    return MOST_ROUGH * this.share;
  }

  center() {
    const { positions } = this.given;
    const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-1, -1, -1)
      .multiplyScalar(Infinity)];
    const point = new Vector3();
    for (let at = 0; at < positions.length; at += 3) {
      point.fromArray(positions, at);
      low.min(point);
      high.max(point);
    }
    return positions.length ? low.add(high).multiplyScalar(0.5) : new Vector3();
  }

  material(looks) {
    // The later of two layers is seen where they touch; edges are in front of all.
    const offset = { polygonOffset: true, polygonOffsetFactor: this.offset / 4,
      polygonOffsetUnits: this.offset };
    return new MeshLambertMaterial({
      color: this.given.colour, side: DoubleSide, flatShading: true, ...offset, ...looks,
    });
  }

  /** Lines that mark places, in front of all that hides them, too, but faintly. */
  marks() {
    const { positions, lines } = this.given;
    const points = new Float32Array(3 * lines.length);
    lines.forEach((vertex, i) => points.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
    const geometry = new LineSegmentsGeometry().setPositions(points);
    const both = new Group();
    for (const [depthTest, opacity] of [[false, 0.35], [true, 1]]) {
      const material = new LineMaterial({
        color: this.given.colour, linewidth: LINE_WIDTH, depthTest, opacity,
        transparent: opacity < 1,
      });
      const drawn = new LineSegments2(geometry, material);
      drawn.renderOrder = 300 + Number(depthTest);
      drawn.raycast = () => {};
      both.add(drawn);
    }
    return both;
  }

  /** Draw with normals that are smooth where faces bend by less than an angle, in degrees.
   *
   * In colours of a paint of the layer, or its own; textures come a moment later.
   */
  async dress(crease, paint) {
    this.crease = crease;
    this.paint = paint;
    const cosine = Math.cos((crease * Math.PI) / 180);
    const shaded = crease > 0 ? this.surface.shaded(cosine) : this.given;
    this.fine.geometry.dispose();
    if (paint) this.dressPainted(shaded, paint);
    else {
      this.fine.geometry = geometryOf(shaded);
      this.wear([this.material({ flatShading: crease === 0 })]);
    }
    this.forgetRough();
    if (paint?.images) this.hang(await texturesOf(paint));
  }

  dressPainted(shaded, paint) {
    const { faces, groups } = paint.images ? byLabel(paint)
      : { faces: Uint32Array.from({ length: this.triangles }, (_, face) => face), groups: [] };
    const geometry = geometryOf({
      positions: atCorners(shaded.positions, shaded.indices, faces),
      normals: shaded.normals && atCorners(shaded.normals, shaded.indices, faces),
    });
    const flatShading = !shaded.normals;
    if (paint.images) {
      const uv = new Float32Array(6 * faces.length);
      faces.forEach((face, at) => uv.set(paint.uv.subarray(6 * face, 6 * face + 6), 6 * at));
      geometry.setAttribute("uv", new BufferAttribute(uv, 2));
      groups.forEach(({ start, count }, index) => geometry.addGroup(start, count, index));
      this.wear(groups.map(({ label }) => {
        const colour = paint.colours[label];
        const opacity = colour.length > 7 ? parseInt(colour.slice(7, 9), 16) / 255 : 1;
        const made = this.material({ color: colour.slice(0, 7), flatShading });
        return Object.assign(made, { userData: { label, opacity } });
      }));
    } else {
      geometry.setAttribute("color", new BufferAttribute(cornerLight(paint, faces), 4, true));
      const made = this.material({ color: 0xffffff, vertexColors: true, flatShading });
      made.userData.opacity = isSeeThrough(paint) ? 0.999 : 1;
      this.wear([made]);
    }
    this.fine.geometry = geometry;
  }

  hang(textures) {
    for (const material of this.materials) {
      material.map = textures[material.userData.label] ?? null;
      material.needsUpdate = true;
    }
  }

  get materials() {
    return [this.fine.material].flat();
  }

  wear(materials) {
    for (const old of this.materials) old.dispose();
    this.fine.material = materials.length === 1 && !materials[0].userData.label
      && materials[0].userData.label !== 0 ? materials[0] : materials;
    this.fade(this.opacity);
    this.cut(this.isCut);
    this.drawLines(this.lines ?? "none");
  }

  /** Let what is behind be seen through the faces; 1 is what the model says. */
  fade(opacity) {
    this.opacity = opacity;
    for (const material of this.materials) {
      const own = material.userData.opacity ?? 1;
      this.fadeOne(material, own * this.given.opacity * opacity);
    }
    if (this.rough) this.fadeOne(this.rough.material, this.given.opacity * opacity);
    this.cap?.fade(this.given.opacity * opacity);
  }

  fadeOne(material, opacity) {
    const transparent = opacity < 1;
    material.needsUpdate ||= material.transparent !== transparent;
    Object.assign(material, { opacity, transparent, depthWrite: !transparent });
  }

  /** Draw "features", "all" edges, the edges alone ("wireframe"), or "none". */
  drawLines(kind) {
    this.lines = kind;
    const wanted = kind === "wireframe" ? "all" : kind;
    for (const material of this.materials) material.visible = kind !== "wireframe";
    if (this.edges?.kind !== wanted) this.replaceEdges(wanted);
    this.inkEdges();
  }

  replaceEdges(kind) {
    this.edges?.object.geometry.dispose();
    this.edges?.object.removeFromParent();
    this.edges = null;
    if (kind === "none" || !this.triangles) return;
    const cosine = Math.cos((Math.max(this.crease ?? 25, 1) * Math.PI) / 180);
    const pairs = kind === "all" ? this.surface.edges() : this.surface.features(cosine);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.given.positions, 3));
    geometry.setIndex(new BufferAttribute(Uint32Array.from(pairs), 1));
    const object = new LineSegments(geometry, new LineBasicMaterial({
      clippingPlanes: this.isCut ? [this.plane] : [],
    }));
    object.renderOrder = 200;
    object.raycast = () => {};
    this.group.add(object);
    this.edges = { kind, object };
  }

  /** Lines alone are pale, for there are many, and in the layer's colour, which any ground shows. */
  inkEdges() {
    if (!this.edges) return;
    const isAlone = this.lines === "wireframe";
    const own = new Color(this.given.colour);
    const alone = this.onDark ? own.lerp(new Color(INK.dark), 0.4) : own.multiplyScalar(0.45);
    const opacity = isAlone ? WIRE : Math.min(1, 0.4 + this.given.opacity / 2);
    const { material } = this.edges.object;
    material.color.set(isAlone ? alone : INK.light);
    Object.assign(material, { opacity, transparent: opacity < 1, needsUpdate: true });
  }

  /** Say what is behind the canvas. */
  stand(onDark) {
    this.onDark = onDark;
    this.inkEdges();
  }

  cut(active) {
    this.isCut = active;
    const meshes = [this.fine, this.rough, this.edges?.object].filter(Boolean);
    for (const material of meshes.flatMap((mesh) => mesh.material)) {
      material.clippingPlanes = active ? [this.plane] : [];
    }
    this.cap?.place(active);
  }

  /** Move away from the middle of the model. */
  explode(share) {
    this.group.position.copy(this.middle).multiplyScalar(share);
    if (this.isCut) this.cap?.place(true);
  }

  /** Draw a rough mesh, if the layer's own share of that is smaller than it, or the fine one. */
  hurry(isHurried) {
    const isRough = isHurried && this.lines !== "wireframe" && this.triangles > this.mostRough;
    if (isRough) this.rough ??= this.roughMesh();
    if (this.rough) this.rough.visible = isRough;
    this.fine.visible = !isRough;
    if (this.edges) this.edges.object.visible = !isRough;
    this.cap?.use((isRough ? this.rough : this.fine).geometry);
  }

  forgetRough() {
    this.rough?.geometry.dispose();
    this.rough?.removeFromParent();
    this.rough = null;
    this.cap?.use(this.fine.geometry);
  }

  roughMesh() {
    const made = roughened(this.given, this.mostRough);
    let geometry = geometryOf(made);
    const looks = { flatShading: false };
    if (this.paint) {
      const every = Uint32Array.from({ length: made.faces.length }, (_, face) => face);
      geometry = geometryOf({ positions: atCorners(made.positions, made.indices, every) });
      const light = cornerLight(this.paint, made.faces);
      geometry.setAttribute("color", new BufferAttribute(light, 4, true));
      Object.assign(looks, { color: 0xffffff, vertexColors: true, flatShading: true });
    } else geometry.computeVertexNormals();
    const mesh = new Mesh(geometry, this.material(looks));
    this.fadeOne(mesh.material, this.given.opacity * this.opacity);
    mesh.material.clippingPlanes = this.isCut ? [this.plane] : [];
    // The far sides of closed surfaces are hidden; not drawing them saves half of the work.
    if (this.given.closed && !this.isCut && !mesh.material.transparent) {
      mesh.material.side = FrontSide;
    }
    mesh.renderOrder = this.fine.renderOrder;
    mesh.raycast = () => {};
    this.group.add(mesh);
    return mesh;
  }
}
