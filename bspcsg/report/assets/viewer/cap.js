// The lid on a solid where the section cuts it.

import {
  AlwaysStencilFunc, BackSide, Color, DecrementWrapStencilOp, DoubleSide, FrontSide, Group,
  IncrementWrapStencilOp, Mesh, MeshBasicMaterial, NotEqualStencilFunc, PlaneGeometry,
  ReplaceStencilOp,
} from "three";

// Of a lid, against the colour of its layer.
const SHADE = 0.8;

/** The cut is inside the solid where more back faces than front faces lie behind it. */
export class Cap {
  constructor(layer) {
    this.layer = layer;
    this.counters = [];
    this.group = new Group();
    this.group.visible = false;
    for (const [side, operation] of
      [[BackSide, IncrementWrapStencilOp], [FrontSide, DecrementWrapStencilOp]]) {
      this.counters.push(this.counter(side, operation));
    }
    this.lid = this.madeLid();
    this.group.add(...this.counters, this.lid);
    layer.group.add(this.group);
  }

  counter(side, operation) {
    const mesh = new Mesh(this.layer.fine.geometry, new MeshBasicMaterial({
      side, depthWrite: false, depthTest: false, colorWrite: false, stencilWrite: true,
      stencilFunc: AlwaysStencilFunc, stencilFail: operation, stencilZFail: operation,
      stencilZPass: operation, clippingPlanes: [this.layer.plane],
    }));
    mesh.renderOrder = 3 * this.layer.order;
    mesh.raycast = () => {};
    return mesh;
  }

  madeLid() {
    const { order, given } = this.layer;
    const lid = new Mesh(new PlaneGeometry(16, 16), new MeshBasicMaterial({
      color: new Color(given.colour).multiplyScalar(SHADE), side: DoubleSide,
      stencilWrite: true, stencilRef: 0,
      stencilFunc: NotEqualStencilFunc, stencilFail: ReplaceStencilOp,
      stencilZFail: ReplaceStencilOp, stencilZPass: ReplaceStencilOp,
      polygonOffset: true, polygonOffsetFactor: 0, polygonOffsetUnits: -2 * order,
    }));
    lid.renderOrder = 3 * order + 1;
    lid.onAfterRender = (renderer) => renderer.clearStencil();
    lid.raycast = () => {};
    return lid;
  }

  fade(opacity) {
    const transparent = opacity < 1;
    for (const { material } of [...this.counters, this.lid]) {
      material.needsUpdate ||= material.transparent !== transparent;
      material.transparent = transparent;
    }
    this.lid.material.opacity = opacity;
  }

  /** Count the faces of this geometry. */
  use(geometry) {
    for (const counter of this.counters) counter.geometry = geometry;
  }

  /** Lie in the plane of the section, or be gone. */
  place(active) {
    this.group.visible = active;
    const { plane, group } = this.layer;
    plane.coplanarPoint(this.lid.position).sub(group.position);
    this.lid.lookAt(this.lid.getWorldPosition(this.lid.position.clone()).sub(plane.normal));
  }
}
