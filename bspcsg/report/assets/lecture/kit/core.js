// The Rust core, compiled to WebAssembly, and the facets it is given.
async function startCore() {
  const packed = document.getElementById("core-module").textContent.trim();
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  await wasm_bindgen({ module_or_path: bytes });
}

/**
 * Use what the core makes and free it: WebAssembly's memory knows no garbage collection.
 */
function using(made, work) {
  try {
    return work(made);
  } finally {
    made.free();
  }
}

/** The autopartition of facets, each a list of corners, in an order of their indices. */
function autopartition(dimension, facets, order, room) {
  const sorted = order.map((i) => facets[i]);
  const offsets = [0];
  for (const facet of sorted) offsets.push(offsets[offsets.length - 1] + facet.length);
  return new wasm_bindgen.Autopartition(
    dimension,
    new Float64Array(sorted.flat(2)),
    new Int32Array(offsets),
    new Float64Array(room.flat()),
  );
}

/** The nodes of an autopartition with the facets' own numbers instead of places in the order. */
function treeOf(partition, order) {
  const view = JSON.parse(partition.view());
  for (const node of view.nodes) {
    node.pivot = order[node.pivot];
    node.cut = [...new Set(node.cut.map((i) => order[i]))];
    for (const part of [...node.list, ...node.coplanar]) part.facet = order[part.facet];
  }
  return view;
}
