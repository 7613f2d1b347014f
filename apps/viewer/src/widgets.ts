// Labelled controls.
import type { Style } from "./shaders.ts";

let nextId = 0;
const newId = (): string => `c${++nextId}`;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  className = "",
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  if (className) made.className = className;
  made.append(...children);
  return made;
}

export type Setter<T> = (value: T) => void;

export function checkbox(label: string, value: boolean, onChange: Setter<boolean>): HTMLElement {
  const input = element("input");
  input.type = "checkbox";
  input.checked = value;
  input.addEventListener("change", () => onChange(input.checked));
  return element("label", "check", input, element("span", "", label));
}

/** Returns a group of buttons of which one is pressed. */
export function choice<T extends string>(
  label: string,
  options: readonly (readonly [value: T, text: string])[],
  value: T,
  onChange: Setter<T>,
): HTMLElement {
  const group = element("fieldset", "choice", element("legend", "", label));
  const row = element("div", "segments");
  const name = newId();
  for (const [option, text] of options) {
    const input = element("input");
    input.type = "radio";
    input.name = name;
    input.value = option;
    input.checked = option === value;
    input.addEventListener("change", () => onChange(option));
    row.append(element("label", "", input, element("span", "", text)));
  }
  group.append(row);
  return group;
}

/** Returns the choice of a surface's style. */
export const styleChoice = (label: string, style: Style, onChange: Setter<Style>): HTMLElement =>
  choice<Style>(
    label,
    [
      ["solid", "solid"],
      ["translucent", "translucent"],
      ["wire", "wire"],
    ],
    style,
    onChange,
  );

/** Returns a list for choosing one entry. */
export function select(
  label: string,
  options: readonly (readonly [value: string, text: string])[],
  value: string,
  onChange: Setter<string>,
): HTMLElement {
  const list = element("select");
  list.setAttribute("aria-label", label);
  for (const [option, text] of options) {
    const entry = element("option", "", text);
    entry.value = option;
    entry.selected = option === value;
    list.append(entry);
  }
  list.addEventListener("change", () => onChange(list.value));
  return list;
}

export type Range = { min: number; max: number; step: number | "any" };

/** A slider with a field for the exact number. */
export class Slider {
  readonly root: HTMLElement;
  readonly #slider = element("input");
  readonly #field = element("input");
  readonly #onChange: Setter<number>;

  constructor(label: string, range: Range, value: number, onChange: Setter<number>, units = "") {
    this.#onChange = onChange;
    const id = newId();
    this.#slider.type = "range";
    this.#slider.id = id;
    this.#field.type = "number";
    this.#field.setAttribute("aria-label", `${label}, as a number`);
    this.setRange(range);
    this.set(value);
    this.#slider.addEventListener("input", () => this.#change(this.#slider.valueAsNumber));
    this.#field.addEventListener("change", () => this.#change(this.#field.valueAsNumber));
    const caption = element("label", "", label);
    caption.htmlFor = id;
    const row = element("div", "row", caption, this.#field);
    if (units) row.append(element("span", "units", units));
    this.root = element("div", "slider", row, this.#slider);
  }

  setRange(range: Range): void {
    for (const input of [this.#slider, this.#field]) {
      input.min = String(range.min);
      input.max = String(range.max);
    }
    this.#slider.step = range.step === "any" ? String((range.max - range.min) / 500 || 1) : String(range.step);
    this.#field.step = range.step === "any" ? "any" : String(range.step);
  }

  set(value: number): void {
    this.#slider.value = String(value);
    this.#field.value = String(Number(value.toPrecision(7)));
  }

  #change(value: number): void {
    if (!Number.isFinite(value)) return;
    const within = Math.min(Math.max(value, Number(this.#slider.min)), Number(this.#slider.max));
    this.set(within);
    this.#onChange(within);
  }
}

export function button(text: string, title: string, onClick: () => void): HTMLButtonElement {
  const made = element("button", "", text);
  made.type = "button";
  made.title = title;
  made.setAttribute("aria-label", title);
  made.addEventListener("click", onClick);
  return made;
}
