// The handle for dragging a slice. Arrow keys move it, too.
import type { Stage } from "./stage.ts";
import type { VolumeView } from "./volumeview.ts";
import { element } from "./widgets.ts";

export class Knob {
  readonly root = element("button", "knob");
  readonly #stage: Stage;
  readonly #view: VolumeView;

  constructor(stage: Stage, view: VolumeView) {
    this.#stage = stage;
    this.#view = view;
    this.root.type = "button";
    this.root.setAttribute("role", "slider");
    this.root.setAttribute("aria-label", `Layer of ${view.item.name}`);
    this.root.addEventListener("keydown", (event) => this.#onKey(event));
    this.root.addEventListener("pointerdown", (event) => this.#onPress(event));
  }

  /** Moves it to the slice. */
  place(): void {
    const { slice } = this.#view;
    const at = this.#stage.project(slice.handle().at);
    const box = this.#stage.canvas.getBoundingClientRect();
    this.root.hidden = at.isBehind || !slice.object.visible || !this.#view.object.visible;
    const inside = (value: number, size: number) => Math.min(Math.max(value, 16), size - 16);
    this.root.style.left = `${inside(at.x - box.left, box.width)}px`;
    this.root.style.top = `${inside(at.y - box.top, box.height)}px`;
    this.root.setAttribute("aria-valuemin", "0");
    this.root.setAttribute("aria-valuemax", String(slice.layers - 1));
    this.root.setAttribute("aria-valuenow", String(slice.layer));
  }

  #move(layer: number): void {
    this.#view.showLayer(this.#view.slice.axis, layer);
  }

  #onKey(event: KeyboardEvent): void {
    const { layer, layers } = this.#view.slice;
    const targets: Partial<Record<string, number>> = {
      ArrowUp: layer + 1,
      ArrowRight: layer + 1,
      ArrowDown: layer - 1,
      ArrowLeft: layer - 1,
      PageUp: layer + 10,
      PageDown: layer - 10,
      Home: 0,
      End: layers - 1,
    };
    const target = targets[event.key];
    if (target === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    this.#move(target);
  }

  #onPress(event: PointerEvent): void {
    event.preventDefault();
    this.root.focus();
    this.root.setPointerCapture(event.pointerId);
    const { slice } = this.#view;
    const { at, next } = slice.handle();
    const [from, to] = [this.#stage.project(at), this.#stage.project(next)];
    const step = { x: to.x - from.x, y: to.y - from.y };
    const squared = step.x ** 2 + step.y ** 2;
    const first = slice.layer;
    const onMove = (move: PointerEvent) => {
      // If layers are seen edge-on, dragging upwards moves forward.
      const layers =
        squared > 1e-4
          ? ((move.clientX - event.clientX) * step.x + (move.clientY - event.clientY) * step.y) / squared
          : (event.clientY - move.clientY) / 2;
      this.#move(first + layers);
    };
    const onEnd = () => {
      this.root.removeEventListener("pointermove", onMove);
      this.root.removeEventListener("pointerup", onEnd);
      this.root.removeEventListener("pointercancel", onEnd);
    };
    this.root.addEventListener("pointermove", onMove);
    this.root.addEventListener("pointerup", onEnd);
    this.root.addEventListener("pointercancel", onEnd);
  }
}
