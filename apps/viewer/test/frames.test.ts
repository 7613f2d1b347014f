// Proves that moving scenes read back as blum writes them, and that frames get the normals and pairs that are theirs.
import { describe, expect, it } from "vitest";
import { capacityOf, fillPairs, mostPairs, pairCounts, vertexNormals } from "../src/framesmodel.ts";
import { raySegment } from "../src/geometry.ts";
import { readScene, type FramesItem, type PairTable } from "../src/scene.ts";
import { sceneOf, type Part } from "./scene_bytes.ts";

const square = Float32Array.from([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]);
const raised = square.map((x, i) => (i % 3 === 2 ? x + 0.25 : x));
const single = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0]);
const two = Uint32Array.from([0, 1, 2, 0, 2, 3]);
const one = Uint32Array.from([0, 1, 2]);
const pairs: PairTable = {
  kindNames: ["closest", "collision", "penetration"],
  first: Uint32Array.from([0, 3, 3, 4]),
  kinds: Uint8Array.from([0, 2, 0, 1]),
  points: Float32Array.from({ length: 24 }, (_, i) => i / 8),
  distances: Float64Array.from([0.5, 0.25, 1, 0]),
  times: Float32Array.from([NaN, NaN, NaN, 0.75]),
  range: [0, 1],
};
const seconds = Float64Array.from([0.1, 0.2, NaN, NaN, 0.3, 0.4]);

function framesScene(coding: Part["coding"], hasMore: boolean): Uint8Array {
  const parts = [two, one, square, raised, single, pairs.first, pairs.kinds, pairs.points, pairs.distances, pairs.times, seconds];
  const colors = Uint8Array.from([1, 2, 3, 255]);
  return sceneOf(
    ([t, u, a, b, c, first, kinds, points, distances, times, s, color]) => ({
      blum: "1.2.3",
      colors: { diverging: color, sequential: color, palette: color, regions: color },
      roles: {},
      items: [
        {
          kind: "frames", name: "a.ply to c.ply", units: "mesh units", facts: [], bounds: null, origin: [1, 2, 3],
          meshes: [t, u],
          frames: [
            { name: "a.ply", mesh: 0, positions: a },
            { name: "b.ply", mesh: 0, positions: b },
            { name: "c.ply", mesh: 1, positions: c },
          ],
          ...(hasMore
            ? {
                pairs: { kind_names: pairs.kindNames, first, kinds, points, distances, times, range: [0, 1] },
                stages: { names: ["objects", "diagram"], seconds: s },
              }
            : {}),
        },
      ],
    }),
    [...parts, colors].map((numbers) => ({
      numbers,
      coding: coding === "delta" && numbers.BYTES_PER_ELEMENT !== 4 ? "deflate" : coding,
    })),
  );
}

describe("moving scenes", () => {
  it.each(["raw", "deflate", "delta"] as const)("with arrays that are %s read back bit by bit", async (coding) => {
    const item = (await readScene(framesScene(coding, true))).items[0] as FramesItem;
    expect(item.origin).toEqual([1, 2, 3]);
    expect(item.meshes).toEqual([two, one]);
    expect(item.frames).toEqual([
      { name: "a.ply", mesh: 0, positions: square },
      { name: "b.ply", mesh: 0, positions: raised },
      { name: "c.ply", mesh: 1, positions: single },
    ]);
    expect(item.pairs).toEqual(pairs);
    expect(item.stages).toEqual({ names: ["objects", "diagram"], seconds });
    expect(capacityOf(item)).toEqual({ vertices: 4, triangles: 2 });
  });

  it("need no pairs and no stages", async () => {
    const item = (await readScene(framesScene("raw", false))).items[0] as FramesItem;
    expect(item.frames.length).toBe(3);
    expect([item.pairs, item.stages]).toEqual([undefined, undefined]);
  });
});

describe("pairs", () => {
  it("are counted by kind, frame by frame", () => {
    expect([0, 1, 2].map((frame) => pairCounts(pairs, frame))).toEqual([
      [2, 0, 1],
      [0, 0, 0],
      [0, 1, 0],
    ]);
    expect(mostPairs(pairs)).toEqual([2, 1, 1]);
  });

  it("of one kind and frame fill the first part of buffers", () => {
    const ends = new Float32Array(12);
    const values = new Float32Array(4);
    expect(fillPairs(pairs, 0, 0, ends, values)).toBe(2);
    expect(ends).toEqual(Float32Array.from([...pairs.points.slice(0, 6), ...pairs.points.slice(12, 18)]));
    expect([...values]).toEqual([0.5, 0.5, 1, 1]);
    expect(fillPairs(pairs, 1, 0, ends, values)).toBe(0);
    expect(fillPairs(pairs, 2, 1, ends, values)).toBe(1);
    expect(ends.slice(0, 6)).toEqual(pairs.points.slice(18));
  });
});

describe("normals", () => {
  it("add up by area, and forget the frame before", () => {
    const normals = new Float32Array(12).fill(7);
    vertexNormals(square, two, normals);
    expect([...normals]).toEqual([0, 0, 2, 0, 0, 1, 0, 0, 2, 0, 0, 1]);
    vertexNormals(single, one, normals);
    expect([...normals.slice(0, 9)]).toEqual([0, 0, 1, 0, 0, 1, 0, 0, 1]);
  });
});

describe("raySegment", () => {
  const ray = { origin: [0, 0, 5] as [number, number, number], direction: [0, 0, -1] as [number, number, number] };

  it("finds the closest places of a ray and a segment", () => {
    expect(raySegment(ray, [-1, 0.5, 1], [1, 0.5, 1])).toEqual({ t: 4, away: 0.5 });
    expect(raySegment(ray, [3, 4, 2], [6, 8, 2])).toEqual({ t: 3, away: 5 });
  });

  it("also where the segment is a point, lies along the ray, or behind it", () => {
    expect(raySegment(ray, [0, 2, 1], [0, 2, 1])).toEqual({ t: 4, away: 2 });
    expect(raySegment(ray, [1, 0, 0], [1, 0, 1]).away).toBe(1);
    expect(raySegment(ray, [0, 0, 6], [0, 0, 7])).toEqual({ t: 0, away: 1 });
  });

  it("is no further than any sample of the segment", () => {
    const at = (k: number): number => Math.sin(12.9 * k) * 3;
    for (let k = 0; k < 200; ++k) {
      const [a, b] = [0, 1].map((e) => [0, 1, 2].map((c) => at(6 * k + 3 * e + c)) as [number, number, number]);
      const { away } = raySegment(ray, a, b);
      let least = Infinity;
      for (let s = 0; s <= 200; ++s) {
        const p = a.map((x, c) => x + ((b[c] - x) * s) / 200);
        least = Math.min(least, Math.hypot(p[0], p[1]));
      }
      expect(away).toBeLessThanOrEqual(least + 1e-9);
      expect(away).toBeGreaterThan(least - 0.06);
    }
  });
});
