// Proves that numbers, grids, rays and level surfaces are right.
import { describe, expect, it } from "vitest";
import { exactFloat32, roundStep, rounded } from "../src/format.ts";
import { closestOnMesh, closestOnTriangle, distance } from "../src/geometry.ts";
import { copyLayer, nearestNode, nodeIndex, toIndex, toWorld } from "../src/grid.ts";
import { Picker } from "../src/picker.ts";
import type { Grid, Triple } from "../src/scene.ts";
import { SurfaceNets } from "../src/surfacenets.ts";
import { extremes } from "../src/volumeview.ts";
import { firstHit } from "./brute_force.ts";

describe("text of numbers", () => {
  it("is the shortest that gives the same single-precision number", () => {
    for (const value of [0, 0.1, 1 / 3, -1e-38, 16777217, 3.4e38, 0.30000001192092896, 1e-45]) {
      const single = Math.fround(value);
      expect(Math.fround(Number(exactFloat32(single)))).toBe(single);
      expect(exactFloat32(single).length).toBeLessThanOrEqual(15);
    }
    expect(exactFloat32(Math.fround(0.1))).toBe("0.1");
    expect(exactFloat32(NaN)).toBe("NaN");
    expect(rounded(1 / 3)).toBe("0.333333");
  });

  it("steps of contours are round", () => {
    expect(roundStep(3.7, 16)).toBe(0.2);
    expect(roundStep(0.9, 16)).toBe(0.05);
    expect(roundStep(160, 16)).toBe(10);
    expect(roundStep(0, 16)).toBe(0);
    expect(roundStep(Infinity, 16)).toBe(0);
  });
});

describe("extremes of colours", () => {
  it("each side of the distance has a scale, at most four times the other's", () => {
    expect(extremes(-0.1, 4)).toEqual([1, 4]);
    expect(extremes(-3, 4)).toEqual([3, 4]);
    expect(extremes(0, 0)[0]).toBeGreaterThan(0);
  });
});

const turned: Grid = {
  origin: [1, 2, 3],
  spacing: [0.5, 1, 2],
  size: [4, 3, 2],
  direction: [
    [0, 1, 0],
    [-1, 0, 0],
    [0, 0, 1],
  ],
};

describe("grids", () => {
  it("turn indices into places and back", () => {
    expect(toWorld(turned, [2, 0, 0])).toEqual([1, 3, 3]);
    expect(toWorld(turned, [0, 1, 1])).toEqual([0, 2, 5]);
    const index = toIndex(turned, toWorld(turned, [3, 2, 1]));
    index.forEach((value, a) => expect(value).toBeCloseTo([3, 2, 1][a]));
    expect(nearestNode(turned, [-3, 1.4, 9])).toEqual([0, 1, 1]);
    expect(nodeIndex(turned, [3, 2, 1])).toBe(23);
  });

  it("give layers across every axis", () => {
    const values = Float32Array.from({ length: 24 }, (_, i) => i);
    const layer = (axis: number, at: number, count: number) => {
      const out = new Float32Array(count);
      copyLayer(turned, values, axis, at, out);
      return [...out];
    };
    expect(layer(2, 1, 12)).toEqual([12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23]);
    expect(layer(1, 2, 8)).toEqual([8, 9, 10, 11, 20, 21, 22, 23]);
    expect(layer(0, 3, 6)).toEqual([3, 7, 11, 15, 19, 23]);
  });
});

