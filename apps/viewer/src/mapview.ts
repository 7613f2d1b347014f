// A surface map on the stage: the mesh with its values, their histogram, and the worst places.
import * as THREE from "three";
import { coarsen, worthCoarsening } from "./coarse.ts";
import { rampColor } from "./colors.ts";
import { exactFloat32, place as placeText, plural, rounded } from "./format.ts";
import { add, along, distance, sub, tripleAt, type Ray } from "./geometry.ts";
import { Histogram } from "./histogram.ts";
import { MapModel } from "./mapmodel.ts";
import { markColor, valueTexture } from "./mapshader.ts";
import { Picker } from "./picker.ts";
import type { Fact, MapItem, Triple } from "./scene.ts";
import { setStyle, surfaceMaterial, type Style } from "./shaders.ts";
import { siteName } from "./sites.ts";
import type { Hit, Legend, Surroundings, View } from "./view.ts";
import { extremes } from "./volumeview.ts";
import { button, checkbox, choice, element, Slider, styleChoice } from "./widgets.ts";

const bins = 60;
const listed = 8; // number of worst places in the list
const apartBy = 0.12; // fraction of the mesh's radius; closer places count as one
const mark = `rgb(${markColor.map((c) => Math.round(255 * c)).join(" ")})`;
const nothing = "rgb(184 184 184)";

const ends: Record<string, { at: string; foot: string }> = {
  "ray-thickness": { at: "point", foot: "far side" },
  "ball-thickness": { at: "point", foot: "ball touches again" },
};

export class MapView implements View {
  readonly item: MapItem;
  readonly object = new THREE.Group();
  readonly controls = element("div", "controls");
  readonly model: MapModel;
  readonly #around: Surroundings;
  readonly #offset: Triple; // of the item's origin in drawn coordinates
  readonly #material = surfaceMaterial({ hasMap: true });
  readonly #whole = new THREE.BufferGeometry();
  readonly #surface = new THREE.Mesh(this.#whole, this.#material);
  readonly #title: string;
  readonly #range: [number, number]; // range of the values, never empty
  readonly #hasGaps: boolean;
  readonly #radius: number; // radius of the mesh
  readonly #worstPlaces = element("ol", "places");
  readonly #share = element("p", "counts");
  #colors: [number, number];
  #threshold: number | undefined;
  #isLargest: boolean;
  #picker: Picker | undefined;
  #coarse: THREE.BufferGeometry | undefined;
  #histogram: Histogram | undefined;
  #style: Style = "solid";

