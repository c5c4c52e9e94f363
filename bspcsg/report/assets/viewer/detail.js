// A rough mesh in place of a fine one while the view moves.

// Cells a side of the grid whose cells become one vertex each, fewer until few triangles are left.
const CELLS = [128, 96, 64, 40, 24];

/** The layer with the vertices in each cell made one, of so many triangles at most.
 *
 * `faces` are the numbers of the triangles that are left. A closed surface stays closed.
 */
export function roughened(layer, most) {
  let rough = null;
  for (const cells of CELLS) {
    rough = clustered(layer, cells);
    if (rough.indices.length <= 3 * most) break;
  }
  return rough;
}

function clustered({ positions, indices }, cells) {
  const count = positions.length / 3;
  const numbers = new Uint32Array(count);
  const cellNumbers = new Int32Array((cells + 1) ** 3).fill(-1);
  const sums = [];
  let used = 0;
  for (let v = 0; v < count; v += 1) {
    let cell = 0;
    // Coordinates go from -1 to 1.
    for (let axis = 0; axis < 3; axis += 1) {
      cell = cell * (cells + 1) + Math.round((positions[3 * v + axis] + 1) * (cells / 2));
    }
    if (cellNumbers[cell] < 0) {
      cellNumbers[cell] = used++;
      sums.push(0, 0, 0, 0);
    }
    const number = cellNumbers[cell];
    numbers[v] = number;
    for (let axis = 0; axis < 3; axis += 1) sums[4 * number + axis] += positions[3 * v + axis];
    sums[4 * number + 3] += 1;
  }
  const means = new Float32Array(3 * used);
  for (let i = 0; i < 3 * used; i += 1) {
    const number = Math.floor(i / 3);
    means[i] = sums[4 * number + (i % 3)] / sums[4 * number + 3];
  }
  return { positions: means, ...keptFaces(indices, numbers) };
}

function keptFaces(indices, numbers) {
  const kept = [];
  const faces = [];
  for (let at = 0; at < indices.length; at += 3) {
    const [a, b, c] = [numbers[indices[at]], numbers[indices[at + 1]], numbers[indices[at + 2]]];
    if (a !== b && b !== c && c !== a) {
      kept.push(a, b, c);
      faces.push(at / 3);
    }
  }
  return { indices: Uint32Array.from(kept), faces: Uint32Array.from(faces) };
}
