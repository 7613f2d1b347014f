// A field or an image on the stage: a movable slice and a level surface.
import * as THREE from "three";
import { coarsen, worthCoarsening } from "./coarse.ts";
import { exactFloat32, plural, rounded, roundStep } from "./format.ts";
import { dot, scale, sub, type Ray } from "./geometry.ts";
import { nodeIndex, toWorld } from "./grid.ts";
import { IsoSurfaces } from "./isosurface.ts";
import { Picker } from "./picker.ts";
import type { Fact, FieldItem, ImageItem, Triple } from "./scene.ts";
import { setColor, setStyle, SliceMode, surfaceMaterial } from "./shaders.ts";
import { Slice } from "./slice.ts";
import type { Surface } from "./surfacenets.ts";
import type { Hit, Legend, Surroundings, View } from "./view.ts";
import { checkbox, choice, element, Slider, styleChoice } from "./widgets.ts";

type Show = "distance" | "sites" | "labels" | "grey";
const axes = ["x", "y", "z"] as const;
const isoLight: Triple = [0.4, 0.62, 0.62];
const isoDark: Triple = [0.42, 0.68, 0.68];

export class VolumeView implements View {
  readonly item: FieldItem | ImageItem;
  readonly object = new THREE.Group();
  readonly controls = element("div", "controls");
  readonly slice: Slice;
  readonly #around: Surroundings;
  readonly #layerSlider: Slider;
  readonly #isoSlider: Slider;
  readonly #iso = new THREE.Mesh(new THREE.BufferGeometry(), surfaceMaterial({ hasNormals: true }));
  #whole = new THREE.BufferGeometry();
  #picker: Picker | undefined; // for the whole surface
  #coarse: THREE.BufferGeometry | undefined;
  #surfaces: IsoSurfaces | undefined;
  #show: Show;
  #level: number;
  #contour: number;
  #onSurface: (() => void) | undefined;

