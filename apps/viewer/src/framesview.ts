// A moving scene on the stage: one mesh whose buffers are refilled for each frame, and the pairs of the frame.
import * as THREE from "three";
import { coarsen } from "./coarse.ts";
import { plural, rounded } from "./format.ts";
import { capacityOf, vertexNormals } from "./framesmodel.ts";
import { add, sub, tripleAt, type Ray } from "./geometry.ts";
import { surfaceHit } from "./meshview.ts";
import { PairsView } from "./pairsview.ts";
import { Picker } from "./picker.ts";
import type { Fact, FramesItem, PairTable, Triple } from "./scene.ts";
import { setColor, setStyle, surfaceMaterial, type Style } from "./shaders.ts";
import { Timeline } from "./timeline.ts";
import type { Hit, Legend, Surroundings, View } from "./view.ts";
import { checkbox, choice, element, styleChoice } from "./widgets.ts";

const light: Triple = [0.66, 0.72, 0.79];
const dark: Triple = [0.62, 0.68, 0.76];
const worthCoarsening = 20_000; // triangles: less than for one mesh, because each frame is a whole picture
const pairReach = 0.012; // how far beside a pair a click hits it, as a fraction of the scene's radius

type ColorBy = "distance" | "kind";

export class FramesView implements View {
  readonly item: FramesItem;
  readonly object = new THREE.Group();
  readonly controls = element("div", "controls");
  readonly timeline: Timeline;
  readonly #around: Surroundings;
  readonly #offset: Triple; // of the item's origin in drawn coordinates
  readonly #geometry = new THREE.BufferGeometry();
  readonly #material = surfaceMaterial({ hasNormals: true, hasCreases: true });
  readonly #surface = new THREE.Mesh(this.#geometry, this.#material);
  readonly #pairs: PairsView | undefined;
  readonly #counts = element("p", "counts");
  #picker: { frame: number; of: Picker } | undefined;
  #mesh = -1; // mesh whose triangles are in the buffer
  readonly #coarseGeometry = new THREE.BufferGeometry();
  #coarseMesh = -1; // mesh whose triangles it has
  #isMoving = false;
  #style: Style = "solid";
  #colorBy: ColorBy = "kind";
  #isThrough = true;

