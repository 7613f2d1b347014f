// Controls below the picture of a moving scene: play, scrub, speed, and the chart of stages.
import { Chart, frameAt, plotLeft, timeText, totalOf } from "./chart.ts";
import { stageColor, type Colors } from "./colors.ts";
import { Player } from "./player.ts";
import type { FramesItem } from "./scene.ts";
import { button, checkbox, element, select } from "./widgets.ts";

const speeds = [1, 2, 5, 10, 15, 24, 30, 60];
const firstSpeed = 15;

/** Elements with their own use of keys: for typing, and those that the space bar presses. */
const typesItself = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement && target.matches("input:not([type=range]), select, textarea");
const isPressed = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement && target.matches("button, summary, select, input:not([type=range])");

export class Timeline {
  readonly root = element("div", "timeline");
  readonly #item: FramesItem;
  readonly #colors: Colors;
  readonly #onFrame: (frame: number) => void;
  readonly #onRest: () => void;
  readonly #player: Player;
  readonly #play = button("Play", "Play (space)", () => this.toggle());
  readonly #slider = element("input", "scrub");
  readonly #field = element("input", "number");
  readonly #file = element("span", "file");
  readonly #cursor = element("div", "cursor");
  readonly #seconds: HTMLElement[] = [];
  readonly #chart: Chart | undefined;
  #frame = 0;

  /**
   * @param onFrame  called when the frame changes.
   * @param onRest  called when playing ends.
   */
  constructor(item: FramesItem, colors: Colors, onFrame: (frame: number) => void, onRest: () => void) {
    this.#item = item;
    this.#colors = colors;
    this.#onFrame = onFrame;
    this.#onRest = onRest;
    this.#player = new Player(item.frames.length, firstSpeed);
    this.root.append(this.#transport());
    if (item.stages !== undefined) {
      this.#chart = new Chart(item.stages, item.frames.length);
      this.root.append(this.#plot(this.#chart), this.#stageList());
    }
    this.#showFrame();
    document.addEventListener("keydown", (event) => this.#onKey(event));
  }

  get frame(): number {
    return this.#frame;
  }
  get isPlaying(): boolean {
    return this.#player.isPlaying;
  }

  /** Stops at a frame. */
  goTo(frame: number): void {
    this.#rest();
    this.#set(Math.min(Math.max(Math.round(frame), 0), this.#item.frames.length - 1));
  }

  toggle(): void {
    if (this.#player.isPlaying) {
      this.#rest();
      return;
    }
    this.#player.play(this.#frame, performance.now());
    this.#showPlaying();
    this.#tick();
  }

  setTheme(): void {
    const style = getComputedStyle(document.documentElement);
    const color = (name: string) => style.getPropertyValue(name).trim();
    this.#chart?.draw({ stages: this.#stageColors(), text: color("--soft"), line: color("--line") });
  }

  #tick(): void {
    const frame = this.#player.at(performance.now());
    if (frame === undefined) return;
    this.#set(frame);
    if (this.#player.isPlaying) {
      requestAnimationFrame(() => this.#tick());
    } else {
      this.#showPlaying();
      this.#onRest();
    }
  }

  #rest(): void {
    if (!this.#player.isPlaying) return;
    this.#player.pause();
    this.#showPlaying();
    this.#onRest();
  }

  #set(frame: number): void {
    if (frame === this.#frame) return;
    this.#frame = frame;
    this.#showFrame();
    this.#onFrame(frame);
  }

  #showPlaying(): void {
    const isPlaying = this.#player.isPlaying;
    this.#play.textContent = isPlaying ? "Pause" : "Play";
    const title = isPlaying ? "Pause (space)" : "Play (space)";
    this.#play.title = title;
    this.#play.setAttribute("aria-label", title);
  }

  #showFrame(): void {
    const { frames, stages } = this.#item;
    this.#slider.value = this.#field.value = String(this.#frame + 1);
    this.#slider.setAttribute("aria-valuetext", `frame ${this.#frame + 1} of ${frames.length}`);
    this.#file.textContent = frames[this.#frame].name;
    this.#cursor.style.left = `${(100 * this.#frame) / frames.length}%`;
    if (stages === undefined) return;
    const count = stages.names.length;
    this.#seconds.forEach((text, s) => {
      const seconds = s < count ? stages.seconds[this.#frame * count + s] : totalOf(stages, this.#frame);
      text.textContent = timeText(seconds, this.#chart?.unit);
    });
  }

  #transport(): HTMLElement {
    const { length } = this.#item.frames;
    this.#slider.type = "range";
    this.#slider.setAttribute("aria-label", "Frame");
    this.#field.type = "number";
    this.#field.setAttribute("aria-label", "Frame, as a number");
    for (const input of [this.#slider, this.#field]) {
      input.min = "1";
      input.max = String(length);
      input.step = "1";
    }
    this.#slider.addEventListener("input", () => this.goTo(this.#slider.valueAsNumber - 1));
    this.#field.addEventListener("change", () => {
      if (Number.isFinite(this.#field.valueAsNumber)) this.goTo(this.#field.valueAsNumber - 1);
      this.#showFrame(); // the typed number may be invalid
    });
    const speed = select("Speed", speeds.map((s) => [String(s), `${s} frames/s`]), String(firstSpeed), (value) =>
      this.#player.setSpeed(Number(value), performance.now()),
    );
    const loop = checkbox("loop", true, (isOn) => (this.#player.isLooping = isOn));
    const number = element("span", "of", this.#field, `of ${length}`);
    return element("div", "transport", this.#play, this.#slider, number, this.#file, speed, loop);
  }

  #plot(chart: Chart): HTMLElement {
    const plot = element("div", "plot", this.#cursor);
    plot.style.left = `${plotLeft}px`;
    this.#cursor.style.width = `max(2px, ${100 / this.#item.frames.length}%)`;
    chart.canvas.setAttribute("role", "img");
    chart.canvas.setAttribute("aria-label", "Seconds of each stage over the frames; a click goes to a frame");
    const jump = (event: PointerEvent) => {
      const box = plot.getBoundingClientRect();
      this.goTo(frameAt(event.clientX - box.left, box.width, this.#item.frames.length));
    };
    plot.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      plot.setPointerCapture(event.pointerId);
      jump(event);
    });
    plot.addEventListener("pointermove", (event) => {
      if (plot.hasPointerCapture(event.pointerId)) jump(event);
    });
    new ResizeObserver(() => this.setTheme()).observe(chart.canvas);
    return element("div", "chart", chart.canvas, plot);
  }

  /** Returns the legend of the chart, with the numbers of the current frame. */
  #stageList(): HTMLElement {
    const list = element("dl", "stages");
    const colors = this.#stageColors();
    [...(this.#item.stages?.names ?? []), "all"].forEach((name, s) => {
      const swatch = element("span", "swatch");
      if (s < colors.length) swatch.style.background = colors[s];
      else swatch.hidden = true;
      const seconds = element("dd");
      this.#seconds.push(seconds);
      list.append(element("div", "", element("dt", "", swatch, name), seconds));
    });
    return list;
  }

  #stageColors(): string[] {
    return (this.#item.stages?.names ?? []).map((_, s) => stageColor(this.#colors.palette, s));
  }

  #onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.key === "," ? -1 : event.key === "." ? 1 : 0;
    if (step !== 0 && !typesItself(event.target)) this.goTo(this.#frame + step);
    else if (event.key === " " && !isPressed(event.target)) this.toggle();
    else return;
    event.preventDefault();
  }
}
