// The roughness with which a moving view is drawn: by the time of its pictures, whatever draws them.

// Milliseconds that a picture of a moving view may take: thirty pictures a second.
const MOST = 33;

// Several samples a pixel take up to so many times as long as one.
const SAMPLES_COST = 3;

// The first way that the view does not know from standing still.
const FIRST_ROUGH = 2;

// Weight of the newest picture in the mean, and what one counts at most: a pause is no slow drawing.
const WEIGHT = 0.2;
const MOST_COUNTED = 2 * MOST;

// A mean in the middle, from which a few pictures lead out; below the least, the finer way fits, too.
const MIDDLE = 0.6 * MOST;
const LEAST = MOST / 3;

/** As pictures are drawn when nothing moves: all triangles, several samples a pixel. */
export const STILL = { sampled: true, rough: false, scale: 1 };

// Each quicker than the one before; `scale` is of the sides of the picture, in pixels.
const WAYS = [
  STILL,
  { sampled: false, rough: false, scale: 1 },
  { sampled: false, rough: true, scale: 1 },
  { sampled: false, rough: true, scale: 0.75 },
  { sampled: false, rough: true, scale: 0.5 },
];

export class Pace {
  constructor(gl) {
    this.gl = gl;
    this.level = 0;
    this.mean = MIDDLE;
    this.waiting = [];
    this.done = 0;
  }

  /** The way to draw while the view moves. */
  get way() {
    return WAYS[this.level];
  }

  /** Learn from what a picture of the view standing still took. */
  stood(milliseconds) {
    if (milliseconds <= MOST) this.go(0);
    else if (milliseconds <= SAMPLES_COST * MOST) this.go(Math.max(this.level, 1));
    else this.go(Math.max(this.level, FIRST_ROUGH));
  }

  /** Learn from what a picture of the moving view took. */
  moved(milliseconds) {
    this.mean += WEIGHT * (Math.min(milliseconds, MOST_COUNTED) - this.mean);
    if (this.mean > MOST && this.level < WAYS.length - 1) this.go(this.level + 1);
    else if (this.mean < LEAST && this.level > FIRST_ROUGH) this.go(this.level - 1);
  }

  go(level) {
    this.level = level;
    this.mean = MIDDLE;
  }

  /** Learn from the picture that was asked for since some time, when it is there. */
  time(began, isMoving) {
    const { gl } = this;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.waiting.push({ fence, began, isMoving });
    if (this.waiting.length === 1) this.look();
  }

  /** See whether the oldest picture is there, until none is left. */
  look() {
    const { gl, waiting: [{ fence, began, isMoving }] } = this;
    if (gl.isContextLost()) return;
    if (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) {
      setTimeout(() => this.look(), 1);
      return;
    }
    gl.deleteSync(fence);
    this.waiting.shift();
    const now = performance.now();
    // Pictures wait for those before them.
    const taken = now - Math.max(began, this.done);
    this.done = now;
    if (isMoving) this.moved(taken);
    else this.stood(taken);
    if (this.waiting.length) this.look();
  }
}
