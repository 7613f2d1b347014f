// Histogram of the values over a surface, with bars in their colours.
import { rounded } from "./format.ts";
import { element } from "./widgets.ts";

export class Histogram {
  readonly root = element("figure", "histogram");
  readonly #canvas = element("canvas");
  readonly #from: number;
  readonly #to: number;
  readonly #parts: Float64Array; // fractions of the area

  /** @param areas  area with values in each bin; bins have equal widths. */
  constructor(title: string, units: string, from: number, to: number, areas: Float64Array) {
    [this.#from, this.#to] = [from, to];
    const whole = areas.reduce((a, b) => a + b, 0) || 1;
    this.#parts = areas.map((area) => area / whole);
    this.#canvas.setAttribute("role", "img");
    this.#canvas.setAttribute("aria-label", `${title}: ${this.#summary(units)}`);
    const ends = element("div", "ends", element("span", "", rounded(from, 4)), element("span", "", rounded(to, 4)));
    this.root.append(element("figcaption", "", title), this.#canvas, ends);
  }

  /** @param threshold  marked by a line if defined. */
  draw(colorOf: (value: number) => string, threshold: number | undefined): void {
    const ratio = Math.min(window.devicePixelRatio, 2);
    const [width, height] = [this.#canvas.clientWidth, this.#canvas.clientHeight];
    this.#canvas.width = Math.max(Math.round(width * ratio), 1);
    this.#canvas.height = Math.max(Math.round(height * ratio), 1);
    const context = this.#canvas.getContext("2d");
    if (context === null || width === 0) return;
    context.scale(ratio, ratio);
    const most = this.#parts.reduce((a, b) => Math.max(a, b), 0) || 1;
    const bins = this.#parts.length;
    const line = getComputedStyle(this.root).color;
    this.#parts.forEach((part, i) => {
      if (part === 0) return;
      const tall = Math.max((part / most) * (height - 2), 1);
      context.fillStyle = colorOf(this.#from + ((i + 0.5) / bins) * (this.#to - this.#from));
      context.fillRect((i * width) / bins, height - tall, width / bins + 0.5, tall);
    });
    context.fillStyle = line;
    context.fillRect(0, height - 1, width, 1);
    if (threshold === undefined || threshold < this.#from || threshold > this.#to) return;
    context.fillRect(((threshold - this.#from) / (this.#to - this.#from)) * width - 1, 0, 2, height);
  }

  /** Returns a summary for screen readers. */
  #summary(units: string): string {
    let sum = 0;
    const bins = this.#parts.length;
    const middle = this.#parts.findIndex((part) => (sum += part) >= 0.5);
    const value = this.#from + ((middle + 0.5) / bins) * (this.#to - this.#from);
    return `from ${rounded(this.#from, 4)} to ${rounded(this.#to, 4)}, half of the area below ${rounded(value, 3)} ${units}`;
  }
}
