// Saved pictures of the stage, with legends.
import type { Colors } from "./colors.ts";
import { colorsOf, marksOf, titleOf } from "./legend.ts";
import type { Legend } from "./view.ts";

// In pixels of the page.
const margin = 12;
const padding = 12;
const width = 240;
const line = 16;
const bar = 10;
const height = 2 * padding + 2 * line + bar + 8;

/** Draws the legends into the lower left corner of a picture, side by side, in several rows if needed. */
export function drawLegends(
  canvas: HTMLCanvasElement,
  legends: Legend[],
  colors: Colors,
  scale: number,
  isDark: boolean,
): void {
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  const [wide, high] = [canvas.width / scale, canvas.height / scale];
  const perRow = Math.max(1, Math.floor((wide - margin) / (width + margin)));
  const rows = Math.ceil(legends.length / perRow);
  context.save();
  context.scale(scale, scale);
  context.textBaseline = "top";
  legends.forEach((legend, i) => {
    const left = margin + (i % perRow) * (width + margin);
    const top = high - (rows - Math.floor(i / perRow)) * (height + margin);
    context.fillStyle = isDark ? "rgb(30 34 40 / 92%)" : "rgb(255 255 255 / 92%)";
    context.strokeStyle = isDark ? "rgb(70 76 86)" : "rgb(214 218 224)";
    context.beginPath();
    context.roundRect(left, top, width, height, 10);
    context.fill();
    context.stroke();
    drawLegend(context, legend, colorsOf(legend, colors), left + padding, top + padding, isDark);
  });
  context.restore();
}

function drawLegend(
  context: CanvasRenderingContext2D,
  legend: Legend,
  colors: string[],
  left: number,
  top: number,
  isDark: boolean,
): void {
  const inner = width - 2 * padding;
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "left";
  context.fillStyle = isDark ? "rgb(232 236 242)" : "rgb(24 28 34)";
  context.fillText(titleOf(legend), left, top, inner);
  const step = inner / colors.length;
  colors.forEach((color, i) => {
    context.fillStyle = color;
    context.fillRect(left + i * step, top + line + 2, step + 0.5, bar);
  });
  context.fillStyle = isDark ? "rgb(168 176 188)" : "rgb(90 98 110)";
  for (const [text, at] of marksOf(legend)) {
    context.textAlign = at === 0 ? "left" : at === 1 ? "right" : "center";
    context.fillText(text, left + at * inner, top + line + bar + 6, inner);
  }
}

/** Returns the stage's picture with legends, as a PNG. */
export async function pictureWithLegends(
  stage: HTMLCanvasElement,
  legends: Legend[],
  colors: Colors,
  isDark: boolean,
): Promise<Blob> {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [stage.width, stage.height];
  (canvas.getContext("2d") as CanvasRenderingContext2D).drawImage(stage, 0, 0);
  drawLegends(canvas, legends, colors, stage.width / stage.clientWidth, isDark);
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture could be made"))), "image/png");
  });
}

/** Returns a file name for a picture of some files. */
export const pictureName = (names: string[]): string =>
  `${names.length > 0 ? names[0].replace(/\.(nii\.gz|[^.]*)$/, "") : "blum"}.png`;
