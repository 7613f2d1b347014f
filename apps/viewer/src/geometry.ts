// Rays, triangles and closest points, in plain numbers. For hits of clicks see picker.ts.
import type { Triple } from "./scene.ts";

export type Ray = { origin: Triple; direction: Triple }; // direction of length 1

export const sub = (a: ArrayLike<number>, b: ArrayLike<number>): Triple => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const add = (a: ArrayLike<number>, b: ArrayLike<number>): Triple => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const scale = (a: ArrayLike<number>, s: number): Triple => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: ArrayLike<number>, b: ArrayLike<number>): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const distance = (a: ArrayLike<number>, b: ArrayLike<number>): number => Math.hypot(...sub(a, b));
export const along = (ray: Ray, t: number): Triple => add(ray.origin, scale(ray.direction, t));
/** Returns where a ray is closest to a segment, and their distance there. */
export function raySegment(ray: Ray, a: Triple, b: Triple): { t: number; away: number } {
  const ab = sub(b, a);
  const from = sub(a, ray.origin);
  const cosine = dot(ab, ray.direction);
  const across = dot(ab, ab) - cosine * cosine; // squared length of the segment across the ray
  const s = across > 0 ? (cosine * dot(from, ray.direction) - dot(ab, from)) / across : 0;
  const at = add(from, scale(ab, Math.min(Math.max(s, 0), 1)));
  const t = Math.max(dot(at, ray.direction), 0);
  return { t, away: distance(at, scale(ray.direction, t)) };
}

/** Returns a triple of a flat array. */
export const tripleAt = (numbers: ArrayLike<number>, i: number): Triple => [
  numbers[3 * i],
  numbers[3 * i + 1],
  numbers[3 * i + 2],
];

/** Returns the closest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5). */
export function closestOnTriangle(p: Triple, a: Triple, b: Triple, c: Triple): Triple {
  const ab = sub(b, a);
  const ac = sub(c, a);
  const ap = sub(p, a);
  const d1 = dot(ab, ap);
  const d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = sub(p, b);
  const d3 = dot(ab, bp);
  const d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return add(a, scale(ab, d1 / (d1 - d3)));
  const cp = sub(p, c);
  const d5 = dot(ab, cp);
  const d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return add(a, scale(ac, d2 / (d2 - d6)));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return add(b, scale(sub(c, b), (d4 - d3) / (d4 - d3 + (d5 - d6))));
  }
  const sum = va + vb + vc;
  return sum === 0 ? a : add(a, add(scale(ab, vb / sum), scale(ac, vc / sum)));
}

/** Returns the closest point of a mesh, with a pass over all triangles. */
export function closestOnMesh(p: Triple, positions: ArrayLike<number>, triangles: ArrayLike<number>): Triple | undefined {
  let best: Triple | undefined;
  let least = Infinity;
  for (let i = 0; i < triangles.length / 3; ++i) {
    const corner = (k: number): Triple => tripleAt(positions, triangles[3 * i + k]);
    const a = corner(0);
    const b = corner(1);
    const c = corner(2);
    // A triangle whose box is further away than the best point is skipped.
    let bound = 0;
    for (let x = 0; x < 3; ++x) {
      const below = Math.min(a[x], b[x], c[x]) - p[x];
      const above = p[x] - Math.max(a[x], b[x], c[x]);
      const gap = Math.max(below, above, 0);
      bound += gap * gap;
    }
    if (bound >= least) continue;
    const q = closestOnTriangle(p, a, b, c);
    const d = sub(q, p);
    const squared = dot(d, d);
    if (squared < least) {
      least = squared;
      best = q;
    }
  }
  return best;
}
