// Colours, which come with the scene: apps/cli/common/colors.cpp makes them, so that pictures and page agree.

export type Color = [number, number, number]; // sRGB, 0 to 1

/** Tables of red, green, blue and opacity in a byte each. */
export type Colors = {
  diverging: Uint8Array; // from deep inside over 0 to far outside
  sequential: Uint8Array;
  palette: Uint8Array; // of regions, as shaders.ts looks them up
  regions: Uint8Array; // those of the first regions
};

/** A colour of a table for CSS; those between its entries are mixed. */
export function cssColor(table: Uint8Array, entry: number): string {
  const low = Math.floor(entry);
  const high = Math.ceil(entry);
  const parts = [0, 1, 2].map((k) => table[4 * low + k] + (table[4 * high + k] - table[4 * low + k]) * (entry - low));
  return `rgb(${parts.map(Math.round).join(" ")})`;
}

/** @param t  from 0, the first colour, to 1, the last one. */
export function rampColor(ramp: Uint8Array, t: number): string {
  return cssColor(ramp, Math.min(Math.max(t, 0), 1) * (ramp.length / 4 - 1));
}

// Of things that are told apart side by side, as stages in a chart: hues far from each other, in turn dark and light.
const stageHues = [250, 75, 160, 330, 110, 30, 200, 290]; // degrees
const stageRows = [8, 10]; // of the palette
const paletteHues = 256;

export function stageColor(palette: Uint8Array, stage: number): string {
  const hue = Math.round((stageHues[stage % stageHues.length] * paletteHues) / 360);
  return cssColor(palette, stageRows[stage % stageRows.length] * paletteHues + hue);
}
