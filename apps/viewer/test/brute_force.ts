// The slow and obvious search that tests compare the picker with.
import type { Ray } from "../src/geometry.ts";

/** The first of the triangles that a ray hits, from either side (Moeller, Trumbore 1997). */
export function firstHit(
  ray: Ray,
  positions: ArrayLike<number>,
  triangles: ArrayLike<number> | undefined, // undefined: corners lie one after the other
  count: number,
): { triangle: number; t: number } | undefined {
  const [ox, oy, oz] = ray.origin;
  const [dx, dy, dz] = ray.direction;
  let best = Infinity;
  let triangle = -1;
  for (let i = 0; i < count; ++i) {
    const a = 3 * (triangles ? triangles[3 * i] : 3 * i);
    const b = 3 * (triangles ? triangles[3 * i + 1] : 3 * i + 1);
    const c = 3 * (triangles ? triangles[3 * i + 2] : 3 * i + 2);
    const ax = positions[a];
    const ay = positions[a + 1];
    const az = positions[a + 2];
    const e1x = positions[b] - ax;
    const e1y = positions[b + 1] - ay;
    const e1z = positions[b + 2] - az;
    const e2x = positions[c] - ax;
    const e2y = positions[c + 1] - ay;
    const e2z = positions[c + 2] - az;
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const determinant = e1x * px + e1y * py + e1z * pz;
    if (determinant === 0) continue;
    const sx = ox - ax;
    const sy = oy - ay;
    const sz = oz - az;
    const u = (sx * px + sy * py + sz * pz) / determinant;
    if (!(u >= 0 && u <= 1)) continue;
    const qx = sy * e1z - sz * e1y;
    const qy = sz * e1x - sx * e1z;
    const qz = sx * e1y - sy * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / determinant;
    if (!(v >= 0 && u + v <= 1)) continue;
    const t = (e2x * qx + e2y * qy + e2z * qz) / determinant;
    if (t > 0 && t < best) {
      best = t;
      triangle = i;
    }
  }
  return triangle < 0 ? undefined : { triangle, t: best };
}
