// Scenes to begin with. Random, but the same for everybody.
function randomOf(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

const turn = (a, b, c) => Math.sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));

/** Return whether two segments have a point in common. */
function meet([a, b], [c, d]) {
  const overlap = [0, 1].every((k) => Math.min(a[k], b[k]) <= Math.max(c[k], d[k]) && Math.min(c[k], d[k]) <= Math.max(a[k], b[k]));
  return overlap && turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0;
}

const anyMeet = (segments) => segments.some((s, i) => segments.some((t, j) => i < j && meet(s, t)));

const grown = ([a, b], by) => [between(a, b, -by), between(a, b, 1 + by)];

/** So many disjoint segments in a room, no two of them close to each other. */
function randomSegments(count, width, height, seed, { shortest = 60, longest = 150, edge = 24 } = {}) {
  const random = randomOf(seed);
  const found = [];
  for (let tries = 0; found.length < count && tries < 20000; tries += 1) {
    const from = [edge + random() * (width - 2 * edge), edge + random() * (height - 2 * edge)];
    const angle = random() * 2 * Math.PI;
    const length = (shortest + random() * (longest - shortest)) * (tries > 4000 ? 0.5 : 1);
    const to = [from[0] + Math.cos(angle) * length, from[1] + Math.sin(angle) * length];
    const inside = to[0] > edge && to[0] < width - edge && to[1] > edge && to[1] < height - edge;
    const segment = [from, to].map((p) => p.map(Math.round));
    if (inside && !found.some((other) => meet(grown(other, 0.16), grown(segment, 0.16)))) found.push(segment);
  }
  return found;
}

function shuffled(list, random) {
  const mixed = list.slice();
  for (let end = mixed.length - 1; end > 0; end -= 1) {
    const other = Math.floor(random() * (end + 1));
    [mixed[end], mixed[other]] = [mixed[other], mixed[end]];
  }
  return mixed;
}
