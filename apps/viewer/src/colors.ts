// Colours, as apps/cli/colors.cpp has them, so that pictures and page agree.

export type Color = [number, number, number]; // sRGB, 0 to 1

type Stop = [lightness: number, chroma: number, hue: number];

const outside: Stop[] = [
  [0.965, 0.02, 215],
  [0.825, 0.075, 228],
  [0.68, 0.115, 243],
  [0.53, 0.13, 257],
  [0.385, 0.12, 268],
];
const inside: Stop[] = [
  [0.965, 0.035, 90],
  [0.855, 0.105, 78],
  [0.73, 0.15, 58],
  [0.59, 0.16, 42],
  [0.45, 0.13, 32],
];
const whole: Stop[] = [
  [0.965, 0.06, 105],
  [0.84, 0.125, 130],
  [0.71, 0.12, 168],
  [0.57, 0.1, 215],
  [0.43, 0.11, 265],
  [0.29, 0.11, 300],
];

function linear(lightness: number, a: number, b: number): Color {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

function gamma(value: number): number {
  const c = Math.min(Math.max(value, 0), 1);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
}

export function oklch(lightness: number, chroma: number, hue: number): Color {
  const angle = (hue * Math.PI) / 180;
  for (let step = 0; ; ++step, chroma *= 0.93) {
    const color = linear(lightness, chroma * Math.cos(angle), chroma * Math.sin(angle));
    if (step === 20 || color.every((c) => c >= -1e-4 && c <= 1.0001)) {
      return [gamma(color[0]), gamma(color[1]), gamma(color[2])];
    }
  }
}

function fromStops(stops: Stop[], t: number): Color {
  const at = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  const mixed = stops[i].map((value, part) => value + (stops[i + 1][part] - value) * (at - i));
  return oklch(mixed[0], mixed[1], mixed[2]);
}

/** t from -1 (deep inside) over 0 to 1 (far outside). */
export function divergingColor(t: number): Color {
  return t < 0 ? fromStops(inside, -t) : fromStops(outside, t);
}

export function sequentialColor(t: number): Color {
  return fromStops(whole, t);
}

export function scramble(x: number): number {
  x = Math.imul(x ^ (x >>> 16), 0x7feb352d);
  x = Math.imul(x ^ (x >>> 15), 0x846ca68b);
  return (x ^ (x >>> 16)) >>> 0;
}

const lightnesses = [0.66, 0.74, 0.81, 0.87];
const chromas = [0.07, 0.095, 0.115, 0.085];
export const paletteHues = 256;
export const paletteRows = 16;

/** All colours of regions: a row for each lightness and chroma, in which the hue runs. */
export function regionPalette(): Color[] {
  const colors: Color[] = [];
  for (let row = 0; row < paletteRows; ++row) {
    for (let hue = 0; hue < paletteHues; ++hue) {
      colors.push(oklch(lightnesses[row & 3], chromas[row >> 2], ((hue + 0.5) * 360) / paletteHues));
    }
  }
  return colors;
}

/** Where the colour of a region is in the palette. The shaders do the same. */
export function paletteIndex(id: number): number {
  const bits = scramble((id + 0x9e3779b9) | 0);
  return (bits & 15) * paletteHues + (bits >>> 24);
}

export function cssColor(color: Color): string {
  return `rgb(${color.map((c) => Math.round(255 * c)).join(" ")})`;
}
