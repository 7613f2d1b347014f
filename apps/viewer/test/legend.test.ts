// Proves that legends end where the data do, that their colours are those of the slice, and how pictures are named.
import { describe, expect, it } from "vitest";
import { cssColor, rampColor, type Colors } from "../src/colors.ts";
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

// Three colours, of which the middle one is that of 0, and two regions.
const colors: Colors = {
  diverging: Uint8Array.from([200, 100, 0, 255, 240, 240, 240, 255, 0, 0, 100, 255]),
  sequential: Uint8Array.from([250, 250, 250, 255, 50, 0, 0, 255]),
  palette: new Uint8Array(0),
  regions: Uint8Array.from([1, 2, 3, 255, 4, 5, 6, 255]),
};

describe("colours", () => {
  it("are those of the scene, and mixed between them", () => {
    expect(cssColor(colors.diverging, 2)).toBe("rgb(0 0 100)");
    expect([-1, 0, 0.5, 1, 2].map((t) => rampColor(colors.sequential, t))).toEqual([
      "rgb(250 250 250)",
      "rgb(250 250 250)",
      "rgb(150 125 125)",
      "rgb(50 0 0)",
      "rgb(50 0 0)",
    ]);
    expect(rampColor(colors.diverging, 0.25)).toBe("rgb(220 170 120)");
  });
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
    const shown = colorsOf(distance(-0.1, 1), colors);
    expect(shown[0]).toBe(rampColor(colors.diverging, 0.5 - (0.5 * 0.1) / 0.25));
    expect(shown.at(-1)).toBe("rgb(0 0 100)");
  });

  it("of regions have the first ones", () => {
    const legend: Legend = { kind: "regions", title: "sheet", units: "", note: "" };
    expect(colorsOf(legend, colors)).toEqual(["rgb(1 2 3)", "rgb(4 5 6)"]);
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

describe("keys", () => {
  const entries = ["closest", "collision", "penetration"].map((text, i) => ({ text, color: `rgb(${i} 0 0)` }));
  const legend: Legend = { kind: "keys", title: "pairs", units: "", entries };

  it("have their own colours, and each its name in the middle of its part", () => {
    expect(colorsOf(legend, colors)).toEqual(["rgb(0 0 0)", "rgb(1 0 0)", "rgb(2 0 0)"]);
    expect(marksOf(legend)).toEqual([["closest", 1 / 6], ["collision", 0.5], ["penetration", 5 / 6]]);
  });
});