  constructor(item: MapItem, around: Surroundings) {
    this.item = item;
    this.#around = around;
    this.model = new MapModel(item);
    this.#offset = sub(item.origin, around.center);
    this.object.position.set(...this.#offset);
    this.#title = item.quantity.replaceAll("-", " ");
    const [least, most] = item.range ?? [0, 1];
    this.#range = [least, most > least ? most : least + Math.max(Math.abs(least) / 100, 1e-12)];
    this.#colors = [item.signed ? least : Math.min(0, least), this.#range[1]];
    this.#radius = item.bounds === null ? 1 : distance(item.bounds.lower, item.bounds.upper) / 2 || 1;
    this.#isLargest = item.quantity === "distance" && !item.signed;
    this.#hasGaps = item.distance.some((value, texel) => item.owners[texel] >= 0 && !Number.isFinite(value));
    this.#makeGeometry();
    this.#material.uniforms.values.value = valueTexture(item);
    this.#material.uniforms.size.value = [item.width, item.height];
    this.#showColors();
    this.#makeControls();
  }

  /** True if clicks prefer items inside. */
  get isSeenThrough(): boolean {
    return this.#style !== "solid";
  }

  pick(ray: Ray): Hit | undefined {
    const { positions, triangles } = this.item;
    this.#picker ??= new Picker(positions, triangles);
    const own: Ray = { origin: sub(ray.origin, this.#offset), direction: ray.direction };
    const hit = this.#picker.firstHit(own);
    if (hit === undefined) return undefined;
    const at = along(own, hit.t);
    const place = this.model.placeOf(hit.triangle, at);
    return this.#hitAt(this.model.texelAt(place), hit.triangle, hit.t, this.model.valueAt(place), at);
  }

  legends(): Legend[] {
    if (this.item.range === null) return [];
    const [from, to] = this.#colors;
    const ramp = { kind: "ramp", title: this.#title, units: this.item.units, from, to } as const;
    const legends: Legend[] = [
      this.item.signed ? { ...ramp, scale: "diverging", extremes: extremes(from, to) } : { ...ramp, scale: "sequential" },
    ];
    const entries: { text: string; color: string }[] = [];
    if (this.#threshold !== undefined) entries.push({ text: `at most ${rounded(this.#threshold, 4)}`, color: mark });
    if (this.#hasGaps) entries.push({ text: "none within reach", color: nothing });
    if (entries.length > 0) legends.push({ kind: "keys", title: "other colours", units: "", entries });
    return legends;
  }

  liveFacts(): Fact[] {
    if (this.item.range === null) return [];
    const facts: Fact[] = [["colours", `${rounded(this.#colors[0], 4)} to ${rounded(this.#colors[1], 4)}`]];
    if (this.#threshold !== undefined) facts.push([`at most ${rounded(this.#threshold, 4)}`, this.#share.textContent]);
    return facts;
  }

  setTheme(): void {
    this.#drawHistogram();
  }

  /** Uses fewer triangles, each with the places of its own chart. */
  setMoving(isMoving: boolean): void {
    const { positions, triangles, corners } = this.item;
    if (triangles.length < 3 * worthCoarsening) return;
    if (this.#coarse === undefined) {
      const { index, kept } = coarsen(positions, triangles, triangles.length / 3);
      const at = new Float32Array(3 * index.length);
      index.forEach((vertex, i) => at.set(tripleAt(positions, vertex), 3 * i));
      const places = new Float32Array(6 * kept.length);
      kept.forEach((t, i) => places.set(corners.subarray(6 * t, 6 * t + 6), 6 * i));
      this.#coarse = new THREE.BufferGeometry();
      this.#coarse.setAttribute("position", new THREE.BufferAttribute(at, 3));
      this.#coarse.setAttribute("place", new THREE.BufferAttribute(places, 2));
    }
    this.#surface.geometry = isMoving ? this.#coarse : this.#whole;
  }

  #makeGeometry(): void {
    const { positions, triangles, corners } = this.item;
    const at = new Float32Array(3 * triangles.length);
    for (let i = 0; i < triangles.length; ++i) {
      for (let a = 0; a < 3; ++a) at[3 * i + a] = positions[3 * triangles[i] + a];
    }
    this.#whole.setAttribute("position", new THREE.BufferAttribute(at, 3));
    this.#whole.setAttribute("place", new THREE.BufferAttribute(corners, 2));
    this.#surface.frustumCulled = false;
    this.object.add(this.#surface);
  }

  /** @param value  value at the place `at`. */
  #hitAt(texel: number, triangle: number, t: number, value: number, at: Triple): Hit {
    const { item } = this;
    const own = item.distance[texel];
    const facts: Fact[] = [];
    if (item.owners[texel] < 0 || !Number.isFinite(own)) {
      facts.push([this.#title, item.owners[texel] < 0 ? "no texel" : "none within reach"], ["triangle", String(triangle)]);
      return { t, title: item.name, facts, at: add(at, item.origin), footprints: [], labels: { at: "point", foot: "" } };
    }
    const bound = item.errors?.[triangle];
    const point = this.model.pointOf(texel);
    const closest = add(point, tripleAt(item.vectors, texel));
    facts.push([this.#title, `${exactFloat32(own)} ${item.units}`]);
    facts.push(["read here", rounded(value) + (bound === undefined ? "" : ` ± ${rounded(bound, 3)}`)]);
    if (distance(at, point) > 0) facts.push(["clicked at", placeText(add(at, item.origin))]);
    facts.push(["texel", `${texel % item.width}, ${Math.floor(texel / item.width)}`], ["triangle", String(triangle)]);
    const site = item.sites[texel];
    if (site >= 0) facts.push(["site", String(site)]);
    const name = item.quantity === "distance" ? undefined : siteName(site, item, closest, 1e-5 * this.#radius);
    if (name !== undefined) facts.push(["which is", name]);
    const hit: Hit = {
      t,
      title: item.name,
      facts,
      at: add(point, item.origin),
      footprints: [add(closest, item.origin)],
      labels: ends[item.quantity] ?? { at: "point", foot: "closest point" },
    };
    return item.quantity === "distance" && site >= 0 ? { ...hit, site } : hit;
  }

  #goTo(texel: number): void {
    const triangle = this.item.owners[texel];
    const point = this.model.pointOf(texel);
    const hit = this.#hitAt(texel, triangle, 0, this.item.distance[texel], point);
    this.#around.goTo(this, hit, this.model.normalOf(triangle), this.#radius);
  }

  #showColors(): void {
    const { uniforms } = this.#material;
    const [from, to] = this.#colors;
    uniforms.range.value.set(from, to);
    uniforms.isDiverging.value = this.item.signed;
    uniforms.extremes.value.set(...extremes(from, to));
    uniforms.isMarked.value = this.#threshold !== undefined;
    uniforms.threshold.value = this.#threshold ?? 0;
    this.#drawHistogram();
  }

  #colorOf(value: number): string {
    const { diverging, sequential } = this.#around.colors;
    const [from, to] = this.#colors;
    if (this.#threshold !== undefined && value <= this.#threshold) return mark;
    if (!this.item.signed) return rampColor(sequential, (value - from) / Math.max(to - from, 1e-30));
    const [inside, outside] = extremes(from, to);
    return rampColor(diverging, 0.5 + (0.5 * value) / (value < 0 ? inside : outside));
  }

  #drawHistogram(): void {
    this.#histogram?.draw((value) => this.#colorOf(value), this.#threshold);
  }

  #makeControls(): void {
    const { changed } = this.#around;
    this.controls.append(
      styleChoice("Surface", this.#style, (style) => {
        this.#style = style;
        setStyle(this.#material, style);
        this.#surface.renderOrder = style === "translucent" ? 10 : 0;
        changed();
      }),
    );
    if (this.item.range === null) {
      this.controls.append(element("p", "counts", "No texel has a value within reach."));
      return;
    }
    this.controls.append(
      checkbox("interpolate between texels", true, (isOn) => {
        this.#material.uniforms.isLinear.value = isOn;
        changed();
      }),
    );
    const tables = element("div", "group");
    this.controls.append(...this.#colorControls(), ...this.#thresholdControls(), tables);
    // Runs after the first picture, because it visits each texel.
    setTimeout(() => this.#fill(tables), 0);
  }

  #colorControls(): HTMLElement[] {
    const [from, to] = this.#colors;
    const range = { min: from, max: to, step: "any" } as const;
    const set = (end: 0 | 1) => (value: number) => {
      this.#colors[end] = value;
      this.#showColors();
      this.#around.changed();
    };
    const { units } = this.item;
    return [
      new Slider("Colours from", range, from, set(0), units).root,
      new Slider("Colours to", range, to, set(1), units).root,
    ];
  }

  #thresholdControls(): HTMLElement[] {
    const [least, most] = this.#range;
    let value = least + (most - least) / 4;
    const group = element("div", "group");
    group.hidden = true;
    const show = (isOn: boolean) => {
      group.hidden = !isOn;
      this.#threshold = isOn ? value : undefined;
      this.#showColors();
      if (isOn) {
        const { texels, part } = this.model.below(value);
        this.#share.textContent = `${plural(texels, "texel")}, ${rounded(100 * part, 3)} % of the surface`;
      }
      this.#around.changed();
    };
    const slider = new Slider("At most", { min: least, max: most, step: "any" }, value, (to) => {
      value = to;
      show(true);
    }, this.item.units);
    group.append(slider.root, this.#share);
    return [checkbox("mark small values", false, show), group];
  }

  #fill(tables: HTMLElement): void {
    const [from, to] = this.#range;
    this.#histogram = new Histogram("Area by value", this.item.units, from, to, this.model.histogram(from, to, bins));
    const order = choice<"largest" | "smallest">(
      "Places",
      [
        ["largest", "largest"],
        ["smallest", "smallest"],
      ],
      this.#isLargest ? "largest" : "smallest",
      (which) => {
        this.#isLargest = which === "largest";
        this.#listPlaces();
      },
    );
    tables.append(this.#histogram.root, order, this.#worstPlaces);
    new ResizeObserver(() => this.#drawHistogram()).observe(this.#histogram.root);
    this.#listPlaces();
    this.#drawHistogram();
  }

  #listPlaces(): void {
    const worst = this.model.worst(listed, this.#isLargest, apartBy * this.#radius);
    this.#worstPlaces.replaceChildren(
      ...worst.map((texel, i) => {
        const value = rounded(this.item.distance[texel], 4);
        const at = placeText(add(this.model.pointOf(texel), this.item.origin).map((x) => Number(x.toPrecision(3))));
        const go = button(value, `Place ${i + 1}: ${value} ${this.item.units}, look at it`, () => this.#goTo(texel));
        return element("li", "", go, element("span", "counts", at));
      }),
    );
  }
}

