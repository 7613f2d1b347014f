// Finds the triangle that a click hits.
import * as THREE from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Ray } from "./geometry.ts";

/** Triangles in a hierarchy. The first query builds it; then the arrays must not change. */
export class Picker {
  readonly #positions: Float32Array;
  readonly #triangles: Uint32Array | undefined;
  #hierarchy: MeshBVH | undefined;

  /** @param triangles  undefined if `positions` lists the corners of all triangles. */
  constructor(positions: Float32Array, triangles?: Uint32Array) {
    this.#positions = positions;
    this.#triangles = triangles;
  }

  /** Returns the first triangle that a ray hits from either side, among the first `count` ones if given. */
  firstHit(ray: Ray, count?: number): { triangle: number; t: number } | undefined {
    const all = (this.#triangles ?? this.#positions).length / (this.#triangles ? 3 : 9);
    const most = count ?? all;
    if (Math.min(most, all) === 0) return undefined;
    this.#hierarchy ??= this.#build();
    const own = new THREE.Ray(new THREE.Vector3(...ray.origin), new THREE.Vector3(...ray.direction));
    let best: { triangle: number; t: number } | undefined;
    const consider = (hit: THREE.Intersection | null) => {
      if (hit === null || typeof hit.faceIndex !== "number" || hit.faceIndex >= most) return;
      if (best === undefined || hit.distance < best.t) best = { triangle: hit.faceIndex, t: hit.distance };
    };
    if (most >= all) consider(this.#hierarchy.raycastFirst(own, THREE.DoubleSide));
    else this.#hierarchy.raycast(own, THREE.DoubleSide).forEach(consider);
    return best;
  }

  #build(): MeshBVH {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.#positions, 3));
    if (this.#triangles) geometry.setIndex(new THREE.BufferAttribute(this.#triangles, 1));
    return new MeshBVH(geometry, { indirect: true }); // keeps the order of the triangles
  }
}