  constructor(item: FieldItem | ImageItem, around: Surroundings) {
    this.item = item;
    this.#around = around;
    const values = item.kind === "field" ? item.distance : item.values;
    const sites = item.kind === "field" ? item.sites : undefined;
    this.slice = new Slice(item.grid, values, sites, around.center);
    this.#show = item.kind === "field" ? "distance" : item.labels ? "labels" : "grey";
    const [least, most] = item.range ?? [0, 1];
    this.#level = item.kind === "field" ? (least < 0 && most > 0 ? 0 : (least + most) / 2) : (least + most) / 2;
    this.#contour = item.kind === "field" ? roundStep(most - least, 16) : 0;
    this.#iso.frustumCulled = false;
    // Drawn behind the field's mesh, where both surfaces coincide.
    this.#iso.material.polygonOffset = true;
    this.#iso.material.polygonOffsetFactor = 1;
    this.#iso.material.polygonOffsetUnits = 4;
    this.#iso.visible = false;
    this.#iso.matrixAutoUpdate = false;
    this.#iso.matrix.copy(this.#frame());
    this.object.add(this.slice.object, this.#iso);
    this.#layerSlider = new Slider(
      "Layer",
      { min: 0, max: this.slice.layers - 1, step: 1 },
      this.slice.layer,
      (layer) => this.showLayer(this.slice.axis, layer),
    );
    this.#isoSlider = new Slider(
      item.kind === "field" ? "At distance" : "At value",
      { min: least, max: most, step: "any" },
      this.#level,
      (level) => this.setLevel(level),
    );
    this.#setUniforms(least, most);
    this.#makeControls();
  }

  get isEmpty(): boolean {
    return !this.slice.object.visible && !this.#iso.visible;
  }

  /** Moves the slice. */
  showLayer(axis: number, layer: number): void {
    const isOtherAxis = axis !== this.slice.axis;
    this.slice.show(axis, layer);
    if (isOtherAxis) this.#layerSlider.setRange({ min: 0, max: this.slice.layers - 1, step: 1 });
    this.#layerSlider.set(this.slice.layer);
    this.#around.changed();
  }

  setLevel(level: number): void {
    this.#level = level;
    if (this.#iso.visible) this.#ask();
  }

  /** Resolves when the last requested level surface is shown. */
  async surfaceShown(): Promise<void> {
    if (this.#surfaces?.isBusy !== true) return;
    await new Promise<void>((resolve) => (this.#onSurface = resolve));
    await this.surfaceShown();
  }

  pick(ray: Ray): Hit | undefined {
    const hit = this.slice.object.visible ? this.slice.pick(ray) : undefined;
    const t = this.#pickSurface(ray);
    if (t !== undefined && (hit === undefined || t < hit.t)) {
      const at = [0, 1, 2].map((a) => ray.origin[a] + t * ray.direction[a] + this.#around.center[a]) as Triple;
      return {
        t,
        title: this.item.name,
        facts: [["surface", `at ${this.item.kind === "field" ? "distance" : "value"} ${rounded(this.#level)}`]],
        at,
        footprints: [],
      };
    }
    return hit && this.#hitAt(hit.node, hit.t);
  }

  legends(): Legend[] {
    if (!this.slice.object.visible) return [];
    const { item } = this;
    const [from, to] = item.range ?? [0, 1];
    switch (this.#show) {
      case "distance": {
        const title = this.#contour > 0 ? `distance, lines every ${rounded(this.#contour)}` : "distance";
        const common = { kind: "ramp", title, units: item.units, to } as const;
        if (item.kind !== "field" || !item.signed) return [{ ...common, scale: "sequential", from: 0 }];
        return [{ ...common, scale: "diverging", from, extremes: extremes(from, to) }];
      }
      case "sites":
        return [{ kind: "regions", title: "closest site", units: "", note: "one colour for each site" }];
      case "labels":
        return [{ kind: "regions", title: "label", units: "", note: "one colour for each value; 0 is pale" }];
      case "grey":
        return [{ kind: "ramp", scale: "grey", title: "value", units: "", from, to }];
    }
  }

  liveFacts(): Fact[] {
    const position = toWorld(this.item.grid, [0, 1, 2].map((a) => (a === this.slice.axis ? this.slice.layer : 0)) as Triple);
    const facts: Fact[] = [];
    if (this.slice.object.visible) {
      facts.push(["slice", `layer ${this.slice.layer} across ${axes[this.slice.axis]}, at ${rounded(position[this.slice.axis])}`]);
    }
    if (this.#iso.visible) {
      const triangles = (this.#whole.index?.count ?? 0) / 3;
      facts.push(["surface", `at ${rounded(this.#level)}: ${plural(triangles, "triangle")}`]);
    }
    return facts;
  }

  setTheme(isDark: boolean): void {
    setColor(this.#iso.material, isDark ? isoDark : isoLight);
    setColor(this.slice.frame, isDark ? [0.55, 0.6, 0.66] : [0.4, 0.45, 0.5]);
  }

  setMoving(isMoving: boolean): void {
    const { index, attributes } = this.#whole;
    if (index === null || index.count < 3 * worthCoarsening) return;
    if (this.#coarse === undefined) {
      const positions = attributes.position.array as Float32Array;
      this.#coarse = new THREE.BufferGeometry();
      for (const name of ["position", "normal"]) this.#coarse.setAttribute(name, attributes[name]);
      const coarse = coarsen(positions, index.array as Uint32Array, index.count / 3);
      this.#coarse.setIndex(new THREE.BufferAttribute(coarse.index, 1));
    }
    this.#iso.geometry = isMoving ? this.#coarse : this.#whole;
  }

  /** Returns the transform from the frame of level surfaces to drawn coordinates. */
  #frame(): THREE.Matrix4 {
    const { direction, origin } = this.item.grid;
    const [x, y, z] = direction.map((column) => new THREE.Vector3(...column));
    return new THREE.Matrix4().makeBasis(x, y, z).setPosition(...sub(origin, this.#around.center));
  }

  #setUniforms(least: number, most: number): void {
    const { uniforms } = this.slice.material;
    uniforms.mode.value = SliceMode[this.#show];
    uniforms.contour.value = this.#contour;
    uniforms.range.value.set(least, most);
    const [inside, outside] = extremes(least, most);
    uniforms.extremes.value.set(inside, outside);
    if (this.item.kind === "field") {
      uniforms.hasSign.value = this.item.signed;
      uniforms.band.value = this.item.band ?? 0;
    } else {
      uniforms.isLinear.value = false;
    }
  }

  #makeControls(): void {
    const { item, slice } = this;
    const { uniforms } = slice.material;
    const changed = this.#around.changed;
    this.controls.append(
      checkbox("slice", true, (isOn) => {
        slice.object.visible = isOn;
        inSlice.hidden = !isOn;
        changed();
      }),
    );
    const inSlice = element("div", "group");
    if (item.kind === "field" && item.sites !== undefined) {
      inSlice.append(
        choice<Show>(
          "Show",
          [
            ["distance", "distance"],
            ["sites", "sites"],
          ],
          this.#show,
          (show) => this.#setShow(show),
        ),
      );
    } else if (item.kind === "image") {
      inSlice.append(
        choice<Show>(
          "Show",
          [
            ["labels", "labels"],
            ["grey", "grey"],
          ],
          this.#show,
          (show) => this.#setShow(show),
        ),
      );
    }
    inSlice.append(
      choice(
        "Across",
        axes.map((axis) => [axis, axis] as const),
        axes[slice.axis],
        (axis) => {
          const a = axes.indexOf(axis);
          this.showLayer(a, Math.floor((item.grid.size[a] - 1) / 2));
        },
      ),
      this.#layerSlider.root,
    );
    if (item.kind === "field") {
      const most = Math.max(this.#contour * 5, 1e-12);
      const contour = new Slider("Lines every", { min: 0, max: most, step: "any" }, this.#contour, (step) => {
        this.#contour = step;
        uniforms.contour.value = step;
        changed();
      });
      inSlice.append(
        contour.root,
        checkbox("interpolate between nodes", true, (isOn) => {
          uniforms.isLinear.value = isOn;
          changed();
        }),
      );
    }
    const style = styleChoice("Surface", "solid", (value) => {
      setStyle(this.#iso.material, value, 0.25);
      this.#iso.renderOrder = value === "translucent" ? 8 : 0;
      changed();
    });
    const inSurface = element("div", "group", this.#isoSlider.root, style);
    inSurface.hidden = true;
    this.controls.append(
      inSlice,
      checkbox("level surface", false, (isOn) => {
        this.#iso.visible = isOn;
        inSurface.hidden = !isOn;
        if (isOn) this.#ask();
        changed();
      }),
      inSurface,
    );
  }

  #setShow(show: Show): void {
    this.#show = show;
    this.slice.material.uniforms.mode.value = SliceMode[show];
    this.#around.changed();
  }

  #ask(): void {
    const { item } = this;
    const { spacing, size } = item.grid;
    this.#surfaces ??= new IsoSurfaces(
      item.kind === "field" ? item.distance : Float32Array.from(item.values),
      size,
      spacing,
      (surface) => this.#showSurface(surface),
    );
    this.#surfaces.ask(this.#level);
  }

  #showSurface(surface: Surface): void {
    this.#whole.dispose();
    this.#coarse?.dispose();
    this.#coarse = undefined;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(surface.positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(surface.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
    this.#whole = geometry;
    this.#picker = undefined;
    this.#iso.geometry = geometry;
    this.#around.changed();
    this.#onSurface?.();
    this.#onSurface = undefined;
  }

  #pickSurface(ray: Ray): number | undefined {
    const { index, attributes } = this.#whole;
    if (!this.#iso.visible || index === null) return undefined;
    const { direction, origin } = this.item.grid;
    const from = sub(ray.origin, sub(origin, this.#around.center));
    const own: Ray = {
      origin: direction.map((column) => dot(column, from)) as Triple,
      direction: direction.map((column) => dot(column, ray.direction)) as Triple,
    };
    this.#picker ??= new Picker(attributes.position.array as Float32Array, index.array as Uint32Array);
    return this.#picker.firstHit(own)?.t;
  }

  #hitAt(node: Triple, t: number): Hit {
    const { item } = this;
    const index = nodeIndex(item.grid, node);
    const at = toWorld(item.grid, node);
    const facts: Fact[] = [["node", `${node.join(", ")} (x, y, z)`]];
    const footprints: Triple[] = [];
    if (item.kind === "image") {
      facts.push(["value", String(item.values[index])]);
    } else {
      facts.push(["distance", `${exactFloat32(item.distance[index])} ${item.units}`]);
      const site = item.sites?.[index];
      if (site !== undefined) {
        const name = item.siteIds === "voxels" ? "closest voxel" : item.siteIds === "triangles" ? "closest triangle" : "site";
        facts.push([name, site < 0 ? "none: beyond the band" : String(site)]);
        // A voxel's number gives its position.
        if (item.siteIds === "voxels" && site >= 0) footprints.push(this.#nodeAt(site));
      }
    }
    const hit: Hit = { t, title: item.name, facts, at, footprints };
    const site = item.kind === "field" && item.siteIds === "features" ? (item.sites?.[index] ?? -1) : -1;
    if (site >= 0) hit.feature = site;
    return item.kind === "field" && footprints.length === 0 ? { ...hit, ...this.#estimate(node, index) } : hit;
  }

  #nodeAt(index: number): Triple {
    const [nx, ny] = this.item.grid.size;
    return toWorld(this.item.grid, [index % nx, Math.floor(index / nx) % ny, Math.floor(index / (nx * ny))]);
  }

  /** Estimates the footprint along the slope of the distance. The page replaces it by that on a mesh, if possible. */
  #estimate(node: Triple, index: number): { about?: Triple; reach: number } {
    const { grid, distance } = this.item as FieldItem;
    const strides = [1, grid.size[0], grid.size[0] * grid.size[1]];
    let slope: Triple = [0, 0, 0];
    for (let a = 0; a < 3; ++a) {
      const low = node[a] > 0 ? 1 : 0;
      const high = node[a] < grid.size[a] - 1 ? 1 : 0;
      if (low + high === 0) continue;
      const change = (distance[index + high * strides[a]] - distance[index - low * strides[a]]) / ((low + high) * grid.spacing[a]);
      slope = [0, 1, 2].map((c) => slope[c] + change * grid.direction[a][c]) as Triple;
    }
    const length = Math.hypot(...slope);
    const reach = Math.abs(distance[index]);
    if (!(length > 0.5)) return { reach };
    const at = toWorld(grid, node);
    return { about: sub(at, scale(slope, distance[index] / length)), reach };
  }
}

/** Returns a scale for each side, at most four times the other one, as in pictures of `blum slice`. */
export function extremes(least: number, most: number): [inside: number, outside: number] {
  const deepest = Math.max(0, -least);
  const farthest = Math.max(0, most);
  const largest = Math.max(deepest, farthest, 1e-30);
  return [Math.max(deepest, largest / 4), Math.max(farthest, largest / 4)];
}
