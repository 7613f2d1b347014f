// Proves that scenes read back as blum writes them, and that broken ones give a message.
import { describe, expect, it } from "vitest";
import { readScene, undoDelta, type MeshItem } from "../src/scene.ts";
import { fromBase64 } from "../src/source.ts";
import { delta, sceneOf, type Part } from "./scene_bytes.ts";

const positions = Float32Array.from({ length: 300 }, (_, i) => Math.sin(i) * 1e3);
const triangles = Uint32Array.from({ length: 300 }, (_, i) => (i * 7) % 100);
const colors = Uint8Array.from([1, 2, 3, 255, 4, 5, 6, 255]);
const meshScene = (coding: Part["coding"]) =>
  sceneOf(
    ([p, t, s, d, c]) => ({
      blum: "1.2.3",
      colors: { diverging: c, sequential: c, palette: c, regions: c },
      roles: { sheet: 0, rim: 1, seam: 2, curve: 3, junction: 4 },
      items: [
        { kind: "mesh", name: "a.ply", units: "mesh units", facts: [], bounds: null, origin: [1, 2, 3], positions: p, triangles: t, segments: s, points: d },
        { kind: "error", name: "b.ply", message: "'b.ply': broken" },
        { kind: "hat", name: "c" },
      ],
    }),
    [
      { numbers: positions, coding },
      { numbers: triangles, coding },
      { numbers: new Uint32Array(0), coding: "raw" },
      { numbers: new Uint32Array(0), coding: "raw" },
      { numbers: colors, coding: "raw" },
    ],
  );

describe("readScene", () => {
  it.each(["raw", "deflate", "delta"] as const)("reads arrays that are %s, bit by bit", async (coding) => {
    const scene = await readScene(meshScene(coding));
    expect(scene.version).toBe("1.2.3");
    const mesh = scene.items[0] as MeshItem;
    expect(mesh.positions).toEqual(positions);
    expect(mesh.triangles).toEqual(triangles);
    expect(mesh.segments.length).toBe(0);
    for (const table of Object.values(scene.colors)) expect(table).toEqual(colors);
  });

  it("reads a scene that does not begin at a multiple of anything", async () => {
    const bytes = meshScene("raw");
    const shifted = new Uint8Array(bytes.length + 1);
    shifted.set(bytes, 1);
    expect(((await readScene(shifted.subarray(1))).items[0] as MeshItem).positions).toEqual(positions);
  });

  it("keeps messages, and has one for what it does not know", async () => {
    const [, error, unknown] = (await readScene(meshScene("raw"))).items;
    expect(error).toEqual({ kind: "error", name: "b.ply", message: "'b.ply': broken" });
    expect(unknown).toMatchObject({ kind: "error", message: expect.stringContaining("hat") as string });
  });

  it("rejects bytes that are not a scene, are cut off, or have another version", async () => {
    await expect(readScene(new Uint8Array(4))).rejects.toThrow("not a scene");
    await expect(readScene(new TextEncoder().encode("something else altogether"))).rejects.toThrow("not a scene");
    const bytes = meshScene("delta");
    await expect(readScene(bytes.slice(0, bytes.length - 600))).rejects.toThrow("cut off");
    await expect(readScene(bytes.slice(0, 40))).rejects.toThrow("cut off");
    bytes[8] = 1;
    await expect(readScene(bytes)).rejects.toThrow("version");
    await expect(readScene(sceneOf(() => ({ blum: "1.2.3", items: [] }), []))).rejects.toThrow("no colours");
  });
});

describe("codings", () => {
  it("undoes differences of any bit patterns", () => {
    const numbers = Float32Array.from([0, -0, NaN, Infinity, 1e-45, -3.4e38, 5]);
    expect(new Float32Array(undoDelta(delta(numbers)).buffer)).toEqual(numbers);
  });

  it("reads base64 of every length", () => {
    for (const length of [0, 1, 2, 3, 4, 5, 255, 256, 257]) {
      const bytes = Uint8Array.from({ length }, (_, i) => (i * 37) & 255);
      expect(fromBase64(Buffer.from(bytes).toString("base64"))).toEqual(bytes);
    }
  });
});
