// Model of a surface map: values at places of its surface, largest values, and their distribution.
import { add, closestOnTriangle, distance, dot, scale, sub, tripleAt } from "./geometry.ts";
import type { MapItem, Triple } from "./scene.ts";

type Place = [x: number, y: number]; // in the texture, in texels: x to the right, y down

const areaOf = (a: Triple, b: Triple, c: Triple): number => {
  const [u, v] = [sub(b, a), sub(c, a)];
  return Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
};
const turn = (a: Place, b: Place, c: Place): number => (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);

export class MapModel {
  readonly item: MapItem;
  #areas: Float32Array | undefined;

  constructor(item: MapItem) {
    this.item = item;
  }

  /** Returns the corners of a triangle, relative to the item's origin. */
  cornersOf(triangle: number): [Triple, Triple, Triple] {
    const { positions, triangles } = this.item;
    const at = (k: number): Triple => tripleAt(positions, triangles[3 * triangle + k]);
    return [at(0), at(1), at(2)];
  }
  /** Returns the places of its corners in the texture. */
  chartOf(triangle: number): [Place, Place, Place] {
    const { corners } = this.item;
    const at = (k: number): Place => [corners[6 * triangle + 2 * k], corners[6 * triangle + 2 * k + 1]];
    return [at(0), at(1), at(2)];
  }
  /** Returns the unit normal, towards the side that sees the corners counterclockwise; zeros if degenerate. */
  normalOf(triangle: number): Triple {
    const [a, b, c] = this.cornersOf(triangle);
    const [u, v] = [sub(b, a), sub(c, a)];
    const n: Triple = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    return scale(n, 1 / (Math.hypot(...n) || 1));
  }

  /** Returns the place of a point of a triangle in the texture. */
  placeOf(triangle: number, point: Triple): Place {
    const [a, b, c] = this.cornersOf(triangle);
    const [u, v, p] = [sub(b, a), sub(c, a), sub(point, a)];
    const [uu, uv, vv, up, vp] = [dot(u, u), dot(u, v), dot(v, v), dot(u, p), dot(v, p)];
    const whole = uu * vv - uv * uv;
    const s = whole > 0 ? (vv * up - uv * vp) / whole : 0;
    const t = whole > 0 ? (uu * vp - uv * up) / whole : 0;
    const [q, r, w] = this.chartOf(triangle);
    return [0, 1].map((k) => q[k] + s * (r[k] - q[k]) + t * (w[k] - q[k])) as Place;
  }

  /** Returns the texel that contains a place. */
  texelAt([x, y]: Place): number {
    const { width, height } = this.item;
    const inside = (value: number, size: number) => Math.min(Math.max(Math.floor(value), 0), size - 1);
    return inside(y, height) * width + inside(x, width);
  }

  /** Returns the value at a place: bilinear, or that of its texel if one of the four values is not finite. */
  valueAt(place: Place): number {
    const { width, height, distance: values } = this.item;
    const [x, y] = [place[0] - 0.5, place[1] - 0.5];
    const [i, j] = [Math.floor(x), Math.floor(y)];
    const [f, g] = [x - i, y - j];
    const inside = (value: number, size: number) => Math.min(Math.max(value, 0), size - 1);
    const at = (a: number, b: number) => values[inside(b, height) * width + inside(a, width)];
    const four = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
    const own = values[this.texelAt(place)];
    if (!Number.isFinite(own) || !four.every(Number.isFinite)) return own;
    return (four[0] * (1 - f) + four[1] * f) * (1 - g) + (four[2] * (1 - f) + four[3] * f) * g;
  }

  /** Returns the surface point that a texel represents, relative to the item's origin. */
  pointOf(texel: number): Triple {
    const { width, owners } = this.item;
    const triangle = owners[texel];
    const [a, b, c] = this.cornersOf(triangle);
    const [q, r, w] = this.chartOf(triangle);
    const middle: Place = [(texel % width) + 0.5, Math.floor(texel / width) + 0.5];
    const whole = turn(q, r, w);
    const s = turn(q, middle, w) / whole;
    const t = turn(q, r, middle) / whole;
    const inPlane = add(a, add(scale(sub(b, a), s), scale(sub(c, a), t)));
    return s >= 0 && t >= 0 && s + t <= 1 ? inPlane : closestOnTriangle(inPlane, a, b, c);
  }

