// The page: reads the scene, makes a view for each file, and adds controls beside the picture.
import { AxisView } from "./axisview.ts";
import { factsElement, kindName } from "./facts.ts";
import { FramesView } from "./framesview.ts";
import { frameKeyHelp, keyHelp, listen } from "./keys.ts";
import { Knob } from "./knob.ts";
import { legendElement } from "./legend.ts";
import { MapView } from "./mapview.ts";
import { Marker } from "./marker.ts";
import { MeshView } from "./meshview.ts";
import { pictureName, pictureWithLegends } from "./picture.ts";
import { Readout, withFootprint, withSiteName } from "./readout.ts";
import { readScene, type Box, type ErrorItem, type Item, type MeshItem, type Scene, type Triple } from "./scene.ts";
import { useColors } from "./shaders.ts";
import { sceneBytes } from "./source.ts";
import { Stage } from "./stage.ts";
import { ground, isDark, onTheme, toggleTheme } from "./theme.ts";
import type { Hit, Surroundings, View } from "./view.ts";
import { VolumeView } from "./volumeview.ts";
import { button, checkbox, element } from "./widgets.ts";

const byId = (id: string): HTMLElement => document.getElementById(id) as HTMLElement;
const panel = byId("panel");
const status = byId("status");

function boundsOf(items: readonly Item[]): Box | undefined {
  const box: Box = { lower: [Infinity, Infinity, Infinity], upper: [-Infinity, -Infinity, -Infinity] };
  for (const item of items) {
    if (item.kind === "error" || item.bounds === null) continue;
    for (let a = 0; a < 3; ++a) {
      box.lower[a] = Math.min(box.lower[a], item.bounds.lower[a]);
      box.upper[a] = Math.max(box.upper[a], item.bounds.upper[a]);
    }
  }
  return box.lower[0] <= box.upper[0] ? box : undefined;
}

function makeView(item: Exclude<Item, ErrorItem>, around: Surroundings, isAlone: boolean): View {
  switch (item.kind) {
    case "mesh":
      return new MeshView(item, around, isAlone);
    case "axis":
      return new AxisView(item, around);
    case "frames":
      return new FramesView(item, around);
    case "map":
      return new MapView(item, around);
    case "field":
    case "image":
      return new VolumeView(item, around);
  }
}

class Page {
  readonly #scene: Scene;
  readonly #stage: Stage;
  readonly #views: View[] = [];
  readonly #knobs: Knob[] = [];
  readonly #marker: Marker;
  readonly #readout = new Readout(() => this.#showHit(undefined));
  readonly #facts = element("div");
  #hitView: View | undefined; // view that the last click hit

