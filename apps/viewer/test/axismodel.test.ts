// Proves which part of an axis exists at an angle, and where junctions are.
import { describe, expect, it } from "vitest";
import { AxisModel, isJunctionOf } from "../src/axismodel.ts";
import type { AxisItem, Roles } from "../src/scene.ts";

// Other numbers than in files, because the scene defines them.
const role: Roles = { sheet: 2, rim: 9, seam: 0, curve: 5, junction: 7 };

// Two triangles with a common side. The first exists up to 30 degrees, the second up to 60. Then a curve remains up to
// 90, and then a vertex. A third triangle has no area: two of its corners coincide.
const item: AxisItem = {
  kind: "axis",
  content: "medial axis",
  name: "axis.npz",
  units: "mesh units",
  facts: [],
  bounds: null,
  siteIds: "features",
  hasLabels: true,
  theta: 10,
  leastTheta: 10,
  betti: [1, 0, 0],
  positions: Float64Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0]),
  roleNumbers: role,
  roles: Uint8Array.from([role.junction, role.sheet, role.sheet, role.sheet, role.sheet]),
  radii: undefined,
  angles: undefined,
  footprints: undefined,
  sites: undefined,
  vertexUntil: Float32Array.from([Infinity, 90, 30, 60, Infinity]),
  edges: Uint32Array.from([0, 1, 0, 1, 0, 2, 0, 4]),
  edgeRoles: Uint8Array.from([role.rim, role.curve, role.rim, role.curve]),
  edgeFrom: Float32Array.from([30, 60, 0, 0]),
  edgeUntil: Float32Array.from([60, 90, 30, Infinity]),
  triangles: Uint32Array.from([0, 1, 2, 0, 3, 1, 0, 4, 1]),
  triangleAngles: Float32Array.from([30, 60, 180]),
  triangleUntil: Float32Array.from([30, 60, Infinity]),
  sheets: Int32Array.from([0, 1, 2]),
};

describe("AxisModel", () => {
  const model = new AxisModel(item);

  it("sorts triangles with extent, those that stay longest first", () => {
    expect([...model.order]).toEqual([1, 0]);
    expect([...model.triangles]).toEqual([0, 3, 1, 0, 1, 2]);
  });

  it.each([
    [10, 2, 2, 0, 1],
    [29.9, 2, 2, 0, 1],
    [30, 1, 1, 0, 1],
    [59, 1, 1, 0, 1],
    [60, 0, 0, 1, 0],
    [90, 0, 0, 0, 0],
    [180, 0, 0, 0, 0],
  ])("at theta %d has %d triangles in %d sheets, %d curves and %d rims", (theta, triangles, sheets, curves, rims) => {
    expect(model.at(theta).counts).toEqual({ triangles, sheets, curves, rims, seams: 0 });
  });

  it("knows vertices of nothing", () => {
    expect([...model.at(60).loose]).toEqual([4]);
    expect([...model.at(90).loose]).toEqual([0, 4]);
  });

  it("shows all of a file of one angle, whatever theta is", () => {
    const { vertexUntil: _v, leastTheta: _l, ...rest } = item;
    const plain = new AxisModel({
      ...rest,
      vertexUntil: undefined,
      leastTheta: undefined,
      edgeFrom: new Float32Array(4),
      edgeUntil: new Float32Array(4).fill(Infinity),
      triangleUntil: new Float32Array(3).fill(Infinity),
    });
    expect(plain.at(170).counts).toMatchObject({ triangles: 2, curves: 1, rims: 2 });
    expect([...plain.at(170).junctions]).toEqual([0]);
  });
});

describe("isJunctionOf", () => {
  it.each([
    [0, 0, 0, true, false], // inside of a sheet
    [2, 0, 0, true, false], // on a rim
    [4, 0, 0, true, true], // sheets touch
    [0, 2, 0, true, false], // on a seam
    [1, 2, 0, true, true], // a rim ends at a seam
    [0, 3, 0, true, true], // seams meet
    [0, 0, 2, false, false], // on a curve
    [0, 0, 1, false, false], // at its end
    [0, 0, 3, false, true], // curves meet
    [0, 0, 1, true, true], // a curve ends at a sheet
  ])("%d rims, %d seams, %d curves, on a triangle: %s", (rims, seams, curves, isOnTriangle, expected) => {
    expect(isJunctionOf(rims, seams, curves, isOnTriangle)).toBe(expected);
  });
});
