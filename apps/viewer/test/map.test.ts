// Proves that surface maps read back as the tool writes them. Values, points and areas of texels must agree with the
// texture. The worst places must have the largest values, and sites must get names only where they are.
import { describe, expect, it } from "vitest";
import { MapModel } from "../src/mapmodel.ts";
import { withSiteName } from "../src/readout.ts";
import { readScene, type MapItem, type MeshItem, type Triple } from "../src/scene.ts";
import { siteName } from "../src/sites.ts";
import type { Hit } from "../src/view.ts";
import { sceneOf } from "./scene_bytes.ts";

const side = 16; // texels along the square
const gap = 2; // around it
const width = side + 2 * gap;
const infinite = 3 * width + 3; // a texel without a value, where it is asked for

/** A square from (0, 0) to (2, 2) at height 1, in two triangles that share a chart, and values of its places. */
function squareMap(valueOf: (x: number, y: number) => number, isGapped = false): MapItem {
  const distance = new Float32Array(width * width).fill(NaN);
  const owners = new Int32Array(width * width).fill(-1);
  for (let j = gap - 1; j <= gap + side; ++j) {
    for (let i = gap - 1; i <= gap + side; ++i) {
      const [x, y] = [i, j].map((k) => ((k + 0.5 - gap) * 2) / side);
      distance[j * width + i] = valueOf(x, y);
      owners[j * width + i] = y < x ? 0 : 1;
    }
  }
  if (isGapped) distance[infinite] = Infinity;
  const [low, high] = [gap, gap + side];
  return {
    kind: "map",
    name: "a.npz",
    units: "mm",
    facts: [],
    bounds: { lower: [0, 0, 1], upper: [2, 2, 1] },
    quantity: "distance",
    signed: false,
    origin: [0, 0, 0],
    width,
    height: width,
    range: [0, 8],
    positions: Float32Array.from([0, 0, 1, 2, 0, 1, 2, 2, 1, 0, 2, 1]),
    triangles: Uint32Array.from([0, 1, 2, 0, 2, 3]),
    corners: Float32Array.from([low, low, high, low, high, high, low, low, high, high, low, high]),
    distance,
    vectors: new Float32Array(3 * width * width),
    sites: new Int32Array(width * width),
    owners,
    errors: undefined,
  };
}
const plane = (x: number, y: number) => 1 + x + 2 * y;

