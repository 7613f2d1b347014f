// The chart below a moving scene: stacked seconds of each stage over the frames.
import { rounded, roundStep } from "./format.ts";
import type { Stages } from "./scene.ts";

export type TimeUnit = { name: string; seconds: number };
export type ChartScale = {
  top: number; // seconds at the upper edge
  step: number; // seconds between lines
  unit: TimeUnit;
};

const units: TimeUnit[] = [
  { name: "s", seconds: 1 },
  { name: "ms", seconds: 1e-3 },
  { name: "µs", seconds: 1e-6 },
];

/** Returns the unit in which a time has digits before the decimal point. */
export function unitOf(seconds: number): TimeUnit {
  return units.find((unit) => seconds >= unit.seconds) ?? units[seconds > 0 ? 2 : 1];
}

export function timeText(seconds: number, unit = unitOf(seconds)): string {
  return Number.isFinite(seconds) ? `${rounded(seconds / unit.seconds, 3)} ${unit.name}` : "–";
}

/** Returns the seconds of all stages of a frame. Stages without a number count as 0. */
export function totalOf(stages: Stages, frame: number): number {
  const count = stages.names.length;
  let sum = 0;
  for (let s = 0; s < count; ++s) sum += stages.seconds[frame * count + s] || 0;
  return sum;
}

/** Returns a scale that fits the longest frame, with about three lines. */
export function chartScale(totals: readonly number[]): ChartScale {
  const most = totals.reduce((a, b) => Math.max(a, b), 0);
  const unit = unitOf(most);
  if (most === 0) return { top: 1e-3, step: 1e-3, unit };
  const step = roundStep(most, 3);
  return { top: Math.max(most * 1.04, step), step, unit };
}

/** Returns the drawn frames, one per column: the longest one of those that share a pixel. */
export function columnsOf(totals: readonly number[], pixels: number): number[] {
  const count = Math.max(Math.min(totals.length, Math.floor(pixels)), 1);
  const columns: number[] = [];
  for (let c = 0; c < count; ++c) {
    const end = Math.floor(((c + 1) * totals.length) / count);
    let best = Math.floor((c * totals.length) / count);
    for (let f = best + 1; f < end; ++f) if (totals[f] > totals[best]) best = f;
    columns.push(best);
  }
  return columns;
}

/** Returns the frame at a place of the plot; x is 0 at its left edge. */
export function frameAt(x: number, width: number, frames: number): number {
  const frame = Math.floor((x / Math.max(width, 1)) * frames);
  return Math.min(Math.max(frame, 0), frames - 1);
}

export const plotLeft = 52; // pixels: room for the labels of the lines
export const plotTop = 6;
const plotBottom = 4;

export type ChartColors = { stages: string[]; text: string; line: string };

/** Draws the bars and the lines. The mark of the current frame is another element, so it moves without redrawing. */
export class Chart {
  readonly canvas = document.createElement("canvas");
  readonly #stages: Stages;
  readonly #totals: number[];
  readonly #scale: ChartScale;

  constructor(stages: Stages, frames: number) {
    this.#stages = stages;
    this.#totals = Array.from({ length: frames }, (_, frame) => totalOf(stages, frame));
    this.#scale = chartScale(this.#totals);
  }

  /** The unit of the labels. */
  get unit(): TimeUnit {
    return this.#scale.unit;
  }

  draw(colors: ChartColors): void {
    const { canvas } = this;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = Math.max(Math.round(width * ratio), 1);
    canvas.height = Math.max(Math.round(height * ratio), 1);
    const context = canvas.getContext("2d");
    if (context === null || width <= plotLeft) return;
    context.scale(ratio, ratio);
    const high = height - plotTop - plotBottom;
    this.#drawLines(context, width, high, colors);
    this.#drawBars(context, width - plotLeft, high, colors);
  }

  #drawLines(context: CanvasRenderingContext2D, width: number, high: number, colors: ChartColors): void {
    const { top, step, unit } = this.#scale;
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.strokeStyle = colors.line;
    for (let k = 0; k * step <= top; ++k) {
      const y = Math.round(plotTop + high * (1 - (k * step) / top)) + 0.5;
      context.beginPath();
      context.moveTo(plotLeft, y);
      context.lineTo(width, y);
      context.stroke();
      context.fillStyle = colors.text;
      context.fillText(k === 0 ? "0" : timeText(k * step, unit), plotLeft - 6, Math.min(y, plotTop + high - 3));
    }
  }

  #drawBars(context: CanvasRenderingContext2D, width: number, high: number, colors: ChartColors): void {
    const columns = columnsOf(this.#totals, width);
    const wide = width / columns.length;
    const gap = wide > 4 ? 1 : 0;
    const count = this.#stages.names.length;
    columns.forEach((frame, c) => {
      let y = plotTop + high;
      for (let s = 0; s < count; ++s) {
        const tall = (high * (this.#stages.seconds[frame * count + s] || 0)) / this.#scale.top;
        context.fillStyle = colors.stages[s];
        context.fillRect(plotLeft + c * wide, y - tall, wide - gap, tall);
        y -= tall;
      }
    });
  }
}
