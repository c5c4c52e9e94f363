// The canvas: drawn with several samples a pixel, or with one where that is too slow.

import { SRGBColorSpace, WebGLRenderer, WebGLRenderTarget } from "three";

const SAMPLES = 4;

// Beyond this many triangles, pixels of half the size are quicker than several samples in each.
const MOST_SAMPLED = 200_000;

// A screen of very small pixels needs none smaller.
const MOST_RATIO = 2;

export class Screen {
  constructor(triangles) {
    this.renderer = new WebGLRenderer({ antialias: false, alpha: true, stencil: true });
    this.renderer.localClippingEnabled = true;
    this.isHalved = triangles > MOST_SAMPLED;
    this.target = null;
  }

  get canvas() {
    return this.renderer.domElement;
  }

  resize(width, height) {
    this.renderer.setSize(width, height);
  }

  /** Draw in a way of the pace. */
  draw(scene, camera, { sampled, scale }) {
    const { renderer } = this;
    const own = Math.min(window.devicePixelRatio, MOST_RATIO);
    const ratio = sampled && this.isHalved ? MOST_RATIO : own * scale;
    if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
    if (!sampled || this.isHalved) renderer.render(scene, camera);
    else this.drawSampled(scene, camera);
  }

  drawSampled(scene, camera) {
    const { renderer, canvas: { width, height } } = this;
    const gl = renderer.getContext();
    this.target ??= this.sampled();
    this.target.setSize(width, height);
    renderer.setRenderTarget(this.target);
    renderer.render(scene, camera);
    const { __webglFramebuffer: from } = renderer.properties.get(this.target);
    renderer.setRenderTarget(null);
    renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
  }

  sampled() {
    const target = new WebGLRenderTarget(1, 1, {
      samples: SAMPLES, stencilBuffer: true, colorSpace: SRGBColorSpace, internalFormat: "RGBA8",
      resolveDepthBuffer: false, resolveStencilBuffer: false,
    });
    // Draw the colours of a screen, not those of a texture that light still falls on.
    target.isXRRenderTarget = true;
    return target;
  }

  close() {
    this.target?.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }
}