  /** Returns the surface area of each texel. Texels beside their chart get 0 if other texels lie in it. */
  areas(): Float32Array {
    if (this.#areas !== undefined) return this.#areas;
    const { width, owners, triangles, corners } = this.item;
    const count = triangles.length / 3;
    const inside = new Uint32Array(count);
    const owned = new Uint32Array(count);
    const isInside = (texel: number, t: number): boolean => {
      const [x, y] = [(texel % width) + 0.5, Math.floor(texel / width) + 0.5];
      const side = (k: number, l: number) =>
        (corners[6 * t + 2 * l] - corners[6 * t + 2 * k]) * (y - corners[6 * t + 2 * k + 1]) -
        (x - corners[6 * t + 2 * k]) * (corners[6 * t + 2 * l + 1] - corners[6 * t + 2 * k + 1]);
      const [p, q, r] = [side(0, 1), side(1, 2), side(2, 0)];
      return (p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0);
    };
    const areas = new Float32Array(owners.length);
    for (let texel = 0; texel < owners.length; ++texel) {
      const t = owners[texel];
      if (t < 0) continue;
      ++owned[t];
      if (!isInside(texel, t)) continue;
      ++inside[t];
      areas[texel] = 1;
    }
    const each = Float32Array.from({ length: count }, (_, t) => areaOf(...this.cornersOf(t)) / (inside[t] || owned[t] || 1));
    for (let texel = 0; texel < owners.length; ++texel) {
      const t = owners[texel];
      if (t >= 0) areas[texel] = areas[texel] === 1 || inside[t] === 0 ? each[t] : 0;
    }
    return (this.#areas = areas);
  }

  /** Returns the area with values in each of `bins` equal parts of a range. Values outside the range do not count. */
  histogram(from: number, to: number, bins: number): Float64Array {
    const areas = this.areas();
    const { distance: values } = this.item;
    const out = new Float64Array(bins);
    const perUnit = bins / (to - from);
    for (let texel = 0; texel < values.length; ++texel) {
      const value = values[texel];
      if (!(value >= from && value <= to)) continue; // also skips NaN
      out[Math.min(Math.floor((value - from) * perUnit), bins - 1)] += areas[texel];
    }
    return out;
  }

  /** Returns the number of texels with at most this value, and their fraction of the surface area. */
  below(most: number): { texels: number; part: number } {
    const areas = this.areas();
    const { distance: values, owners } = this.item;
    let [texels, area, whole] = [0, 0, 0];
    for (let texel = 0; texel < values.length; ++texel) {
      if (owners[texel] < 0) continue;
      whole += areas[texel];
      if (!(values[texel] <= most)) continue;
      ++texels;
      area += areas[texel];
    }
    return { texels, part: whole > 0 ? area / whole : 0 };
  }

  /**
   * Returns up to `count` texels in order of their values, largest (or smallest) first. Each has the best value within
   * `apart` of it, and no earlier one is closer than `apart`.
   */
  worst(count: number, isLargest: boolean, apart: number): number[] {
    const { distance: values } = this.item;
    const sign = isLargest ? 1 : -1;
    const cells = this.#bestOfCells(sign, apart);
    const candidates = cells.best.filter((texel, cell) => {
      if (texel < 0) return false;
      return cells.around(cell).every((other) => cells.best[other] < 0 || sign * (values[cells.best[other]] - values[texel]) <= 0);
    });
    candidates.sort((a, b) => sign * (values[b] - values[a]) || a - b);
    const found: number[] = [];
    const points: Triple[] = [];
    for (const texel of candidates) {
      if (found.length === count) break;
      const point = this.pointOf(texel);
      if (points.some((other) => distance(point, other) < apart)) continue;
      found.push(texel);
      points.push(point);
    }
    return found;
  }

  /** Returns the texel with the largest value times `sign` in each cell of a grid; -1 for cells without one. */
  #bestOfCells(sign: number, side: number): { best: Int32Array; around: (cell: number) => number[] } {
    const { positions, owners, width, distance: values } = this.item;
    const lower: Triple = [Infinity, Infinity, Infinity];
    const upper: Triple = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < positions.length; ++i) {
      lower[i % 3] = Math.min(lower[i % 3], positions[i]);
      upper[i % 3] = Math.max(upper[i % 3], positions[i]);
    }
    const size = lower.map((low, a) => Math.max(Math.ceil((upper[a] - low) / side), 1)) as Triple;
    const best = new Int32Array(size[0] * size[1] * size[2]).fill(-1);
    const cellAlong = (x: number, a: number) => Math.min(Math.max(Math.floor((x - lower[a]) / side), 0), size[a] - 1);
    let triangle = -1;
    let from: (x: number, y: number) => number = () => 0;
    for (let texel = 0; texel < owners.length; ++texel) {
      if (owners[texel] < 0 || !Number.isFinite(values[texel])) continue;
      if (owners[texel] !== triangle) {
        triangle = owners[texel];
        const [a, b, c] = this.cornersOf(triangle);
        const [q, r, w] = this.chartOf(triangle);
        const whole = turn(q, r, w);
        from = (x, y) => {
          // As in pointOf(), except at borders.
          const s = ((x - q[0]) * (w[1] - q[1]) - (w[0] - q[0]) * (y - q[1])) / whole;
          const t = ((r[0] - q[0]) * (y - q[1]) - (x - q[0]) * (r[1] - q[1])) / whole;
          const along = (k: 0 | 1 | 2) => cellAlong(a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]), k);
          return (along(2) * size[1] + along(1)) * size[0] + along(0);
        };
      }
      const cell = from((texel % width) + 0.5, Math.floor(texel / width) + 0.5);
      if (best[cell] < 0 || sign * (values[texel] - values[best[cell]]) > 0) best[cell] = texel;
    }
    const around = (cell: number): number[] => {
      const at = [cell % size[0], Math.floor(cell / size[0]) % size[1], Math.floor(cell / size[0] / size[1])];
      const out: number[] = [];
      for (let k = 0; k < 27; ++k) {
        const [x, y, z] = [at[0] + (k % 3) - 1, at[1] + (Math.floor(k / 3) % 3) - 1, at[2] + Math.floor(k / 9) - 1];
        if (x < 0 || y < 0 || z < 0 || x >= size[0] || y >= size[1] || z >= size[2]) continue;
        out.push((z * size[1] + y) * size[0] + x);
      }
      return out;
    };
    return { best, around };
  }
}
