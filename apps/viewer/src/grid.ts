// Positions of grid nodes, and layers of nodes.
import type { Grid, Numbers, Triple } from "./scene.ts";

/** Returns the world position of index coordinates. */
export function toWorld(grid: Grid, at: Triple): Triple {
  const out: Triple = [...grid.origin];
  for (let axis = 0; axis < 3; ++axis) {
    for (let c = 0; c < 3; ++c) out[c] += grid.direction[axis][c] * at[axis] * grid.spacing[axis];
  }
  return out;
}

/** Returns the index coordinates of a world position. */
export function toIndex(grid: Grid, p: ArrayLike<number>): Triple {
  const out: Triple = [0, 0, 0];
  for (let axis = 0; axis < 3; ++axis) {
    for (let c = 0; c < 3; ++c) out[axis] += grid.direction[axis][c] * (p[c] - grid.origin[c]);
    out[axis] /= grid.spacing[axis];
  }
  return out;
}

export function nodeIndex(grid: Grid, at: Triple): number {
  return (at[2] * grid.size[1] + at[1]) * grid.size[0] + at[0];
}

export function nearestNode(grid: Grid, at: Triple): Triple {
  return at.map((value, axis) => Math.min(Math.max(Math.round(value), 0), grid.size[axis] - 1)) as Triple;
}

/** Returns the axes of a layer; the first one, u, runs along its rows. */
export function layerAxes(axis: number): [number, number] {
  return axis === 0 ? [1, 2] : axis === 1 ? [0, 2] : [0, 1];
}

/** Copies the values of a layer, u fastest, into an array that is large enough. */
export function copyLayer(grid: Grid, values: Numbers, axis: number, layer: number, out: Numbers): void {
  const strides = [1, grid.size[0], grid.size[0] * grid.size[1]];
  const [u, v] = layerAxes(axis);
  let at = 0;
  for (let j = 0; j < grid.size[v]; ++j) {
    const first = layer * strides[axis] + j * strides[v];
    if (u === 0) {
      out.set(values.subarray(first, first + grid.size[0]), at);
      at += grid.size[0];
    } else {
      for (let i = 0; i < grid.size[u]; ++i) out[at++] = values[first + i * strides[u]];
    }
  }
}
