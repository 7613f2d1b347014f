// Legends of what is coloured, with units.
import { cssColor, divergingColor, paletteIndex, regionPalette, sequentialColor } from "./colors.ts";
import { rounded } from "./format.ts";
import type { Legend } from "./view.ts";
import { element } from "./widgets.ts";

const steps = 24;

export function legendElement(legend: Legend): HTMLElement {
  const root = element("figure", "legend");
  const title = legend.units ? `${legend.title} (${legend.units})` : legend.title;
  root.append(element("figcaption", "", title));
  const bar = element("div", "bar");
  if (legend.kind === "regions") {
    const palette = regionPalette();
    const colors = Array.from({ length: 12 }, (_, i) => cssColor(palette[paletteIndex(i)]));
    const stops = colors.map((color, i) => `${color} ${(100 * i) / 12}% ${(100 * (i + 1)) / 12}%`);
    bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
    root.append(bar, element("div", "ends", element("span", "", legend.note)));
    return root;
  }
  const { from, to } = legend;
  const isGrey = legend.title.includes("grey");
  const stops = Array.from({ length: steps + 1 }, (_, i) => {
    const value = from + ((to - from) * i) / steps;
    if (isGrey) return `hsl(0 0% ${6 + (90 * i) / steps}%)`;
    if (legend.scale === "sequential") return cssColor(sequentialColor(i / steps));
    return cssColor(divergingColor(value < 0 ? -value / from : value / to));
  });
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const ends = element("div", "ends", element("span", "", rounded(from)));
  const middle = -from / (to - from);
  if (legend.scale === "diverging" && middle > 0.25 && middle < 0.75) {
    const zero = element("span", "zero", "0");
    zero.style.left = `${100 * middle}%`;
    ends.append(zero);
  }
  ends.append(element("span", "", rounded(to)));
  root.append(bar, ends);
  return root;
}