describe("a surface map", () => {
  it("reads back from a scene, with and without bounds of errors", async () => {
    const item = squareMap(plane);
    const parts = [item.positions, item.triangles, item.corners, item.distance, item.vectors].map((numbers) => ({
      numbers,
      coding: "delta" as const,
    }));
    const ids = [item.sites, item.owners].map((list) => ({ numbers: new Uint32Array(list.buffer), coding: "raw" as const }));
    const colors = { numbers: new Uint8Array(8), coding: "raw" as const };
    const { positions, triangles, corners, distance, vectors, sites, owners, errors, ...plain } = item;
    const bytes = sceneOf(
      ([p, t, c, d, v, s, o, table]) => ({
        blum: "1",
        roles: {},
        colors: { diverging: table, sequential: table, palette: table, regions: table },
        items: [
          { ...plain, positions: p, triangles: t, corners: c, distance: d, vectors: v, sites: { ...s, type: "i4" }, owners: { ...o, type: "i4" } },
          { ...plain, positions: p, triangles: t, corners: c, distance: d, vectors: v, sites: s, owners: o, errors: d },
        ],
      }),
      [...parts, ...ids, colors],
    );
    const scene = await readScene(bytes);
    expect(scene.items[0]).toEqual(item);
    expect((scene.items[1] as MapItem).errors).toEqual(distance);
    expect([positions, triangles, corners, vectors, sites, owners].every((list) => list.length > 0)).toBe(true);
    expect(errors).toBeUndefined();
  });

  it("is read bilinearly, as what it is linear in", () => {
    const model = new MapModel(squareMap(plane));
    for (const [x, y] of [[0.01, 0.02], [1, 0.3], [0.77, 1.9], [2, 2], [0, 0]]) {
      const place = model.placeOf(y < x ? 0 : 1, [x, y, 1]);
      expect(model.valueAt(place)).toBeCloseTo(plane(x, y), 5);
      const [px, py, pz] = model.pointOf(model.texelAt(place));
      expect(Math.hypot(px - x, py - y, pz - 1)).toBeLessThan((Math.SQRT1_2 * 2) / side + 1e-6);
    }
  });

  it("gives the texel where one of four has no value", () => {
    const model = new MapModel(squareMap(plane, true));
    const beside = infinite + 1;
    const place: [number, number] = [(beside % width) + 0.3, Math.floor(beside / width) + 0.4];
    expect(model.valueAt(place)).toBe(model.item.distance[beside]);
    expect(model.valueAt([place[0] - 1, place[1]])).toBe(Infinity);
  });

  it("has points of texels beyond a border on the border", () => {
    const model = new MapModel(squareMap(plane));
    const [x, y] = model.pointOf((gap - 1) * width + gap + 5); // above the first triangle
    expect(y).toBe(0);
    expect(x).toBeCloseTo((5.5 * 2) / side, 5);
  });

  it("has the area of its surface, also where no texel is inside of a chart", () => {
    const item = squareMap(plane);
    const sum = (areas: Float32Array) => areas.reduce((a, b) => a + b, 0);
    expect(sum(new MapModel(item).areas())).toBeCloseTo(4, 4);
    const corners = item.corners.slice();
    corners.set([2, 2, 2.1, 2, 2.1, 2.1]);
    expect(sum(new MapModel({ ...item, corners }).areas())).toBeCloseTo(4, 4);
  });

  it("counts areas by value: all of them once, those without a value never", () => {
    const model = new MapModel(squareMap((x) => x));
    const bars = model.histogram(0, 2, 4);
    bars.forEach((area) => expect(area).toBeCloseTo(1, 0));
    expect(bars.reduce((a, b) => a + b)).toBeCloseTo(4, 4);
    expect(model.below(1).part).toBeCloseTo(0.5, 1);
    expect(model.below(-1)).toEqual({ texels: 0, part: 0 });
    const gapped = new MapModel(squareMap((x) => x, true));
    expect(gapped.below(1e9).texels).toBe((side + 2) ** 2 - 1);
    expect(gapped.histogram(0, 2, 4).reduce((a, b) => a + b)).toBeCloseTo(4 - (2 / side) ** 2, 1);
  });

  it("finds all hills, the highest first, and no place on the slope of another", () => {
    const hills: [number, number, number][] = [[0.3, 0.3, 5], [1.6, 0.4, 7], [1, 1.7, 6]];
    const map = squareMap((x, y) => Math.max(...hills.map(([u, v, h]) => h - 3 * Math.hypot(x - u, y - v))));
    const model = new MapModel(map);
    const places = model.worst(8, true, 0.25).map((texel) => model.pointOf(texel));
    expect(places.length).toBe(3);
    [[1.6, 0.4], [1, 1.7], [0.3, 0.3]].forEach(([x, y], i) => {
      expect(Math.hypot(places[i][0] - x, places[i][1] - y)).toBeLessThan(2 / side);
    });
    expect(model.worst(1, true, 0.25).length).toBe(1);
  });

  it("finds the smallest values, and places apart from each other where all are alike", () => {
    const model = new MapModel(squareMap(plane));
    expect(model.worst(8, false, 0.25).length).toBe(1);
    expect(model.pointOf(model.worst(8, false, 0.25)[0]).slice(0, 2)).toEqual([0, 0]);
    const flat = new MapModel(squareMap(() => 3, true));
    const places = flat.worst(8, true, 0.5).map((texel) => flat.pointOf(texel));
    expect(places.length).toBeGreaterThan(3);
    places.forEach((p, i) => {
      for (const q of places.slice(0, i)) expect(Math.hypot(p[0] - q[0], p[1] - q[1])).toBeGreaterThanOrEqual(0.5);
    });
    expect(new MapModel(squareMap(() => Infinity)).worst(8, true, 0.5)).toEqual([]);
  });
});

describe("sites", () => {
  const mesh = squareMap(plane);
  const at = (site: number, p: Triple) => siteName(site, mesh, p, 1e-6);
  // Edges of the square in rising order: 0-1, 0-2, 0-3, 1-2, 2-3.
  it("are named as the library numbers them", () => {
    expect(at(2, [2, 2, 1])).toBe("vertex 2");
    expect(at(4, [1, 0, 1])).toBe("edge 0 (vertices 0, 1)");
    expect(at(5, [1, 1, 1])).toBe("edge 1 (vertices 0, 2)");
    expect(at(8, [1, 2, 1])).toBe("edge 4 (vertices 2, 3)");
    expect(at(9, [1, 0.5, 1])).toBe("face 0");
    expect(at(10, [0.5, 1, 1])).toBe("face 1");
  });
  it("are not named where the closest point is elsewhere, or there are none such", () => {
    for (const site of [2, 5, 9]) expect(at(site, [1, 0.5, 1.1])).toBeUndefined();
    expect(at(9, [0.5, 1, 1])).toBeUndefined();
    expect(at(11, [1, 1, 1])).toBeUndefined();
    expect(at(-1, [1, 1, 1])).toBeUndefined();
  });
  it("of segments count with the edges", () => {
    const more = { ...mesh, segments: Uint32Array.from([3, 1]) };
    expect(siteName(8, more, [1, 1, 1], 1e-6)).toBe("edge 4 (vertices 1, 3)");
  });
  it("are those of the mesh of the page that has them", () => {
    const hit: Hit = { t: 0, title: "", facts: [], at: [1, 0.5, 3], footprints: [[1, 0.5, 2]], site: 9 };
    const other = (origin: Triple) =>
      ({ kind: "mesh", name: `at ${origin[2]}`, origin, bounds: mesh.bounds, positions: mesh.positions, triangles: mesh.triangles, segments: new Uint32Array(0) }) as MeshItem;
    const facts = withSiteName(hit, [other([0, 0, 5]), other([0, 0, 1])]).facts;
    expect(facts).toEqual([["which is", "face 0 of at 1"]]);
    expect(withSiteName(hit, [other([0, 0, 5])]).facts).toEqual([]);
  });
});