  constructor(scene: Scene, stage: Stage) {
    this.#scene = scene;
    this.#stage = stage;
    this.#marker = new Marker(stage.center);
    stage.shown = () => boundsOf(this.#visible().map((view) => view.item));
    const items = scene.items.filter((item): item is Exclude<Item, ErrorItem> => item.kind !== "error");
    const around: Surroundings = {
      center: stage.center,
      radius: stage.radius,
      colors: scene.colors,
      changed: () => this.#changed(),
      moved: () => stage.moved(),
      forget: () => this.#showHit(undefined),
      goTo: (view, hit, from, size) => this.#goTo(view, hit, from, size),
    };
    for (const item of items) {
      const view = makeView(item, around, items.length === 1);
      this.#views.push(view);
      stage.scene.add(view.object);
      panel.append(this.#section(view));
      if (view instanceof VolumeView) {
        const knob = new Knob(stage, view);
        this.#knobs.push(knob);
        byId("stage").append(knob.root);
      }
      if (view instanceof FramesView) {
        byId("timeline").append(view.timeline.root);
        byId("timeline").hidden = false;
      }
    }
    stage.scene.add(this.#marker.object);
    byId("overlay").append(this.#readout.root);
    panel.append(factsDetails(this.#facts), helpDetails(items.some((item) => item.kind === "frames")));
    stage.onDraw = () => {
      for (const knob of this.#knobs) knob.place();
    };
    stage.onMoving = (isMoving) => {
      for (const view of this.#views) view.setMoving?.(isMoving);
    };
    listen(stage, (x, y) => this.click(x, y));
    onTheme((isDark) => {
      for (const view of this.#views) view.setTheme?.(isDark);
      stage.setBackground(ground());
    });
    this.#changed();
  }

  get views(): readonly View[] {
    return this.#views;
  }
  get stage(): Stage {
    return this.#stage;
  }

  /** Shows the item under a place of the page. */
  click(x: number, y: number): void {
    const ray = this.#stage.ray(x, y);
    let best: Hit | undefined;
    let seenThrough: Hit | undefined;
    const views = new Map<Hit, View>();
    for (const view of this.#views) {
      if (!view.object.visible) continue;
      const hit = view.pick(ray);
      if (hit === undefined) continue;
      views.set(hit, view);
      if ((view instanceof MeshView || view instanceof FramesView || view instanceof MapView) && view.isSeenThrough) {
        if (seenThrough === undefined || hit.t < seenThrough.t) seenThrough = hit;
      } else if (best === undefined || hit.t < best.t) {
        best = hit;
      }
    }
    best ??= seenThrough;
    const meshes = this.#meshes();
    this.#showHit(best && withSiteName(withFootprint(best, meshes), meshes));
    this.#hitView = best && views.get(best);
  }

  #goTo(view: View, hit: Hit, from: Triple, size: number): void {
    const at = hit.at.map((p, a) => p - this.#stage.center[a]) as Triple;
    this.#stage.fly(at, from, size);
    this.#showHit(withSiteName(hit, this.#meshes()));
    this.#hitView = view;
  }

  #meshes(): MeshItem[] {
    return this.#scene.items.filter((item) => item.kind === "mesh");
  }

  /** Saves the picture with its legends. */
  async savePicture(): Promise<void> {
    this.#stage.drawNow();
    const legends = this.#visible().flatMap((view) => view.legends());
    const link = element("a");
    link.href = URL.createObjectURL(await pictureWithLegends(this.#stage.canvas, legends, this.#scene.colors, isDark()));
    link.download = pictureName(this.#visible().map((view) => view.fileName ?? view.item.name));
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  #visible(): View[] {
    return this.#views.filter((view) => view.object.visible && view.isEmpty !== true);
  }

  #showHit(hit: Hit | undefined): void {
    this.#marker.show(hit);
    this.#readout.show(hit);
    this.#stage.draw();
  }

  #section(view: View): HTMLElement {
    const name = checkbox(view.item.name, true, (isOn) => {
      view.object.visible = isOn;
      view.controls.hidden = !isOn;
      this.#changed();
    });
    name.append(element("span", "kind", kindName(view.item)));
    return element("section", "item", element("h2", "", name), view.controls);
  }

  #changed(): void {
    const visible = this.#visible();
    if (this.#hitView !== undefined && !visible.includes(this.#hitView)) {
      this.#hitView = undefined;
      this.#showHit(undefined);
    }
    const legends = visible.flatMap((view) => view.legends());
    byId("legends").replaceChildren(...legends.map((legend) => legendElement(legend, this.#scene.colors)));
    const live = (item: Item) => this.#views.find((view) => view.item === item)?.liveFacts() ?? [];
    this.#facts.replaceChildren(factsElement(this.#scene.items, live));
    this.#stage.draw();
  }
}

function factsDetails(content: HTMLElement): HTMLElement {
  const details = element("details", "", element("summary", "", "Key facts as text"), content);
  details.id = "facts";
  return details;
}

function helpDetails(hasFrames: boolean): HTMLElement {
  const list = element("dl");
  for (const [keys, text] of hasFrames ? [...keyHelp, ...frameKeyHelp] : keyHelp) list.append(element("dt", "", element("kbd", "", keys)), element("dd", "", text));
  const touch = element("p", "counts", "Drag turns, two fingers or the right button move, the wheel or a pinch zooms; a click shows what is under the pointer. The round handle moves its slice.");
  return element("details", "", element("summary", "", "Keys and touch"), list, touch);
}

function header(onPicture: (() => void) | undefined, onReset: (() => void) | undefined): HTMLElement {
  const root = element("header", "", element("h1", "", "Blum"));
  if (onReset) root.append(button("Fit", "Look at all (0)", onReset));
  if (onPicture) root.append(button("Save PNG", "Save the picture as a PNG file", onPicture));
  root.append(button("Theme", "Dark or light", toggleTheme));
  const sheet = button("Controls", "Show or hide the controls", () => {
    sheet.setAttribute("aria-expanded", String(!panel.classList.toggle("closed")));
  });
  sheet.id = "sheet";
  sheet.setAttribute("aria-expanded", "true");
  root.append(sheet);
  return root;
}

function errorsElement(messages: string[]): HTMLElement {
  const list = element("ul");
  for (const message of messages) list.append(element("li", "", message));
  const root = element("section", "errors", element("h2", "", "Not shown"), list);
  root.setAttribute("role", "alert");
  return root;
}

/** Access to the page for tests. */
type Api = { isReady: boolean; milliseconds: number; page?: Page; scene?: Scene };
declare global {
  interface Window {
    blum: Api;
  }
}
window.blum = { isReady: false, milliseconds: 0 };

function showScene(scene: Scene): void {
  const problems = scene.items.filter((item) => item.kind === "error").map((item) => item.message);
  const names = scene.items.filter((item) => item.kind !== "error").map((item) => item.name);
  useColors(scene.colors);
  if (names.length > 0) document.title = `${names.join(", ")} – Blum`;
  let stage: Stage;
  try {
    stage = new Stage(
      byId("canvas") as HTMLCanvasElement,
      boundsOf(scene.items) ?? { lower: [-1, -1, -1], upper: [1, 1, 1] },
    );
  } catch (error) {
    problems.push(`This browser draws nothing here, as it has no WebGL 2 (${messageOf(error)}). The facts are below.`);
    panel.append(header(undefined, undefined), errorsElement(problems));
    const details = factsDetails(factsElement(scene.items, () => []));
    details.setAttribute("open", "");
    panel.append(details);
    status.textContent = "No picture: this browser has no WebGL 2.";
    onTheme(() => undefined);
    return;
  }
  let page: Page | undefined = undefined;
  panel.append(
    header(
      () => void page?.savePicture(),
      () => stage.look([0.55, -0.75, 0.42] as Triple),
    ),
  );
  if (problems.length > 0) panel.append(errorsElement(problems));
  status.hidden = names.length > 0;
  status.textContent = "None of the files could be read.";
  page = new Page(scene, stage);
  stage.begin();
  window.blum.page = page;
}

const messageOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

function showFailure(error: unknown): void {
  status.hidden = false;
  status.textContent = `The scene cannot be shown: ${messageOf(error)}`;
  panel.append(errorsElement([messageOf(error)]));
  onTheme(() => undefined);
}

try {
  onTheme(() => undefined);
  window.blum.scene = await readScene(await sceneBytes());
  showScene(window.blum.scene);
} catch (error) {
  showFailure(error);
}
window.blum.milliseconds = performance.now();
window.blum.isReady = true;