describe("rays and closest points", () => {
  const positions = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 1, 0, 2, 0, 1, 2]);
  const triangles = Uint32Array.from([0, 1, 2, 3, 4, 5]);

  it("hit the first triangle from either side", () => {
    const down = { origin: [0.2, 0.2, 5] as Triple, direction: [0, 0, -1] as Triple };
    const indexed = new Picker(positions, triangles);
    expect(indexed.firstHit(down)).toEqual({ triangle: 1, t: 3 });
    expect(indexed.firstHit(down, 1)).toEqual({ triangle: 0, t: 5 });
    expect(indexed.firstHit(down, 0)).toBeUndefined();
    const up = { origin: [0.2, 0.2, -1] as Triple, direction: [0, 0, 1] as Triple };
    expect(indexed.firstHit(up)).toEqual({ triangle: 0, t: 1 });
    expect(new Picker(positions).firstHit(up)).toEqual({ triangle: 0, t: 1 });
    expect(indexed.firstHit({ ...up, origin: [2, 2, -1] })).toBeUndefined();
    expect(new Picker(new Float32Array(), new Uint32Array()).firstHit(up)).toBeUndefined();
  });

  it("hit what a look at every triangle finds, with any number of them left out", () => {
    let state = 1;
    const random = () => (state = (state * 16807) % 2147483647) / 2147483647;
    const corners = Float32Array.from({ length: 9 * 500 }, random);
    const picker = new Picker(corners);
    let hits = 0;
    for (let k = 0; k < 200; ++k) {
      const target: Triple = [random(), random(), random()];
      const origin: Triple = [3 * random() - 1, 3 * random() - 1, -1];
      const length = distance(target, origin);
      const direction = target.map((x, axis) => (x - origin[axis]) / length) as Triple;
      const count = k % 3 === 0 ? undefined : Math.floor(500 * random());
      const hit = picker.firstHit({ origin, direction }, count);
      const expected = firstHit({ origin, direction }, corners, undefined, count ?? 500);
      expect(hit?.triangle).toBe(expected?.triangle);
      if (hit && expected) expect(hit.t).toBeCloseTo(expected.t, 9);
      hits += hit ? 1 : 0;
    }
    expect(hits).toBeGreaterThan(100);
  });

  it("find the closest point like a fine search does", () => {
    const [a, b, c]: Triple[] = [
      [0, 0, 0],
      [2, 0.5, 0.3],
      [0.4, 1.5, -0.2],
    ];
    for (let i = 0; i < 60; ++i) {
      const p: Triple = [3 * Math.sin(i), 3 * Math.cos(1.3 * i), 2 * Math.sin(2.1 * i)];
      let least = Infinity;
      for (let u = 0; u <= 60; ++u) {
        for (let v = 0; u + v <= 60; ++v) {
          const q = [0, 1, 2].map((x) => a[x] + ((b[x] - a[x]) * u + (c[x] - a[x]) * v) / 60);
          least = Math.min(least, distance(p, q));
        }
      }
      const found = distance(p, closestOnTriangle(p, a, b, c));
      expect(found).toBeLessThanOrEqual(least + 1e-12);
      expect(found).toBeGreaterThan(least - 0.02);
    }
    expect(closestOnMesh([0.1, 0.1, 1.9], positions, triangles)).toEqual([expect.closeTo(0.1), expect.closeTo(0.1), 2]);
  });
});

describe("SurfaceNets", () => {
  const n = 24;
  const center = (n - 1) / 2;
  const sphere = Float32Array.from({ length: n ** 3 }, (_, at) => {
    const [i, j, k] = [at % n, Math.floor(at / n) % n, Math.floor(at / n / n)];
    return Math.hypot(i - center, j - center, k - center) - 7;
  });
  const nets = new SurfaceNets(sphere, [n, n, n], [1, 1, 1]);

  it.each([0, -3, 2.5])("makes a closed sphere at level %d that faces outwards", (level) => {
    const { positions, normals, triangles } = nets.extract(level);
    const sides = new Map<string, number>();
    for (let t = 0; t < triangles.length; t += 3) {
      for (let k = 0; k < 3; ++k) {
        const [a, b] = [triangles[t + k], triangles[t + ((k + 1) % 3)]];
        const side = `${Math.min(a, b)},${Math.max(a, b)}`;
        sides.set(side, (sides.get(side) ?? 0) + (a < b ? 1 : -1));
      }
    }
    expect([...sides.values()].every((balance) => balance === 0)).toBe(true);
    expect(positions.length / 3 - sides.size + triangles.length / 3).toBe(2); // Euler's number
    for (let v = 0; v < positions.length; v += 3) {
      const from = [0, 1, 2].map((a) => positions[v + a] - center);
      const radius = Math.hypot(...from);
      expect(Math.abs(radius - (7 + level))).toBeLessThan(0.25);
      expect((from[0] * normals[v] + from[1] * normals[v + 1] + from[2] * normals[v + 2]) / radius).toBeGreaterThan(0.95);
    }
    const corner = (k: number) => [0, 1, 2].map((a) => positions[3 * triangles[k] + a] - center);
    const [a, b, c] = [corner(0), corner(1), corner(2)];
    const volume =
      a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    expect(volume).toBeGreaterThan(0);
  });

  it("finds nothing where the level is not passed", () => {
    expect(nets.extract(100).triangles.length).toBe(0);
    expect(new SurfaceNets(new Float32Array(8).fill(1), [2, 2, 2], [1, 1, 1]).extract(0).positions.length).toBe(0);
    expect(new SurfaceNets(new Float32Array(4), [2, 2, 1], [1, 1, 1]).extract(0).positions.length).toBe(0);
  });
});
