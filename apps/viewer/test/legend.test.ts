// Proves that legends end where the data do, that their colours are those of the slice, and how pictures are named.
import { describe, expect, it } from "vitest";
import { cssColor, divergingColor } from "../src/colors.ts";
import { colorsOf, marksOf, titleOf } from "../src/legend.ts";
import { pictureName } from "../src/picture.ts";
import { featureName } from "../src/readout.ts";
import type { MeshItem } from "../src/scene.ts";
import type { Legend } from "../src/view.ts";
import { extremes } from "../src/volumeview.ts";

const distance = (from: number, to: number): Legend => ({
  kind: "ramp",
  scale: "diverging",
  title: "distance",
  units: "mesh units",
  from,
  to,
  extremes: extremes(from, to),
});

describe("legends", () => {
  it("end where the data do, not where the colours would", () => {
    expect(marksOf(distance(-0.143, 1.529))).toEqual([
      ["-0.143", 0],
      ["1.529", 1],
    ]);
    expect(marksOf(distance(-1, 1)).map(([text]) => text)).toEqual(["-1", "0", "1"]);
    expect(marksOf(distance(-0.000109966, 0.5))[0][0]).toBe("-0.00011");
    expect(titleOf(distance(-1, 1))).toBe("distance (mesh units)");
  });

  it("have the colours of the slice: each side to its own extreme, at most four times the other's", () => {
    const colors = colorsOf(distance(-0.1, 1));
    expect(colors[0]).toBe(cssColor(divergingColor(-0.1 / 0.25)));
    expect(colors.at(-1)).toBe(cssColor(divergingColor(1)));
  });
});

describe("names", () => {
  it("of pictures are those of the first file", () => {
    expect(["part.ply", "scan.nii.gz", "a.b.npz", "plain"].map((name) => pictureName([name]))).toEqual([
      "part.png",
      "scan.png",
      "a.b.png",
      "plain.png",
    ]);
    expect(pictureName([])).toBe("blum.png");
  });

  it("of sites are those of vertices, then edges, then faces", () => {
    const mesh = { counts: { vertices: 8, edges: 18, triangles: 12 } } as MeshItem;
    expect([0, 7, 8, 25, 26, 37].map((site) => featureName(site, mesh))).toEqual([
      "vertex 0",
      "vertex 7",
      "edge 0",
      "edge 17",
      "face 0",
      "face 11",
    ]);
  });
});
