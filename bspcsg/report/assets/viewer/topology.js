// The triangles that meet along an edge, sharp bends of the surface, and normals that show them.

/** The side of a triangle after this one; side 3 f + k runs from corner k of face f to the next. */
export const next = (side) => (side % 3 === 2 ? side - 2 : side + 1);

// Buckets above this length are sorted, so that a vertex with many faces costs no square.
const FEW = 16;

/** For each side the one that runs along the same edge the other way, or -1. */
export function opposites(indices, count) {
  const low = (side) => Math.min(indices[side], indices[next(side)]);
  const high = (side) => Math.max(indices[side], indices[next(side)]);
  const starts = new Uint32Array(count + 1);
  for (let side = 0; side < indices.length; side += 1) starts[low(side) + 1] += 1;
  for (let v = 0; v < count; v += 1) starts[v + 1] += starts[v];
  const free = starts.slice();
  const order = new Uint32Array(indices.length);
  for (let side = 0; side < indices.length; side += 1) order[free[low(side)]++] = side;
  const found = new Int32Array(indices.length).fill(-1);
  for (let v = 0; v < count; v += 1) {
    const bucket = order.subarray(starts[v], starts[v + 1]);
    const isLong = bucket.length > FEW;
    if (isLong) bucket.sort((a, b) => high(a) - high(b));
    pair(bucket, isLong, indices, found, high);
  }
  return found;
}

function pair(bucket, isSorted, indices, found, high) {
  for (let i = 0; i < bucket.length; i += 1) {
    const side = bucket[i];
    for (let j = i + 1; found[side] < 0 && j < bucket.length; j += 1) {
      const other = bucket[j];
      if (isSorted && high(other) !== high(side)) break;
      if (found[other] < 0 && indices[other] === indices[next(side)]
        && indices[next(other)] === indices[side]) {
        found[side] = other;
        found[other] = side;
      }
    }
  }
}

/** Normals of faces, as long as twice their areas. */
export function faceNormals({ positions, indices }) {
  const normals = new Float32Array(indices.length);
  for (let at = 0; at < indices.length; at += 3) {
    const [a, b, c] = [3 * indices[at], 3 * indices[at + 1], 3 * indices[at + 2]];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    normals[at] = uy * vz - uz * vy;
    normals[at + 1] = uz * vx - ux * vz;
    normals[at + 2] = ux * vy - uy * vx;
  }
  return normals;
}

/** A surface, and what is asked of its edges; each is computed once. */
export class Surface {
  constructor(layer) {
    this.layer = layer;
  }

  get opposites() {
    this.foundOpposites ??= opposites(this.layer.indices, this.layer.positions.length / 3);
    return this.foundOpposites;
  }

  get normals() {
    this.foundNormals ??= faceNormals(this.layer);
    return this.foundNormals;
  }

  /** Return whether the faces on both sides bend by less than an angle with this cosine. */
  isSmooth(side, other, cosine) {
    const n = this.normals;
    const [p, q] = [side - (side % 3), other - (other % 3)];
    const dot = n[p] * n[q] + n[p + 1] * n[q + 1] + n[p + 2] * n[q + 2];
    const squares = (n[p] ** 2 + n[p + 1] ** 2 + n[p + 2] ** 2)
      * (n[q] ** 2 + n[q + 1] ** 2 + n[q + 2] ** 2);
    // A face without area bends nothing.
    return squares === 0 || dot >= cosine * Math.sqrt(squares);
  }

  /** Pairs of vertices: edges of one face only, and those where two faces meet at an angle. */
  features(cosine) {
    const { indices } = this.layer;
    const pairs = [];
    this.opposites.forEach((other, side) => {
      if (other > side || (other >= 0 && this.isSmooth(side, other, cosine))) return;
      if (other < 0 || other < side) pairs.push(indices[side], indices[next(side)]);
    });
    return pairs;
  }

  /** Pairs of vertices: all edges, once. */
  edges() {
    const { indices } = this.layer;
    const pairs = [];
    this.opposites.forEach((other, side) => {
      if (other < side) pairs.push(indices[side], indices[next(side)]);
    });
    return pairs;
  }

  /** For each corner the number of its fan: the corners at a vertex between two sharp edges. */
  fans(cosine) {
    const count = this.layer.indices.length;
    const above = new Int32Array(count);
    for (let corner = 0; corner < count; corner += 1) above[corner] = corner;
    const top = (corner) => {
      let found = corner;
      while (above[found] !== found) found = above[found] = above[above[found]];
      return found;
    };
    const join = (a, b) => {
      const [p, q] = [top(a), top(b)];
      if (p < q) above[q] = p;
      else above[p] = q;
    };
    this.opposites.forEach((other, side) => {
      if (other < side || !this.isSmooth(side, other, cosine)) return;
      join(side, next(other));
      join(next(side), other);
    });
    for (let corner = 0; corner < count; corner += 1) above[corner] = top(corner);
    return above;
  }

  /** A geometry's arrays: one vertex for each fan, with its normal. */
  shaded(cosine) {
    const fans = this.fans(cosine);
    const { indices, positions } = this.layer;
    const numbers = new Uint32Array(fans.length);
    let count = 0;
    for (let corner = 0; corner < fans.length; corner += 1) {
      // The first corner of a fan stands for it.
      numbers[corner] = fans[corner] === corner ? count++ : numbers[fans[corner]];
    }
    const points = new Float32Array(3 * count);
    const normals = new Float32Array(3 * count);
    for (let corner = 0; corner < fans.length; corner += 1) {
      const [face, to, from] = [corner - (corner % 3), 3 * numbers[corner], 3 * indices[corner]];
      for (let axis = 0; axis < 3; axis += 1) {
        points[to + axis] = positions[from + axis];
        normals[to + axis] += this.normals[face + axis];
      }
    }
    return { positions: points, normals: unit(normals), indices: numbers };
  }
}

function unit(normals) {
  for (let at = 0; at < normals.length; at += 3) {
    const length = Math.hypot(normals[at], normals[at + 1], normals[at + 2]) || 1;
    for (let axis = 0; axis < 3; axis += 1) normals[at + axis] /= length;
  }
  return normals;
}