  constructor(item: FramesItem, around: Surroundings) {
    this.item = item;
    this.#around = around;
    this.#offset = sub(item.origin, around.center);
    this.object.position.set(...this.#offset);
    this.#makeBuffers();
    this.#surface.frustumCulled = false;
    this.object.add(this.#surface);
    if (item.pairs !== undefined) {
      this.#pairs = new PairsView(item.pairs);
      this.object.add(this.#pairs.object);
      const [least, most] = item.pairs.range;
      if (most > least) this.#colorBy = "distance";
      this.#pairs.setByDistance(this.#colorBy === "distance");
    }
    this.timeline = new Timeline(
      item,
      around.colors,
      (frame) => this.#show(frame),
      () => around.changed(),
    );
    this.#makeControls();
    this.#fill(0);
  }

  get isSeenThrough(): boolean {
    return this.#style !== "solid";
  }
  get fileName(): string {
    return this.item.frames[this.timeline.frame].name;
  }

  pick(ray: Ray): Hit | undefined {
    const own: Ray = { origin: sub(ray.origin, this.#offset), direction: ray.direction };
    const { frame } = this.timeline;
    const { positions, mesh } = this.item.frames[frame];
    const triangles = this.item.meshes[mesh];
    if (this.#picker?.frame !== frame) this.#picker = { frame, of: new Picker(positions, triangles) };
    const { origin } = this.item;
    const surface = surfaceHit(this.#picker.of, { name: this.fileName, origin }, { positions, triangles }, ray, this.#offset);
    const pair = this.#pairs?.pick(own, pairReach * this.#around.radius);
    if (pair === undefined || this.item.pairs === undefined) return surface;
    // A click on a pair at the surface selects the pair, even if it lies slightly behind.
    const isHidden = surface !== undefined && surface.t < pair.t - pairReach * this.#around.radius;
    return isHidden && !this.#isThrough ? surface : this.#pairHit(this.item.pairs, pair.pair, pair.t);
  }

  legends(): Legend[] {
    const { pairs, units } = this.item;
    const view = this.#pairs;
    if (pairs === undefined || view === undefined) return [];
    const entries = view.kinds
      .filter((kind) => view.isShown(kind))
      .map((kind) => ({ text: pairs.kindNames[kind], color: view.color(kind) }));
    if (entries.length === 0) return [];
    const isByDistance = this.#colorBy === "distance";
    const legends: Legend[] = [{ kind: "keys", title: isByDistance ? "ends of pairs" : "pairs", units: "", entries }];
    if (isByDistance) {
      const [from, to] = pairs.range;
      legends.push({ kind: "ramp", scale: "sequential", title: "distance of pairs", units, from, to });
    }
    return legends;
  }

  liveFacts(): Fact[] {
    const { frame } = this.timeline;
    return [
      ["frame", `${frame + 1} of ${this.item.frames.length}: ${this.fileName}`],
      ["shown", this.#countsText()],
    ];
  }

  setTheme(isDark: boolean): void {
    setColor(this.#material, isDark ? dark : light);
    this.#pairs?.setTheme(isDark);
    this.timeline.setTheme();
  }

  setMoving(isMoving: boolean): void {
    this.#isMoving = isMoving;
    this.#chooseGeometry();
  }

  /** Uses fewer triangles if pictures take long. They are chosen once for all frames of a mesh. */
  #chooseGeometry(): void {
    const { positions, mesh } = this.item.frames[this.timeline.frame];
    const triangles = this.item.meshes[mesh];
    const isCoarse = this.#isMoving && triangles.length >= 3 * worthCoarsening;
    if (isCoarse && this.#coarseMesh !== mesh) {
      const { index } = coarsen(positions, triangles, triangles.length / 3);
      this.#coarseGeometry.setIndex(new THREE.BufferAttribute(index, 1));
      this.#coarseMesh = mesh;
    }
    this.#surface.geometry = isCoarse ? this.#coarseGeometry : this.#geometry;
  }

  #makeBuffers(): void {
    const { vertices, triangles } = capacityOf(this.item);
    for (const name of ["position", "normal"]) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * vertices), 3);
      this.#geometry.setAttribute(name, attribute.setUsage(THREE.DynamicDrawUsage));
      this.#coarseGeometry.setAttribute(name, attribute);
    }
    const index = new THREE.BufferAttribute(new Uint32Array(3 * triangles), 1);
    this.#geometry.setIndex(index.setUsage(THREE.DynamicDrawUsage));
  }

  /** Copies a frame into the buffers. */
  #fill(frame: number): void {
    const { positions, mesh } = this.item.frames[frame];
    const triangles = this.item.meshes[mesh];
    const { position, normal } = this.#geometry.attributes as Record<string, THREE.BufferAttribute>;
    position.array.set(positions);
    vertexNormals(positions, triangles, normal.array as Float32Array);
    for (const attribute of [position, normal]) upload(attribute, positions.length);
    if (mesh !== this.#mesh) {
      const index = this.#geometry.index as THREE.BufferAttribute;
      index.array.set(triangles);
      upload(index, triangles.length);
      this.#geometry.setDrawRange(0, triangles.length);
      this.#mesh = mesh;
      if (this.#isMoving) this.#chooseGeometry();
    }
    this.#pairs?.show(frame);
    this.#counts.textContent = this.#countsText();
  }

  #show(frame: number): void {
    this.#fill(frame);
    this.#around.forget(); // the hit belongs to the frame before
    this.#around.moved();
    if (!this.timeline.isPlaying) this.#around.changed();
  }

  #makeControls(): void {
    const { changed } = this.#around;
    this.controls.append(
      this.#counts,
      styleChoice("Surface", this.#style, (style) => {
        this.#style = style;
        setStyle(this.#material, style);
        this.#surface.renderOrder = style === "translucent" ? 10 : 0;
        changed();
      }),
    );
    if (this.#pairs !== undefined && this.item.pairs !== undefined) this.#addPairControls(this.#pairs, this.item.pairs);
  }

  #addPairControls(view: PairsView, pairs: PairTable): void {
    const { changed, forget } = this.#around;
    const toggles = element("div", "toggles");
    for (const kind of view.kinds) {
      const box = checkbox(pairs.kindNames[kind], true, (isOn) => {
        view.setShown(kind, isOn);
        forget();
        changed();
      });
      const swatch = element("span", "swatch");
      swatch.style.background = view.color(kind);
      box.append(swatch);
      toggles.append(box);
    }
    const through = checkbox("seen through surfaces", this.#isThrough, (isOn) => {
      this.#isThrough = isOn;
      view.setThrough(isOn);
      changed();
    });
    const colors = choice<ColorBy>(
      "Lines by",
      [
        ["distance", "distance"],
        ["kind", "kind"],
      ],
      this.#colorBy,
      (by) => {
        this.#colorBy = by;
        view.setByDistance(by === "distance");
        changed();
      },
    );
    toggles.append(through);
    this.controls.append(element("fieldset", "choice", element("legend", "", "Pairs"), toggles), colors);
  }

  #countsText(): string {
    const { mesh } = this.item.frames[this.timeline.frame];
    const texts = [plural(this.item.meshes[mesh].length / 3, "triangle")];
    const names = this.item.pairs?.kindNames ?? [];
    const counts = this.#pairs?.counts() ?? [];
    for (const kind of this.#pairs?.kinds ?? []) {
      texts.push(plural(counts[kind], names[kind] === "closest" ? "closest pair" : names[kind]));
    }
    return texts.join(", ");
  }

  #pairHit(pairs: PairTable, pair: number, t: number): Hit {
    const { frame } = this.timeline;
    const ends = [0, 1].map((k) => add(tripleAt(pairs.points, 2 * pair + k), this.item.origin));
    const facts: Fact[] = [
      ["frame", `${frame + 1}: ${this.fileName}`],
      ["distance", `${rounded(pairs.distances[pair])} ${this.item.units}`],
    ];
    if (!Number.isNaN(pairs.times[pair])) facts.push(["time", rounded(pairs.times[pair])]);
    const number = pair - pairs.first[frame];
    const title = `${pairs.kindNames[pairs.kinds[pair]]}, pair ${number}`;
    return { t, title, facts, at: ends[0], footprints: [ends[1]], labels: { at: "first end", foot: "second end" } };
  }
}

/** Uploads the first numbers of a buffer to the graphics card. */
function upload(attribute: THREE.BufferAttribute, count: number): void {
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, count);
  attribute.needsUpdate = true;
}
