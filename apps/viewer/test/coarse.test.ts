// Proves that coarse surfaces are small, lie where the whole ones do, and keep the order of triangles.
import { describe, expect, it } from "vitest";
import { coarsen, keptBelow } from "../src/coarse.ts";

/** A square of n x n x 2 triangles. */
function square(n: number): { positions: Float32Array; triangles: Uint32Array } {
  const positions: number[] = [];
  const triangles: number[] = [];
  for (let j = 0; j <= n; ++j) for (let i = 0; i <= n; ++i) positions.push(i / n, j / n, 0);
  for (let j = 0; j < n; ++j) {
    for (let i = 0; i < n; ++i) {
      const v = j * (n + 1) + i;
      triangles.push(v, v + 1, v + n + 2, v, v + n + 2, v + n + 1);
    }
  }
  return { positions: new Float32Array(positions), triangles: new Uint32Array(triangles) };
}

describe("coarsen", () => {
  const { positions, triangles } = square(400);
  const coarse = coarsen(positions, triangles, triangles.length / 3);

  it("leaves a surface of the same area from far fewer triangles", () => {
    expect(coarse.index.length / 3).toBeLessThan(20000);
    expect(coarse.index.length / 3).toBe(coarse.kept.length);
    let area = 0;
    for (let t = 0; t < coarse.index.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => 3 * coarse.index[t + k]);
      area +=
        ((positions[b] - positions[a]) * (positions[c + 1] - positions[a + 1]) -
          (positions[c] - positions[a]) * (positions[b + 1] - positions[a + 1])) /
        2;
    }
    expect(area).toBeGreaterThan(0.95);
    expect(area).toBeLessThan(1.01);
  });

  it("takes corners that lie one after the other, too", () => {
    const corners = new Float32Array([...triangles].flatMap((v) => [...positions.subarray(3 * v, 3 * v + 3)]));
    expect(coarsen(corners, undefined, triangles.length / 3).kept).toEqual(coarse.kept);
  });

  it("says how many of the first triangles are left", () => {
    expect(keptBelow(coarse, 0)).toBe(0);
    expect(keptBelow(coarse, triangles.length)).toBe(coarse.kept.length);
    const some = coarse.kept[100];
    expect(keptBelow(coarse, some)).toBe(100);
    expect(keptBelow(coarse, some + 1)).toBe(101);
  });

  it("stands a surface without extent", () => {
    expect(coarsen(new Float32Array(9), undefined, 1).index.length).toBe(0);
    expect(coarsen(new Float32Array(0), undefined, 0).index.length).toBe(0);
  });
});
