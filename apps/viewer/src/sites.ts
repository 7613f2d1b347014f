// Sites by number: vertices first, then edges in ascending order of (smaller, larger vertex), then triangles.
import { closestOnTriangle, distance, tripleAt } from "./geometry.ts";
import type { Triple } from "./scene.ts";

type Mesh = { positions: Float32Array; triangles: Uint32Array; segments?: Uint32Array };

const edges = new WeakMap<Mesh, Float64Array>();

/** Returns smaller * vertices + larger for each edge once, ascending. */
function edgesOf(mesh: Mesh): Float64Array {
  const known = edges.get(mesh);
  if (known !== undefined) return known;
  const { triangles, segments = new Uint32Array(0) } = mesh;
  const vertices = mesh.positions.length / 3;
  const keys = new Float64Array(triangles.length + segments.length / 2);
  const key = (a: number, b: number) => Math.min(a, b) * vertices + Math.max(a, b);
  triangles.forEach((v, i) => (keys[i] = key(v, triangles[i % 3 === 2 ? i - 2 : i + 1])));
  for (let s = 0; s < segments.length / 2; ++s) keys[triangles.length + s] = key(segments[2 * s], segments[2 * s + 1]);
  keys.sort();
  const distinct = keys.filter((k, i) => i === 0 || k !== keys[i - 1]);
  edges.set(mesh, distinct);
  return distinct;
}

/**
 * Returns the name of a site if the closest point, relative to the mesh's origin, lies on it. A number alone does not
 * identify the mesh.
 */
export function siteName(site: number, mesh: Mesh, closest: Triple, slack: number): string | undefined {
  const { positions, triangles } = mesh;
  const vertices = positions.length / 3;
  const on = (a: number, b: number, c: number): boolean => {
    const [p, q, r] = [a, b, c].map((v) => tripleAt(positions, v));
    return distance(closestOnTriangle(closest, p, q, r), closest) <= slack;
  };
  if (site < 0) return undefined;
  if (site < vertices) return on(site, site, site) ? `vertex ${site}` : undefined;
  const keys = edgesOf(mesh);
  if (site < vertices + keys.length) {
    const edge = site - vertices;
    const [a, b] = [Math.floor(keys[edge] / vertices), keys[edge] % vertices];
    return on(a, b, b) ? `edge ${edge} (vertices ${a}, ${b})` : undefined;
  }
  const face = site - vertices - keys.length;
  if (3 * face >= triangles.length) return undefined;
  return on(triangles[3 * face], triangles[3 * face + 1], triangles[3 * face + 2]) ? `face ${face}` : undefined;
}
