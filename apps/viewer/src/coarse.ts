// Coarse versions of large surfaces, shown while the view moves and whole pictures take too long. All vertices in a
// cell of a grid become one of them (vertex clustering; Rossignac, Borrel 1993).

export type Coarse = {
  index: Uint32Array; // three vertices for each remaining triangle
  kept: Uint32Array; // number of each remaining triangle, ascending
};

/** With fewer triangles, coarsening gains nothing. */
export const worthCoarsening = 100_000;
const cellsAlong = 80;
const across = cellsAlong + 1;

/** @param triangles  undefined if `positions` lists the corners of all triangles. */
export function coarsen(positions: Float32Array, triangles: Uint32Array | undefined, count: number): Coarse {
  const cells = cellsOf(positions);
  const first = new Int32Array(across ** 3).fill(-1); // representative vertex of each cell
  const vertexIn = (cell: number, v: number): number => {
    if (first[cell] < 0) first[cell] = v;
    return first[cell];
  };
  const index: number[] = [];
  const kept: number[] = [];
  for (let t = 0; t < count; ++t) {
    const u = triangles ? triangles[3 * t] : 3 * t;
    const v = triangles ? triangles[3 * t + 1] : 3 * t + 1;
    const w = triangles ? triangles[3 * t + 2] : 3 * t + 2;
    const [a, b, c] = [cells[u], cells[v], cells[w]];
    if (a === b || b === c || c === a) continue;
    kept.push(t);
    index.push(vertexIn(a, u), vertexIn(b, v), vertexIn(c, w));
  }
  return { index: Uint32Array.from(index), kept: Uint32Array.from(kept) };
}

/** Returns the cell of each vertex. */
function cellsOf(positions: Float32Array): Int32Array {
  const least = [Infinity, Infinity, Infinity];
  const most = [-Infinity, -Infinity, -Infinity];
  for (let v = 0; v < positions.length; v += 3) {
    for (let a = 0; a < 3; ++a) {
      const x = positions[v + a];
      if (x < least[a]) least[a] = x;
      if (x > most[a]) most[a] = x;
    }
  }
  const side = Math.max(...most.map((m, a) => m - least[a])) / cellsAlong || 1;
  const cells = new Int32Array(positions.length / 3);
  for (let v = 0; v < cells.length; ++v) {
    const x = Math.floor((positions[3 * v] - least[0]) / side);
    const y = Math.floor((positions[3 * v + 1] - least[1]) / side);
    const z = Math.floor((positions[3 * v + 2] - least[2]) / side);
    cells[v] = (z * across + y) * across + x;
  }
  return cells;
}

/** Returns how many triangles with a number below `count` remain. */
export function keptBelow(coarse: Coarse, count: number): number {
  let low = 0;
  let high = coarse.kept.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (coarse.kept[middle] < count) low = middle + 1;
    else high = middle;
  }
  return low;
}
