// Fewer triangles for large surfaces, to show while the view moves and a whole picture would take too long: vertices of
// a cell of a grid become one of them (vertex clustering; Rossignac, Borrel 1993).

export type Coarse = {
  index: Uint32Array; // three vertices for each triangle that is left
  kept: Uint32Array; // its number, rising
};

/** Below so many triangles, nothing is gained. */
export const worthCoarsening = 100_000;
const cellsAlong = 80;

/** @param triangles  undefined where corners lie one after the other. */
export function coarsen(positions: Float32Array, triangles: Uint32Array | undefined, count: number): Coarse {
  const least = [Infinity, Infinity, Infinity];
  const most = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    if (positions[i] < least[i % 3]) least[i % 3] = positions[i];
    if (positions[i] > most[i % 3]) most[i % 3] = positions[i];
  }
  const side = Math.max(...most.map((m, a) => m - least[a])) / cellsAlong || 1;
  const across = cellsAlong + 1;
  const first = new Int32Array(across ** 3).fill(-1); // vertex of each cell
  const cellOf = (v: number): number => {
    const cell = (a: number): number => Math.floor((positions[3 * v + a] - least[a]) / side);
    return (cell(2) * across + cell(1)) * across + cell(0);
  };
  const index: number[] = [];
  const kept: number[] = [];
  for (let t = 0; t < count; ++t) {
    const corner = (k: number): number => (triangles ? triangles[3 * t + k] : 3 * t + k);
    const cells = [cellOf(corner(0)), cellOf(corner(1)), cellOf(corner(2))];
    if (cells[0] === cells[1] || cells[1] === cells[2] || cells[2] === cells[0]) continue;
    kept.push(t);
    for (let k = 0; k < 3; ++k) {
      if (first[cells[k]] < 0) first[cells[k]] = corner(k);
      index.push(first[cells[k]]);
    }
  }
  return { index: Uint32Array.from(index), kept: Uint32Array.from(kept) };
}

/** How many of the first triangles are left: of those with a number below `count`. */
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
