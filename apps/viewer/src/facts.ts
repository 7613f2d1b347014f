// The key facts of all items as text, for screen readers and for browsers without WebGL 2.
import { place } from "./format.ts";
import type { Fact, Item } from "./scene.ts";
import { element } from "./widgets.ts";

const kinds: Record<Item["kind"], string> = {
  mesh: "mesh",
  field: "distance field",
  image: "image",
  axis: "medial axis",
  frames: "moving scene",
  map: "surface map",
  error: "not read",
};

export function kindName(item: Item): string {
  return item.kind === "axis" ? item.content : kinds[item.kind];
}

export function factsOf(item: Item): Fact[] {
  if (item.kind === "error") return [["problem", item.message]];
  const facts = [...item.facts];
  if (item.bounds) facts.push(["bounds", `${place(item.bounds.lower)} to ${place(item.bounds.upper)}`]);
  facts.push(["units", item.units]);
  return facts;
}

function listOf(facts: Fact[]): HTMLElement {
  const list = element("dl");
  for (const [label, text] of facts) list.append(element("dt", "", label), element("dd", "", text));
  return list;
}

/** Returns all facts below each other. `live` returns the facts that controls change. */
export function factsElement(items: Item[], live: (item: Item) => Fact[]): HTMLElement {
  const root = element("div");
  for (const item of items) {
    root.append(element("h3", "", `${item.name}: ${kindName(item)}`), listOf([...factsOf(item), ...live(item)]));
  }
  return root;
}
