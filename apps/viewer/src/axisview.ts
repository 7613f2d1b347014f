// A medial axis on the stage.
import * as THREE from "three";
import { AxisModel, type AxisPart } from "./axismodel.ts";
import { coarsen, keptBelow, worthCoarsening, type Coarse } from "./coarse.ts";
import { counted, plural, rounded } from "./format.ts";
import { add, along, distance, dot, sub, tripleAt, type Ray } from "./geometry.ts";
import { Picker } from "./picker.ts";
import type { AxisItem, Fact, Triple } from "./scene.ts";
import {
  Coloring,
  dotMaterial,
  lineGeometry,
  lineMaterial,
  setColor,
  setStyle,
  surfaceMaterial,
} from "./shaders.ts";
import type { Hit, Legend, Surroundings, View } from "./view.ts";
import { checkbox, choice, element, Slider, styleChoice } from "./widgets.ts";

type ColorBy = "radius" | "angle" | "sheet";
const coloringOf = { radius: Coloring.scalar, angle: Coloring.angle, sheet: Coloring.region };
const firstTheta = 60; // the default of blum medial
const curveReach = 0.012; // how far beside a curve a click hits it, as a fraction of the scene's radius

export class AxisView implements View {
  readonly item: AxisItem;
  readonly object = new THREE.Group();
  readonly controls = element("div", "controls");
  readonly #around: Surroundings;
  readonly #model: AxisModel;
  readonly #places: Float32Array; // in drawn coordinates
  readonly #corners: Float32Array; // for the model's triangles
  readonly #picker: Picker;
  readonly #surface = surfaceMaterial({ hasCells: true });
  readonly #geometry = new THREE.BufferGeometry();
  readonly #sheets = new THREE.Mesh(this.#geometry, this.#surface);
  readonly #coarseGeometry = new THREE.BufferGeometry();
  #coarse: Coarse | undefined;
  readonly #lines = {
    rims: new THREE.Mesh(new THREE.BufferGeometry(), lineMaterial([0.5, 0.5, 0.5], 1)),
    seams: new THREE.Mesh(new THREE.BufferGeometry(), lineMaterial([0.1, 0.1, 0.1], 2.2)),
    curves: new THREE.Mesh(new THREE.BufferGeometry(), lineMaterial([0.1, 0.1, 0.1], 4)),
  };
  readonly #junctions = new THREE.Points(new THREE.BufferGeometry(), dotMaterial([0.85, 0.2, 0.25], 6));
  readonly #loose = new THREE.Points(new THREE.BufferGeometry(), dotMaterial([0.85, 0.2, 0.25], 8));
  readonly #radii: [number, number];
  readonly #counts = element("p", "counts");
  #theta: number;
  #slider: Slider | undefined;
  #part: AxisPart;
  #colorBy: ColorBy = "radius";

  constructor(item: AxisItem, around: Surroundings) {
    this.item = item;
    this.#around = around;
    this.#model = new AxisModel(item);
    this.#theta = Math.max(item.leastTheta ?? 0, this.#model.isNested ? firstTheta : (item.theta ?? 0));
    this.#places = new Float32Array(item.positions.length);
    for (let i = 0; i < this.#places.length; ++i) this.#places[i] = item.positions[i] - around.center[i % 3];
    this.#corners = new Float32Array(3 * this.#model.triangles.length);
    this.#model.triangles.forEach((v, i) => this.#corners.set(this.#places.subarray(3 * v, 3 * v + 3), 3 * i));
    this.#picker = new Picker(this.#corners);
    this.#radii = rangeOf(item.radii);
    if (item.radii === undefined) this.#colorBy = "sheet";
    this.#fillGeometry();
    this.#part = this.#model.at(this.#theta);
    const parts = [this.#sheets, ...Object.values(this.#lines), this.#junctions, this.#loose];
    for (const part of parts) part.frustumCulled = false;
    this.object.add(...parts);
    this.#junctions.renderOrder = this.#loose.renderOrder = 3;
    this.#lines.rims.visible = false;
    this.#makeControls(this.#sheets);
    this.#applyColors();
    this.#showPart();
  }

  setTheta(theta: number): void {
    this.#theta = theta;
    this.#slider?.set(theta);
    this.#part = this.#model.at(theta);
    this.#showPart();
    this.#around.changed();
  }

  pick(ray: Ray): Hit | undefined {
    const curve = this.#pickCurve(ray);
    const hit = this.#picker.firstHit(ray, this.#part.triangles);
    if (hit !== undefined && (curve === undefined || hit.t < curve.t)) {
      const at = along(ray, hit.t);
      const corners = [...this.#model.triangles.subarray(3 * hit.triangle, 3 * hit.triangle + 3)];
      const vertex = corners.reduce((a, b) => (this.#distanceTo(at, a) <= this.#distanceTo(at, b) ? a : b));
      const triangle = this.#model.order[hit.triangle];
      const facts: Fact[] = [["triangle's separation angle", `${rounded(this.item.triangleAngles[triangle])}°`]];
      if (this.item.hasLabels) facts.push(["sheet", String(this.item.sheets[triangle])]);
      if (this.#model.isNested) facts.push(["there until theta", untilText(this.item.triangleUntil[triangle])]);
      return this.#hitAt(vertex, hit.t, facts);
    }
    return curve && this.#hitAt(curve.vertex, curve.t, []);
  }

  legends(): Legend[] {
    const { units } = this.item;
    switch (this.#colorBy) {
      case "radius":
        return [{ kind: "ramp", scale: "sequential", title: "radius", units, from: this.#radii[0], to: this.#radii[1] }];
      case "angle":
        return [{ kind: "ramp", scale: "sequential", title: "separation angle", units: "degrees", from: 0, to: 180 }];
      case "sheet":
        return [{ kind: "regions", title: "sheet", units: "", note: "one colour for each sheet" }];
    }
  }

  liveFacts(): Fact[] {
    const facts: Fact[] = [["shown", this.#countsText()]];
    if (this.#model.isNested) facts.unshift(["theta", `${rounded(this.#theta)} degrees`]);
    return facts;
  }

  setTheme(isDark: boolean): void {
    setColor(this.#lines.seams.material, isDark ? [0.96, 0.97, 1] : [0.1, 0.11, 0.16]);
    setColor(this.#lines.rims.material, isDark ? [0.6, 0.64, 0.7] : [0.45, 0.48, 0.53]);
    setColor(this.#lines.curves.material, isDark ? [0.96, 0.97, 1] : [0.1, 0.11, 0.16]);
    const dots: Triple = isDark ? [1, 0.45, 0.45] : [0.78, 0.13, 0.22];
    setColor(this.#junctions.material, dots);
    setColor(this.#loose.material, dots);
  }

  setMoving(isMoving: boolean): void {
    if (this.#model.order.length < worthCoarsening) return;
    if (this.#coarse === undefined) {
      this.#coarse = coarsen(this.#corners, undefined, this.#model.order.length);
      for (const name of ["position", "cell"]) {
        this.#coarseGeometry.setAttribute(name, this.#geometry.attributes[name]);
      }
      this.#coarseGeometry.setIndex(new THREE.BufferAttribute(this.#coarse.index, 1));
    }
    this.#coarseGeometry.setDrawRange(0, 3 * keptBelow(this.#coarse, this.#part.triangles));
    this.#sheets.geometry = isMoving ? this.#coarseGeometry : this.#geometry;
  }

  #fillGeometry(): void {
    const { radii, triangleAngles, sheets } = this.item;
    const count = this.#model.order.length;
    const cells = new Float32Array(9 * count);
    for (let i = 0; i < count; ++i) {
      const triangle = this.#model.order[i];
      for (let k = 0; k < 3; ++k) {
        const at = 9 * i + 3 * k;
        cells[at] = radii?.[this.#model.triangles[3 * i + k]] ?? 0;
        cells[at + 1] = triangleAngles[triangle];
        cells[at + 2] = sheets[triangle];
      }
    }
    this.#geometry.setAttribute("position", new THREE.BufferAttribute(this.#corners, 3));
    this.#geometry.setAttribute("cell", new THREE.BufferAttribute(cells, 3));
  }

  #makeControls(surface: THREE.Object3D): void {
    const changed = this.#around.changed;
    if (this.#model.isNested) {
      const least = this.item.leastTheta ?? 0;
      const slider = (this.#slider = new Slider("Theta", { min: least, max: 180, step: 0.5 }, this.#theta, (t) => this.setTheta(t), "°"));
      slider.root.classList.add("theta");
      this.controls.append(slider.root);
    }
    this.controls.append(this.#counts);
    const colors: (readonly [ColorBy, string])[] = [];
    if (this.item.radii) colors.push(["radius", "radius"]);
    colors.push(["angle", "angle"], ["sheet", "sheet"]);
    this.controls.append(
      choice<ColorBy>("Colour by", colors, this.#colorBy, (by) => {
        this.#colorBy = by;
        this.#applyColors();
        changed();
      }),
      styleChoice("Sheets", "solid", (style) => {
        setStyle(this.#surface, style, 0.35);
        surface.renderOrder = style === "translucent" ? 5 : 0;
        changed();
      }),
    );
    const toggles = element("div", "toggles");
    const toggle = (label: string, objects: THREE.Object3D[], isOn: boolean) =>
      toggles.append(
        checkbox(label, isOn, (value) => {
          for (const object of objects) object.visible = value;
          changed();
        }),
      );
    toggle("sheets", [surface], true);
    toggle("curves", [this.#lines.curves], true);
    toggle("seams", [this.#lines.seams], true);
    toggle("rims", [this.#lines.rims], false);
    toggle("junctions", [this.#junctions], true);
    this.controls.append(toggles);
  }

  #applyColors(): void {
    this.#surface.uniforms.coloring.value = coloringOf[this.#colorBy];
    const range = this.#colorBy === "angle" ? [0, 180] : this.#radii;
    this.#surface.uniforms.range.value.set(...range);
    const curves = this.#lines.curves.material;
    curves.uniforms.coloring.value = this.#colorBy === "radius" ? Coloring.scalar : Coloring.plain;
    curves.uniforms.range.value.set(...this.#radii);
  }

  /** Draws the part that exists at theta. */
  #showPart(): void {
    this.#geometry.setDrawRange(0, 3 * this.#part.triangles);
    const roles = this.item.roleNumbers;
    for (const [name, role] of [
      ["rims", roles.rim],
      ["seams", roles.seam],
      ["curves", roles.curve],
    ] as const) {
      const mesh = this.#lines[name];
      mesh.geometry.dispose();
      mesh.geometry = this.#linesOf(role);
    }
    for (const [points, vertices] of [
      [this.#junctions, this.#part.junctions],
      [this.#loose, this.#part.loose],
    ] as const) {
      points.geometry.dispose();
      points.geometry = new THREE.BufferGeometry();
      const places = new Float32Array(3 * vertices.length);
      vertices.forEach((v, i) => places.set(this.#places.subarray(3 * v, 3 * v + 3), 3 * i));
      points.geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    }
    this.#counts.textContent = this.#countsText();
  }

  #linesOf(role: number): THREE.BufferGeometry {
    const edges = this.#part.edges.filter((e) => this.item.edgeRoles[e] === role);
    const ends = new Float32Array(6 * edges.length);
    const values = new Float32Array(2 * edges.length);
    edges.forEach((e, i) => {
      for (let k = 0; k < 2; ++k) {
        const v = this.item.edges[2 * e + k];
        ends.set(this.#places.subarray(3 * v, 3 * v + 3), 6 * i + 3 * k);
        values[2 * i + k] = this.item.radii?.[v] ?? 0;
      }
    });
    return lineGeometry(ends, values);
  }

  #countsText(): string {
    const { triangles, sheets, curves, seams } = this.#part.counts;
    const junctions = this.#part.junctions.length;
    // Sheets keep their numbers at all angles, because they are not labelled again.
    const { leastTheta } = this.item;
    const told = leastTheta === undefined ? "" : ` (as they are at ${leastTheta}°)`;
    return (
      `${plural(triangles, "triangle")}${triangles > 0 && this.item.hasLabels ? ` in ${plural(sheets, "sheet")}${told}` : ""}, ` +
      `${plural(curves, "line segment")} on curves, ${counted(seams)} on seams, ${plural(junctions, "junction point")}`
    );
  }

  #distanceTo(p: Triple, vertex: number): number {
    return distance(p, tripleAt(this.#places, vertex));
  }

  #pickCurve(ray: Ray): { t: number; vertex: number } | undefined {
    const reach = curveReach * this.#around.radius;
    let best: { t: number; vertex: number } | undefined;
    const consider = (vertex: number) => {
      const from = sub(tripleAt(this.#places, vertex), ray.origin);
      const t = dot(from, ray.direction);
      const beside = Math.sqrt(Math.max(dot(from, from) - t * t, 0));
      if (t > 0 && beside < reach && (best === undefined || t < best.t)) best = { t, vertex };
    };
    for (const e of this.#part.edges) {
      if (this.item.edgeRoles[e] !== this.item.roleNumbers.curve) continue;
      consider(this.item.edges[2 * e]);
      consider(this.item.edges[2 * e + 1]);
    }
    this.#part.loose.forEach(consider);
    return best;
  }

  #hitAt(vertex: number, t: number, facts: Fact[]): Hit {
    const { item } = this;
    const list: Fact[] = [["vertex", String(vertex)]];
    if (item.radii) list.push(["radius", `${item.radii[vertex]} ${item.units}`]);
    if (item.angles) list.push(["separation angle", `${rounded(item.angles[vertex])}°`]);
    if (item.sites) {
      const names = [item.sites[2 * vertex], item.sites[2 * vertex + 1]].map((s) => (s < 0 ? "none" : String(s)));
      list.push([item.siteIds === "voxels" ? "voxels" : "sites", names.join(" and ")]);
    }
    const footprints: Triple[] = [];
    if (item.footprints) {
      footprints.push(tripleAt(item.footprints, 2 * vertex), tripleAt(item.footprints, 2 * vertex + 1));
    }
    const at = add(tripleAt(this.#places, vertex), this.#around.center);
    const radius = item.radii?.[vertex];
    const hit: Hit = { t, title: item.name, facts: [...list, ...facts], at, footprints };
    return radius === undefined ? hit : { ...hit, radius };
  }
}

function untilText(until: number): string {
  return Number.isFinite(until) ? `${rounded(until)}°` : "180°: it never goes";
}

function rangeOf(values: ArrayLike<number> | undefined): [number, number] {
  let least = Infinity;
  let most = -Infinity;
  for (let i = 0; i < (values?.length ?? 0); ++i) {
    least = Math.min(least, (values as ArrayLike<number>)[i]);
    most = Math.max(most, (values as ArrayLike<number>)[i]);
  }
  return least <= most ? [least, most] : [0, 1];
}
