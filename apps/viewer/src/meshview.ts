// A mesh on the stage.
import * as THREE from "three";
import { coarsen, worthCoarsening } from "./coarse.ts";
import { plural } from "./format.ts";
import { add, along, distance, sub, tripleAt, type Ray } from "./geometry.ts";
import { Picker } from "./picker.ts";
import type { Fact, MeshItem, Triple } from "./scene.ts";
import { dotMaterial, lineGeometry, lineMaterial, setColor, setStyle, surfaceMaterial, type Style } from "./shaders.ts";
import type { Hit, Legend, Surroundings, View } from "./view.ts";
import { element, styleChoice } from "./widgets.ts";

const light: Triple = [0.66, 0.72, 0.79];
const dark: Triple = [0.62, 0.68, 0.76];

export class MeshView implements View {
  readonly item: MeshItem;
  readonly object = new THREE.Group();
  readonly controls: HTMLElement;
  readonly #offset: Triple; // of the item's origin in drawn coordinates
  readonly #material = surfaceMaterial();
  #picker: Picker | undefined;
  readonly #lines = lineMaterial([0.35, 0.4, 0.46], 2);
  readonly #dots = dotMaterial([0.35, 0.4, 0.46], 5);
  readonly #whole = new THREE.BufferGeometry();
  readonly #surface = new THREE.Mesh(this.#whole, this.#material);
  #coarse: THREE.BufferGeometry | undefined;
  #style: Style;

  /** @param isAlone  true if the mesh is the only item, so that nothing is inside. */
  constructor(item: MeshItem, around: Surroundings, isAlone: boolean) {
    this.item = item;
    this.#offset = sub(item.origin, around.center);
    this.#style = isAlone ? "solid" : "translucent";
    this.object.position.set(...this.#offset);
    this.object.add(...this.#parts());
    // Draws the surface behind items in its plane, for example the surface part of a Voronoi diagram. Otherwise both
    // would flicker.
    this.#material.polygonOffset = true;
    this.#material.polygonOffsetFactor = 1;
    this.#material.polygonOffsetUnits = 4;
    setStyle(this.#material, this.#style);
    this.controls = element("div", "controls");
    if (item.triangles.length > 0) {
      this.controls.append(
        styleChoice("Surface", this.#style, (style) => {
          this.#style = style;
          setStyle(this.#material, style);
          this.#orderDrawing();
          around.changed();
        }),
      );
    }
    this.#orderDrawing();
  }

  pick(ray: Ray): Hit | undefined {
    const { positions, triangles } = this.item;
    this.#picker ??= new Picker(positions, triangles);
    return surfaceHit(this.#picker, this.item, { positions, triangles }, ray, this.#offset);
  }

  /** True if clicks prefer items inside. */
  get isSeenThrough(): boolean {
    return this.#style !== "solid";
  }

  legends(): Legend[] {
    return [];
  }

  liveFacts(): Fact[] {
    return [["shown", `${plural(this.item.counts.triangles, "triangle")}, ${this.#style}`]];
  }

  setTheme(isDark: boolean): void {
    setColor(this.#material, isDark ? dark : light);
  }

  setMoving(isMoving: boolean): void {
    const { positions, triangles } = this.item;
    if (triangles.length < 3 * worthCoarsening) return;
    if (this.#coarse === undefined) {
      this.#coarse = new THREE.BufferGeometry();
      this.#coarse.setAttribute("position", this.#whole.attributes.position);
      const { index } = coarsen(positions, triangles, triangles.length / 3);
      this.#coarse.setIndex(new THREE.BufferAttribute(index, 1));
    }
    this.#surface.geometry = isMoving ? this.#coarse : this.#whole;
  }

  #orderDrawing(): void {
    this.object.traverse((part) => (part.renderOrder = this.#style === "translucent" ? 10 : 0));
  }

  #parts(): THREE.Object3D[] {
    const { positions, triangles, segments, points } = this.item;
    const parts: THREE.Object3D[] = [];
    const attribute = new THREE.BufferAttribute(positions, 3);
    if (triangles.length > 0) {
      this.#whole.setAttribute("position", attribute);
      this.#whole.setIndex(new THREE.BufferAttribute(triangles, 1));
      parts.push(this.#surface);
    }
    if (segments.length > 0) {
      const ends = new Float32Array(3 * segments.length);
      segments.forEach((vertex, i) => ends.set(tripleAt(positions, vertex), 3 * i));
      parts.push(new THREE.Mesh(lineGeometry(ends), this.#lines));
    }
    if (points.length > 0) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", attribute);
      geometry.setIndex(new THREE.BufferAttribute(points, 1));
      parts.push(new THREE.Points(geometry, this.#dots));
    }
    for (const part of parts) part.frustumCulled = false;
    return parts;
  }
}

/**
 * Returns the first hit of a ray and a mesh: the triangle and its nearest vertex.
 * @param offset  position of the mesh's origin in drawn coordinates.
 */
export function surfaceHit(
  picker: Picker,
  item: { name: string; origin: Triple },
  mesh: { positions: Float32Array; triangles: Uint32Array },
  ray: Ray,
  offset: Triple,
): Hit | undefined {
  const { positions, triangles } = mesh;
  const own: Ray = { origin: sub(ray.origin, offset), direction: ray.direction };
  const hit = picker.firstHit(own);
  if (hit === undefined) return undefined;
  const at = along(own, hit.t);
  const corners = [0, 1, 2].map((k) => triangles[3 * hit.triangle + k]);
  const nearest = corners.reduce((a, b) =>
    distance(at, tripleAt(positions, a)) <= distance(at, tripleAt(positions, b)) ? a : b,
  );
  return {
    t: hit.t,
    title: item.name,
    facts: [
      ["triangle", `${hit.triangle} (corners ${corners.join(", ")})`],
      ["nearest vertex", String(nearest)],
    ],
    at: add(at, item.origin),
    footprints: [],
  };
}
