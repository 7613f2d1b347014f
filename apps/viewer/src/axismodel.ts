// Model of a medial axis: the triangles, edges and vertices that exist at any angle theta.
import type { AxisItem } from "./scene.ts";

export type AxisCounts = { triangles: number; sheets: number; curves: number; seams: number; rims: number };

/** The part of an axis that exists at an angle. */
export type AxisPart = {
  triangles: number; // the first ones of AxisModel.triangles
  edges: Uint32Array; // numbers of the existing edges
  junctions: Uint32Array; // vertices
  loose: Uint32Array; // vertices of no edge and no triangle
  counts: AxisCounts;
};

export class AxisModel {
  /** Triangles with area, by descending `until`, so that the first ones exist at every angle. */
  readonly triangles: Uint32Array;
  readonly until: Float32Array;
  /** The number of each triangle in the file. */
  readonly order: Uint32Array;
  readonly item: AxisItem;
  /** Numbers of the edges with length. */
  readonly edges: Uint32Array;
  readonly #vertexOnTriangleUntil: Float32Array;

  constructor(item: AxisItem) {
    this.item = item;
    const t = item.triangles;
    const kept: number[] = [];
    for (let i = 0; i < t.length / 3; ++i) {
      const [a, b, c] = [t[3 * i], t[3 * i + 1], t[3 * i + 2]];
      if (!this.#samePlace(a, b) && !this.#samePlace(b, c) && !this.#samePlace(c, a)) kept.push(i);
    }
    const until = item.triangleUntil;
    this.order = Uint32Array.from(kept).sort((a, b) =>
      until[a] === until[b] ? a - b : until[a] > until[b] ? -1 : 1,
    );
    this.triangles = new Uint32Array(3 * kept.length);
    this.until = new Float32Array(kept.length);
    this.#vertexOnTriangleUntil = new Float32Array(item.positions.length / 3).fill(-1);
    this.order.forEach((from, to) => {
      this.until[to] = until[from];
      for (let k = 0; k < 3; ++k) {
        const v = t[3 * from + k];
        this.triangles[3 * to + k] = v;
        if (until[from] > this.#vertexOnTriangleUntil[v]) this.#vertexOnTriangleUntil[v] = until[from];
      }
    });
    const edges: number[] = [];
    for (let e = 0; e < item.edges.length / 2; ++e) {
      if (!this.#samePlace(item.edges[2 * e], item.edges[2 * e + 1])) edges.push(e);
    }
    this.edges = Uint32Array.from(edges);
  }

  get isNested(): boolean {
    return this.item.leastTheta !== undefined;
  }

  /** @param theta  degrees; ignored unless the file contains all angles. */
  at(theta: number): AxisPart {
    const item = this.item;
    const angle = this.isNested ? theta : 0;
    const triangles = this.#countAt(angle);
    const edges: number[] = [];
    const { rim, seam, curve, junction } = item.roleNumbers;
    const kinds = [rim, seam, curve];
    const perKind = [0, 0, 0];
    const vertexCount = item.positions.length / 3;
    const around = new Uint8Array(3 * vertexCount); // for each kind
    for (const e of this.edges) {
      if (!(item.edgeFrom[e] <= angle && angle < item.edgeUntil[e])) continue;
      const kind = kinds.indexOf(item.edgeRoles[e]);
      edges.push(e);
      ++perKind[kind];
      for (let k = 0; k < 2; ++k) {
        const at = 3 * item.edges[2 * e + k] + kind;
        if (around[at] < 255) ++around[at];
      }
    }
    const junctions: number[] = [];
    const loose: number[] = [];
    for (let v = 0; v < vertexCount; ++v) {
      const isOnTriangle = this.#vertexOnTriangleUntil[v] > angle;
      const [rims, seams, curves] = [around[3 * v], around[3 * v + 1], around[3 * v + 2]];
      const isJunction = this.isNested
        ? isJunctionOf(rims, seams, curves, isOnTriangle)
        : item.hasLabels && item.roles[v] === junction;
      if (isJunction) junctions.push(v);
      const isThere = item.vertexUntil === undefined || item.vertexUntil[v] > angle;
      if (isThere && !isOnTriangle && rims + seams + curves === 0) loose.push(v);
    }
    return {
      triangles,
      edges: Uint32Array.from(edges),
      junctions: Uint32Array.from(junctions),
      loose: Uint32Array.from(loose),
      counts: {
        triangles,
        sheets: this.#sheetsAmong(triangles),
        rims: perKind[0],
        seams: perKind[1],
        curves: perKind[2],
      },
    };
  }

  #samePlace(a: number, b: number): boolean {
    if (a === b) return true;
    const p = this.item.positions;
    return p[3 * a] === p[3 * b] && p[3 * a + 1] === p[3 * b + 1] && p[3 * a + 2] === p[3 * b + 2];
  }

  /** Returns the number of triangles that exist at an angle. */
  #countAt(theta: number): number {
    let low = 0;
    let high = this.until.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.until[middle] > theta) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  #sheetsAmong(triangles: number): number {
    const seen = new Set<number>();
    for (let i = 0; i < triangles; ++i) seen.add(this.item.sheets[this.order[i]]);
    return seen.size;
  }
}

/** The same rule as in src/axis/label_sheets.cpp, except for sheets that only touch. */
export function isJunctionOf(rims: number, seams: number, curves: number, isOnTriangle: boolean): boolean {
  if (curves === 0 && seams === 0) return rims > 2;
  if (seams === 2 && curves === 0) return rims > 0;
  return !(curves <= 2 && seams === 0 && rims === 0 && !isOnTriangle);
}
