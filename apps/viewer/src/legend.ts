// Legends of colours with units, on the page and in saved pictures.
import { cssColor, rampColor, type Colors } from "./colors.ts";
import { rounded } from "./format.ts";
import type { Legend } from "./view.ts";
import { element } from "./widgets.ts";

const steps = 24;
const digits = 4;

export const titleOf = (legend: Legend): string => (legend.units ? `${legend.title} (${legend.units})` : legend.title);

/** Returns the colours from end to end. Regions and keys have sharp borders. */
export function colorsOf(legend: Legend, colors: Colors): string[] {
  if (legend.kind === "regions") {
    return Array.from({ length: colors.regions.length / 4 }, (_, i) => cssColor(colors.regions, i));
  }
  if (legend.kind === "keys") return legend.entries.map((entry) => entry.color);
  return Array.from({ length: steps + 1 }, (_, i) => colorAt(legend, colors, i / steps));
}

function colorAt(legend: Extract<Legend, { kind: "ramp" }>, colors: Colors, t: number): string {
  switch (legend.scale) {
    case "grey":
      return `hsl(0 0% ${6 + 90 * t}%)`;
    case "sequential":
      return rampColor(colors.sequential, t);
    case "diverging": {
      const value = legend.from + (legend.to - legend.from) * t;
      const [inside, outside] = legend.extremes;
      return rampColor(colors.diverging, 0.5 + (0.5 * value) / (value < 0 ? inside : outside));
    }
  }
}

/** Returns the texts below the bar and their positions: 0 is its left end, 1 its right end. */
export function marksOf(legend: Legend): [text: string, at: number][] {
  if (legend.kind === "regions") return [[legend.note, 0]];
  if (legend.kind === "keys") {
    const { entries } = legend;
    return entries.map(({ text }, i) => [text, (i + 0.5) / entries.length]);
  }
  const { from, to } = legend;
  const marks: [string, number][] = [[rounded(from, digits), 0]];
  const zero = -from / (to - from);
  if (legend.scale === "diverging" && zero > 0.25 && zero < 0.75) marks.push(["0", zero]);
  marks.push([rounded(to, digits), 1]);
  return marks;
}

export function legendElement(legend: Legend, tables: Colors): HTMLElement {
  const bar = element("div", "bar");
  const colors = colorsOf(legend, tables);
  const stops =
    legend.kind !== "ramp"
      ? colors.map((color, i) => `${color} ${(100 * i) / colors.length}% ${(100 * (i + 1)) / colors.length}%`)
      : colors;
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const ends = element("div", "ends");
  for (const [text, at] of marksOf(legend)) {
    const mark = element("span", at > 0 && at < 1 ? "zero" : "", text);
    if (at > 0 && at < 1) mark.style.left = `${100 * at}%`;
    ends.append(mark);
  }
  return element("figure", "legend", element("figcaption", "", titleOf(legend)), bar, ends);
}
