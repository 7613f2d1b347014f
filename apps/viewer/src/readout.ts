// The result of a click as text, and its footprints on the meshes of the page.
import { place } from "./format.ts";
import { closestOnMesh, distance, sub } from "./geometry.ts";
import type { Fact, MeshItem } from "./scene.ts";
import { siteName } from "./sites.ts";
import type { Hit } from "./view.ts";
import { button, element } from "./widgets.ts";

/** Adds a footprint to a hit of a field. If a mesh has the field's distance there, its closest point is the footprint.
 * */
export function withFootprint(hit: Hit, meshes: MeshItem[]): Hit {
  if (hit.reach === undefined) return hit;
  for (const mesh of meshes) {
    const closest = closestOnMesh(sub(hit.at, mesh.origin), mesh.positions, mesh.triangles);
    if (closest === undefined) continue;
    const foot = [0, 1, 2].map((a) => closest[a] + mesh.origin[a]) as typeof closest;
    const slack = 1e-3 * Math.max(hit.reach, ...mesh.positions.subarray(0, 3).map(Math.abs)) + 1e-6;
    if (Math.abs(distance(foot, hit.at) - hit.reach) > slack) continue;
    const { about: _, ...rest } = hit;
    const kind: Fact[] = hit.feature === undefined ? [] : [["which is", featureName(hit.feature, mesh)]];
    return { ...rest, footprints: [foot], facts: [...hit.facts, ...kind, ["footprint is on", mesh.name]] };
  }
  return hit;
}

/** Adds a site's name to a hit of a surface map, if the footprint lies on that site of a mesh of the page. */
export function withSiteName(hit: Hit, meshes: MeshItem[]): Hit {
  if (hit.site === undefined || hit.footprints.length === 0) return hit;
  for (const mesh of meshes) {
    const closest = sub(hit.footprints[0], mesh.origin);
    const size = mesh.bounds === null ? 0 : distance(mesh.bounds.lower, mesh.bounds.upper);
    const name = siteName(hit.site, mesh, closest, 1e-5 * (size + distance(hit.at, hit.footprints[0])));
    if (name !== undefined) return { ...hit, facts: [...hit.facts, ["which is", `${name} of ${mesh.name}`]] };
  }
  return hit;
}

/** Returns the name of a site. Numbers count vertices first, then edges, then faces. */
export function featureName(site: number, mesh: MeshItem): string {
  const { vertices, edges } = mesh.counts;
  if (site < vertices) return `vertex ${site}`;
  return site < vertices + edges ? `edge ${site - vertices}` : `face ${site - vertices - edges}`;
}

export function readoutFacts(hit: Hit): Fact[] {
  const { at, foot } = hit.labels ?? { at: "place", foot: "footprint" };
  const facts: Fact[] = [...hit.facts, [at, place(hit.at)]];
  hit.footprints.forEach((p, i) => facts.push([hit.footprints.length > 1 ? `${foot} ${i + 1}` : foot, place(p)]));
  if (hit.footprints.length === 0 && hit.about) facts.push(["footprint", `about ${place(hit.about)}`]);
  return facts;
}

export class Readout {
  readonly root = element("section", "card readout");

  constructor(onClose: () => void) {
    this.root.setAttribute("aria-live", "polite");
    this.root.setAttribute("aria-label", "Under the pointer");
    this.root.hidden = true;
    this.#onClose = onClose;
  }
  readonly #onClose: () => void;

  show(hit: Hit | undefined): void {
    this.root.hidden = hit === undefined;
    if (hit === undefined) return this.root.replaceChildren();
    const list = element("dl");
    for (const [label, text] of readoutFacts(hit)) {
      const value = element("dd", "", text);
      value.dataset.fact = label;
      list.append(element("dt", "", label), value);
    }
    const close = button("×", "Close", this.#onClose);
    this.root.replaceChildren(element("header", "", element("h2", "", hit.title), close), list);
  }
}

