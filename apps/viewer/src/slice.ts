// A layer of a grid of nodes, as a textured rectangle.
import * as THREE from "three";
import { along, dot, sub, type Ray } from "./geometry.ts";
import { copyLayer, layerAxes, nearestNode, toIndex, toWorld } from "./grid.ts";
import type { Grid, Numbers, Triple } from "./scene.ts";
import { lineGeometry, lineMaterial, sliceMaterial } from "./shaders.ts";

export class Slice {
  readonly object = new THREE.Group();
  readonly material = sliceMaterial();
  readonly frame = lineMaterial([0.4, 0.45, 0.5], 1.5);
  axis = 2;
  layer = 0;
  readonly #grid: Grid;
  readonly #values: Numbers;
  readonly #sites: Int32Array | undefined;
  readonly #center: Triple;
  readonly #mesh: THREE.Mesh;
  readonly #border: THREE.Mesh;

  /** @param center  origin of drawn coordinates. */
  constructor(grid: Grid, values: Numbers, sites: Int32Array | undefined, center: Triple) {
    this.#grid = grid;
    this.#values = values;
    this.#sites = sites;
    this.#center = center;
    this.#mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.#border = new THREE.Mesh(new THREE.BufferGeometry(), this.frame);
    for (const part of [this.#mesh, this.#border]) part.frustumCulled = false;
    this.object.add(this.#mesh, this.#border);
    // An integer sampler needs an integer texture, even if the shader never reads it.
    this.material.uniforms.sites.value = integers(new Int32Array(1), 1, 1);
    const flat = grid.size.indexOf(1);
    this.show(flat >= 0 ? flat : 2, Math.floor((grid.size[flat >= 0 ? flat : 2] - 1) / 2));
  }

  get layers(): number {
    return this.#grid.size[this.axis];
  }

  show(axis: number, layer: number): void {
    this.axis = axis;
    this.layer = Math.min(Math.max(Math.round(layer), 0), this.#grid.size[axis] - 1);
    this.#fill();
    this.#place();
  }

  /** Returns the corner of the layer for its handle, and the same corner of the next layer. */
  handle(): { at: Triple; next: Triple } {
    const [u, v] = layerAxes(this.axis);
    const index: Triple = [0, 0, 0];
    index[u] = this.#grid.size[u] - 0.5;
    index[v] = this.#grid.size[v] - 0.5;
    index[this.axis] = this.layer;
    const at = this.#drawn(index);
    index[this.axis] += 1;
    return { at, next: this.#drawn(index) };
  }

  /** Returns the node under a ray, and the distance along the ray to the layer. */
  pick(ray: Ray): { node: Triple; t: number } | undefined {
    const normal = this.#grid.direction[this.axis];
    const on = this.#drawn(this.axis === 0 ? [this.layer, 0, 0] : this.axis === 1 ? [0, this.layer, 0] : [0, 0, this.layer]);
    const t = dot(sub(on, ray.origin), normal) / dot(ray.direction, normal);
    if (!(t > 0) || !Number.isFinite(t)) return undefined;
    const p = along(ray, t);
    const index = toIndex(this.#grid, [0, 1, 2].map((a) => p[a] + this.#center[a]));
    for (const a of layerAxes(this.axis)) {
      if (index[a] < -0.5 || index[a] > this.#grid.size[a] - 0.5) return undefined;
    }
    index[this.axis] = this.layer;
    return { node: nearestNode(this.#grid, index), t };
  }

  #drawn(index: Triple): Triple {
    return sub(toWorld(this.#grid, index), this.#center);
  }

  #fill(): void {
    const [u, v] = layerAxes(this.axis);
    const [width, height] = [this.#grid.size[u], this.#grid.size[v]];
    const uniforms = this.material.uniforms;
    const values = new Float32Array(width * height);
    copyLayer(this.#grid, this.#values, this.axis, this.layer, values);
    (uniforms.values.value as THREE.Texture | null)?.dispose();
    uniforms.values.value = new THREE.DataTexture(values, width, height, THREE.RedFormat, THREE.FloatType);
    uniforms.values.value.needsUpdate = true;
    if (this.#sites !== undefined) {
      const sites = new Int32Array(width * height);
      copyLayer(this.#grid, this.#sites, this.axis, this.layer, sites);
      (uniforms.sites.value as THREE.Texture).dispose();
      uniforms.sites.value = integers(sites, width, height);
    }
    uniforms.size.value = [width, height];
  }

  #place(): void {
    const [u, v] = layerAxes(this.axis);
    const corner = (a: number, b: number): Triple => {
      const index: Triple = [0, 0, 0];
      index[u] = a;
      index[v] = b;
      index[this.axis] = this.layer;
      return index;
    };
    const [right, top] = [this.#grid.size[u] - 0.5, this.#grid.size[v] - 0.5];
    const corners = [corner(-0.5, -0.5), corner(right, -0.5), corner(right, top), corner(-0.5, top)];
    const places = corners.map((index) => this.#drawn(index));
    const geometry = this.#mesh.geometry;
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(places.flat()), 3));
    const at = new Float32Array(corners.flatMap((index) => [index[u], index[v]]));
    geometry.setAttribute("at", new THREE.BufferAttribute(at, 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.#border.geometry.dispose();
    this.#border.geometry = lineGeometry(
      new Float32Array(places.flatMap((p, i) => [...p, ...places[(i + 1) % 4]])),
    );
  }
}

function integers(values: Int32Array, width: number, height: number): THREE.DataTexture {
  const texture = new THREE.DataTexture(values, width, height, THREE.RedIntegerFormat, THREE.IntType);
  texture.internalFormat = "R32I";
  texture.unpackAlignment = 4;
  texture.needsUpdate = true;
  return texture;
}
