// The pairs of a moving scene: lines with dots at their ends, coloured by kind or by distance.
import * as THREE from "three";
import type { Color } from "./colors.ts";
import { fillPairs, mostPairs, pairCounts } from "./framesmodel.ts";
import { raySegment, tripleAt, type Ray } from "./geometry.ts";
import type { PairTable } from "./scene.ts";
import { Coloring, dotMaterial, lineGeometry, lineMaterial, setColor, shineThrough } from "./shaders.ts";

const colors: Color[] = [
  [0, 0.58, 0.52], // closest
  [0.93, 0.5, 0.02], // collision
  [0.5, 0.3, 0.88], // penetration
];
// Outlines of lines, because one end of the ramp is hard to see on the background.
const rimOnLight: Color = [0.12, 0.13, 0.17];
const rimOnDark: Color = [0.82, 0.85, 0.9];
const lineWidth = 3;
const rimWidth = 5;
const dotSize = 8;
const faintness = 0.35;

const cssOf = (color: Color): string => `rgb(${color.map((part) => Math.round(255 * part)).join(" ")})`;

/** The pairs of one kind, in buffers that are large enough for any frame. */
class PairsOfKind {
  readonly object = new THREE.Group();
  isShown = true;
  readonly #ends: Float32Array;
  readonly #values: Float32Array;
  readonly #lines: THREE.InstancedBufferGeometry;
  readonly #dots = new THREE.BufferGeometry();
  readonly #lineMaterials: THREE.RawShaderMaterial[];
  readonly #rim = lineMaterial(rimOnLight, rimWidth);
  readonly #faint: THREE.Object3D[];

  constructor(color: Color, capacity: number, range: [number, number]) {
    this.#ends = new Float32Array(6 * capacity);
    this.#values = new Float32Array(2 * capacity);
    this.#lines = lineGeometry(this.#ends, this.#values);
    this.#dots.setAttribute("position", new THREE.BufferAttribute(this.#ends, 3));
    this.#lineMaterials = [lineMaterial(color, lineWidth), lineMaterial(color, lineWidth)];
    for (const material of this.#lineMaterials) material.uniforms.range.value.set(...range);
    const dots = [dotMaterial(color, dotSize), dotMaterial(color, dotSize)];
    const [line, faintLine] = this.#lineMaterials.map((material) => new THREE.Mesh(this.#lines, material));
    const [dot, faintDot] = dots.map((material) => new THREE.Points(this.#dots, material));
    const rim = new THREE.Mesh(this.#lines, this.#rim);
    this.#rim.depthWrite = false; // because the lines lie at the same depth
    this.#faint = [faintLine, faintDot];
    shineThrough(faintLine.material, faintness);
    shineThrough(faintDot.material, faintness);
    // Faint parts are drawn after all surfaces, including translucent ones, and before the visible parts.
    const parts = [faintLine, faintDot, rim, line, dot];
    parts.forEach((part, i) => {
      part.frustumCulled = false;
      part.renderOrder = 11 + i;
    });
    this.object.add(...parts);
  }

  setByDistance(isByDistance: boolean): void {
    for (const material of this.#lineMaterials) {
      material.uniforms.coloring.value = isByDistance ? Coloring.scalar : Coloring.plain;
    }
  }
  setTheme(isDark: boolean): void {
    setColor(this.#rim, isDark ? rimOnDark : rimOnLight);
  }
  setThrough(isOn: boolean): void {
    for (const part of this.#faint) part.visible = isOn;
  }

  show(pairs: PairTable, frame: number, kind: number): void {
    const count = fillPairs(pairs, frame, kind, this.#ends, this.#values);
    this.#lines.instanceCount = count;
    this.#dots.setDrawRange(0, 2 * count);
    this.object.visible = this.isShown && count > 0;
    (this.#lines.attributes.from as THREE.InterleavedBufferAttribute).data.needsUpdate = true;
    for (const attribute of [this.#lines.attributes.values, this.#dots.attributes.position]) {
      (attribute as THREE.BufferAttribute).needsUpdate = true;
    }
  }
}

export class PairsView {
  readonly object = new THREE.Group();
  readonly #pairs: PairTable;
  readonly #kinds: PairsOfKind[];
  readonly #most: number[];
  #frame = 0;

  constructor(pairs: PairTable) {
    this.#pairs = pairs;
    this.#most = mostPairs(pairs);
    this.#kinds = this.#most.map((most, kind) => new PairsOfKind(colors[kind], most, pairs.range));
    this.object.add(...this.#kinds.map((kind) => kind.object));
  }

  /** Numbers of the kinds that occur in a frame. */
  get kinds(): number[] {
    return this.#most.flatMap((most, kind) => (most > 0 ? [kind] : []));
  }
  color(kind: number): string {
    return cssOf(colors[kind]);
  }
  isShown(kind: number): boolean {
    return this.#kinds[kind].isShown;
  }
  setShown(kind: number, isShown: boolean): void {
    this.#kinds[kind].isShown = isShown;
    this.show(this.#frame);
  }
  setByDistance(isByDistance: boolean): void {
    for (const kind of this.#kinds) kind.setByDistance(isByDistance);
  }
  setTheme(isDark: boolean): void {
    for (const kind of this.#kinds) kind.setTheme(isDark);
  }
  /** Shows hidden pairs faintly, or not at all. */
  setThrough(isOn: boolean): void {
    for (const kind of this.#kinds) kind.setThrough(isOn);
  }

  show(frame: number): void {
    this.#frame = frame;
    this.#kinds.forEach((kind, k) => kind.show(this.#pairs, frame, k));
  }

  /** Returns the number of pairs of each kind in the current frame. */
  counts(): number[] {
    return pairCounts(this.#pairs, this.#frame);
  }

  /** Returns the pair of the current frame that is closest to a ray. @param reach  largest distance. */
  pick(ray: Ray, reach: number): { pair: number; t: number } | undefined {
    const { first, kinds, points } = this.#pairs;
    let best: { pair: number; t: number } | undefined;
    let least = reach;
    for (let pair = first[this.#frame]; pair < first[this.#frame + 1]; ++pair) {
      if (!this.isShown(kinds[pair])) continue;
      const { t, away } = raySegment(ray, tripleAt(points, 2 * pair), tripleAt(points, 2 * pair + 1));
      if (away >= least) continue;
      least = away;
      best = { pair, t };
    }
    return best;
  }
}
