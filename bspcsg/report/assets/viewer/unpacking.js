// Models as the page holds them: numbers of whole layers in compressed bytes, see packing.py.

/** The bytes of text in base64. */
export function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const letters = atob(base64);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i += 1) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

async function unzipped(base64) {
  const stream = new Blob([bytesOf(base64)]).stream()
    .pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Reads one array after another. */
class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }

  /** Bytes as numbers: all first bytes come first, then all second bytes, and so on. */
  numbers(Kind, count) {
    const width = Kind.BYTES_PER_ELEMENT;
    const joined = new Uint8Array(count * width);
    for (let plane = 0; plane < width; plane += 1) {
      const from = this.at + plane * count;
      for (let i = 0; i < count; i += 1) joined[i * width + plane] = this.bytes[from + i];
    }
    this.at += count * width;
    return new Kind(joined.buffer);
  }

  /** Rows of numbers that are stored column by column. */
  rows(Kind, count, columns) {
    const planar = this.numbers(Kind, count * columns);
    const rows = new Kind(planar.length);
    for (let column = 0; column < columns; column += 1) {
      for (let i = 0; i < count; i += 1) rows[columns * i + column] = planar[column * count + i];
    }
    return rows;
  }

  positions(count, { quantised, step }) {
    if (!quantised) return this.rows(Float32Array, count, 3);
    const planar = this.numbers(Uint16Array, 3 * count);
    const positions = new Float32Array(3 * count);
    for (let axis = 0; axis < 3; axis += 1) {
      let last = 0;
      for (let i = 0; i < count; i += 1) {
        last = (last + planar[axis * count + i]) & 0xffff;
        positions[3 * i + axis] = (last - 32767.5) * step[axis];
      }
    }
    return positions;
  }

  /** Whole numbers, stored as steps from one to the next. */
  indices(count) {
    const indices = this.numbers(Uint32Array, count);
    let last = 0;
    for (let i = 0; i < count; i += 1) {
      last += (indices[i] >>> 1) ^ -(indices[i] & 1);
      indices[i] = last;
    }
    return indices;
  }

  paint(paint, triangles) {
    const counts = { face: triangles, corner: 3 * triangles };
    if (paint.kind === "colours") {
      paint.values = this.rows(Uint8Array, counts[paint.at], 4);
    } else {
      paint.values = this.numbers(Uint16Array, counts[paint.at]);
    }
    if (paint.images) paint.uv = this.rows(Float32Array, 3 * triangles, 2);
  }
}

/** The model that JSON text holds, its layers with arrays. */
export async function modelOf(text) {
  const model = JSON.parse(text);
  const reader = new Reader(await unzipped(model.data));
  for (const layer of model.layers) {
    layer.positions = reader.positions(layer.vertices, model);
    layer.indices = reader.indices(3 * layer.triangles);
    layer.lines = reader.indices(2 * layer.segments);
    for (const paint of layer.paints) reader.paint(paint, layer.triangles);
  }
  delete model.data;
  return model;
}
