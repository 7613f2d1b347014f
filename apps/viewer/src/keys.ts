// Keys while the picture has the focus, and clicks on it.
import type { Triple } from "./scene.ts";
import type { Stage } from "./stage.ts";

const directions: Partial<Record<string, Triple>> = {
  "0": [0.55, -0.75, 0.42],
  "1": [1, 0, 0],
  "2": [0, 1, 0],
  "3": [0, 0, 1],
  "4": [-1, 0, 0],
  "5": [0, -1, 0],
  "6": [0, 0, -1],
  "7": [1, 1, 1],
};
const turn = Math.PI / 24;
const clickSlack = 5; // pixels between press and release

export function listen(stage: Stage, onClick: (x: number, y: number) => void): void {
  stage.canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const actions: Partial<Record<string, () => void>> = {
      ArrowLeft: () => stage.turn(-turn, 0),
      ArrowRight: () => stage.turn(turn, 0),
      ArrowUp: () => stage.turn(0, -turn),
      ArrowDown: () => stage.turn(0, turn),
      "+": () => stage.zoom(0.85),
      "=": () => stage.zoom(0.85),
      "-": () => stage.zoom(1 / 0.85),
      Enter: () => {
        const box = stage.canvas.getBoundingClientRect();
        onClick(box.left + box.width / 2, box.top + box.height / 2);
      },
    };
    const direction = directions[event.key];
    const action = direction ? () => stage.look(direction) : actions[event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  });
  let pressed: PointerEvent | undefined;
  stage.canvas.addEventListener("pointerdown", (event) => (pressed = event.isPrimary ? event : undefined));
  stage.canvas.addEventListener("pointerup", (event) => {
    if (pressed === undefined || event.button !== 0) return;
    const way = Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY);
    if (way <= clickSlack) onClick(event.clientX, event.clientY);
  });
}

export const keyHelp: readonly (readonly [keys: string, text: string])[] = [
  ["← → ↑ ↓", "turn"],
  ["+ −", "zoom"],
  ["1 … 7", "look along x, y, z, back, and from a corner"],
  ["0", "look at all"],
  ["Enter", "what is in the middle"],
];

/** Further keys of pages with a moving scene, see timeline.ts. */
export const frameKeyHelp: typeof keyHelp = [
  ["Space", "play and pause"],
  [", .", "frame before and after"],
  ["← →", "the same, while the slider of frames has the focus"],
];
