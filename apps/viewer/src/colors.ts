// Colours. The scene contains them, made by apps/cli/common/colors.cpp, so that pictures and page agree.

export type Color = [number, number, number]; // sRGB, 0 to 1

/** Tables of red, green, blue and opacity, one byte each. */
export type Colors = {
  diverging: Uint8Array; // from deep inside over 0 to far outside
  sequential: Uint8Array;
  palette: Uint8Array; // for regions, indexed as in shaders.ts
  regions: Uint8Array; // of the first regions
};

/** Returns a colour of a table for CSS. Colours between entries are mixed. */
export function cssColor(table: Uint8Array, entry: number): string {
  const low = Math.floor(entry);
  const high = Math.ceil(entry);
  const parts = [0, 1, 2].map((k) => table[4 * low + k] + (table[4 * high + k] - table[4 * low + k]) * (entry - low));
  return `rgb(${parts.map(Math.round).join(" ")})`;
}

/** @param t  0 for the first colour to 1 for the last one. */
export function rampColor(ramp: Uint8Array, t: number): string {
  return cssColor(ramp, Math.min(Math.max(t, 0), 1) * (ramp.length / 4 - 1));
}

// Colours of stages in a chart: hues far from each other, alternately dark and light.
const stageHues = [250, 75, 160, 330, 110, 30, 200, 290]; // degrees
const stageRows = [8, 10]; // rows of the palette
const paletteHues = 256;

export function stageColor(palette: Uint8Array, stage: number): string {
  const hue = Math.round((stageHues[stage % stageHues.length] * paletteHues) / 360);
  return cssColor(palette, stageRows[stage % stageRows.length] * paletteHues + hue);
}
