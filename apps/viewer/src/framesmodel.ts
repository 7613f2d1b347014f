// Normals and pairs of the frames of a moving scene.
import type { FramesItem, PairTable } from "./scene.ts";

/** Sums the normals of the triangles at each vertex, weighted by area. Shaders normalize them. */
export function vertexNormals(positions: Float32Array, triangles: Uint32Array, out: Float32Array): void {
  out.fill(0, 0, positions.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const a = 3 * triangles[i];
    const b = 3 * triangles[i + 1];
    const c = 3 * triangles[i + 2];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy;
    const y = uz * vx - ux * vz;
    const z = ux * vy - uy * vx;
    out[a] += x;
    out[a + 1] += y;
    out[a + 2] += z;
    out[b] += x;
    out[b + 1] += y;
    out[b + 2] += z;
    out[c] += x;
    out[c + 1] += y;
    out[c + 2] += z;
  }
}

/** Returns the number of pairs of each kind in a frame. */
export function pairCounts(pairs: PairTable, frame: number): number[] {
  const counts = pairs.kindNames.map(() => 0);
  for (let p = pairs.first[frame]; p < pairs.first[frame + 1]; ++p) ++counts[pairs.kinds[p]];
  return counts;
}

/** Returns, for each kind, the largest number of pairs in a frame. */
export function mostPairs(pairs: PairTable): number[] {
  const most = pairs.kindNames.map(() => 0);
  for (let frame = 0; frame + 1 < pairs.first.length; ++frame) {
    pairCounts(pairs, frame).forEach((count, kind) => (most[kind] = Math.max(most[kind], count)));
  }
  return most;
}

/**
 * Copies the ends of a frame's pairs of one kind, and the distance at each end. Returns the number of pairs. The arrays
 * must be large enough.
 */
export function fillPairs(pairs: PairTable, frame: number, kind: number, ends: Float32Array, values: Float32Array): number {
  let count = 0;
  for (let p = pairs.first[frame]; p < pairs.first[frame + 1]; ++p) {
    if (pairs.kinds[p] !== kind) continue;
    for (let k = 0; k < 6; ++k) ends[6 * count + k] = pairs.points[6 * p + k];
    values[2 * count] = values[2 * count + 1] = pairs.distances[p];
    ++count;
  }
  return count;
}

/** Returns the largest numbers of vertices and triangles of a frame, for the sizes of buffers. */
export function capacityOf(item: FramesItem): { vertices: number; triangles: number } {
  const most = (counts: number[]) => counts.reduce((a, b) => Math.max(a, b), 0);
  return {
    vertices: most(item.frames.map((frame) => frame.positions.length / 3)),
    triangles: most(item.meshes.map((triangles) => triangles.length / 3)),
  };
}
