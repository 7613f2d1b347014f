// Proves in a real browser that surface maps show the values of their files: as colours, under a click and in the list
// of places. A threshold must mark places, controls must change the picture, and places must move the view.
import { readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { blum, colorAt, file, fileUrl, folder, launch, nameless, open, pixels, settled } from "./browser.ts";
import { readNpz, type Arrays } from "./npz.ts";

let browser: Browser;

beforeAll(async () => {
  blum("make", "bracket", "-o", "bracket.ply");
  blum("make", "sphere", "-o", "ball.ply", "--radius", "0.7", "--frequency", "8");
  blum("surface-map", "bracket.ply", "ball.ply", "-o", "map.npz", "--texel", "0.03", "--units", "mm");
  blum("surface-map", "bracket.ply", "ball.ply", "-o", "near.npz", "--texel", "0.03", "--max-distance", "1");
  blum("surface-map", "bracket.ply", "--thickness", "ray", "-o", "thick.npz", "--texel", "0.03");
  blum("view", "map.npz", "ball.ply", "-o", "map.html");
  blum("view", "near.npz", "-o", "near.html");
  blum("view", "thick.npz", "-o", "thick.html");
  browser = await launch();
});

afterAll(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

const fact = (page: Page, name: string): Promise<string | null> =>
  page.locator(`.readout dd[data-fact="${name}"]`).textContent();
const triple = (text: string | null): number[] => (text ?? "").slice(1, -1).split(",").map(Number);
const apart = (a: number[], b: number[]): number => Math.hypot(...a.map((x, k) => x - b[k]));

/** The texel that the readout names. */
async function texelOf(page: Page, arrays: Arrays): Promise<number> {
  const [i, j] = (await fact(page, "texel"))!.split(",").map(Number);
  return j * arrays.distance.shape[1] + i;
}
/** Where a place of the files is in the window. */
const onPage = (page: Page, place: number[]): Promise<{ x: number; y: number }> =>
  page.evaluate((at) => {
    const { stage } = window.blum.page!;
    return stage.project(at.map((x, a) => x - stage.center[a]) as [number, number, number]);
  }, place);

describe("a surface map", () => {
  it("shows itself and the other mesh without complaints", async () => {
    const { page, complaints } = await open(browser, fileUrl("map.html"));
    await page.locator(".places button").first().waitFor();
    expect(await page.title()).toContain("map.npz, ball.ply");
    expect(await page.locator(".legend figcaption").textContent()).toBe("distance (mm)");
    expect(await page.locator("#facts").textContent()).toContain("surface map");
    expect(await page.locator(".item").nth(1).locator("input[value=translucent]").isChecked()).toBe(true);
    expect(await nameless(page)).toEqual([]);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("says of a click what the file holds", async () => {
    const { page } = await open(browser, fileUrl("map.html"));
    await page.locator(".item").nth(1).locator("h2 input").setChecked(false);
    const arrays = readNpz(file("map.npz"));
    const box = (await page.locator("#canvas").boundingBox())!;
    let clicks = 0;
    for (const [u, v] of [[0.3, 0.5], [0.45, 0.75], [0.6, 0.65], [0.35, 0.35]]) {
      await page.mouse.click(box.x + u * box.width, box.y + v * box.height);
      await settled(page);
      if (await page.locator(".readout").isHidden()) continue; // beside it
      ++clicks;
      const texel = await texelOf(page, arrays);
      const value = arrays.distance.values[texel];
      const triangle = arrays.triangle.values[texel];
      expect(await fact(page, "distance")).toBe(`${Number((await fact(page, "distance"))!.split(" ")[0])} mm`);
      expect(Math.fround(Number((await fact(page, "distance"))!.split(" ")[0]))).toBe(value);
      expect(await fact(page, "triangle")).toBe(String(triangle));
      expect(await fact(page, "site")).toBe(String(arrays.site.values[texel]));
      expect(await fact(page, "which is")).toMatch(/^(vertex|edge|face) \d+.* of ball\.ply$/);
      const [point, closest] = [triple(await fact(page, "point")), triple(await fact(page, "closest point"))];
      expect(apart(point, closest)).toBeCloseTo(value, 4);
      expect(Math.hypot(...closest)).toBeCloseTo(0.7, 1); // on the ball
      const clicked = triple(await fact(page, "clicked at"));
      expect(apart(clicked, point)).toBeLessThan(0.03);
      const [read, bound] = (await fact(page, "read here"))!.split("±").map(Number);
      expect(bound).toBeCloseTo(arrays.triangle_error.values[triangle], 4);
      expect(Math.abs(read - value)).toBeLessThan(0.03);
    }
    expect(clicks).toBeGreaterThan(1);
    await page.close();
  });

  it("lists the worst places, and goes to them", async () => {
    const { page } = await open(browser, fileUrl("map.html"));
    await page.emulateMedia({ reducedMotion: "reduce" }); // at once
    const arrays = readNpz(file("map.npz"));
    const values = Array.from(arrays.distance.values).filter(Number.isFinite);
    const first = page.locator(".places button").first();
    for (const [which, wanted] of [["smallest", Math.min(...values)], ["largest", Math.max(...values)]] as const) {
      await page.locator(`input[value=${which}]`).check();
      expect(Number(await first.textContent())).toBeCloseTo(wanted, 2);
      const before = await pixels(page);
      await first.click();
      expect(await pixels(page)).not.toBe(before);
      expect(Math.fround(Number((await fact(page, "distance"))!.split(" ")[0]))).toBe(Math.fround(wanted));
      const at = await onPage(page, triple(await fact(page, "point")));
      const box = (await page.locator("#canvas").boundingBox())!;
      expect(Math.hypot(at.x - box.x - box.width / 2, at.y - box.y - box.height / 2)).toBeLessThan(3);
    }
    await page.emulateMedia({ reducedMotion: "no-preference" }); // in a flight, whose pictures differ
    await page.locator(".places button").nth(1).click();
    const start = await pixels(page);
    await page.waitForTimeout(700);
    expect(await pixels(page)).not.toBe(start);
    await page.close();
  });

  it("has the colours of its values, and others with another range", async () => {
    const { page } = await open(browser, fileUrl("thick.html"));
    // A place where the part is as thick as it is at most places: the picture has the colour of the legend, lit.
    const at = await onPage(page, [1.5, 1.5, 0.4]);
    const [r, g, b] = await colorAt(page, at);
    const field = page.getByLabel("Colours to, as a number");
    const most = Number(await field.inputValue());
    await field.fill(String(0.4));
    await field.press("Enter");
    const [r2, g2, b2] = await colorAt(page, at); // now the darkest colour
    expect(r2 + g2 + b2).toBeLessThan(r + g + b);
    const ramp = await page.evaluate(() => {
      const table = window.blum.scene!.colors.sequential;
      return [...table.subarray(table.length - 4, table.length - 1)];
    });
    const lit = [r2, g2, b2].map((c, k) => c / ramp[k]);
    for (const part of lit) expect(part).toBeCloseTo(lit[2], 1);
    expect(most).toBeGreaterThan(0.4);
    await page.close();
  });

  it("marks what is below a threshold, and counts it", async () => {
    const { page } = await open(browser, fileUrl("thick.html"));
    const at = await onPage(page, [1.5, 1.5, 0.4]); // 0.4 thick
    const before = await colorAt(page, at);
    await page.getByLabel("mark small values").check();
    const set = async (value: number) => {
      const field = page.getByLabel("At most, as a number");
      await field.fill(String(value));
      await field.press("Enter");
    };
    await set(0.39);
    expect(await colorAt(page, at)).toEqual(before);
    await set(0.41);
    const [r, g, b] = await colorAt(page, at);
    expect(r).toBeGreaterThan(2 * g);
    expect(r).toBeGreaterThan(b);
    const values = Array.from(readNpz(file("thick.npz")).distance.values);
    const share = await page.locator(".group .counts").first().textContent();
    expect(share).toContain(`${values.filter((v) => v <= Math.fround(0.41)).length.toLocaleString("en-US")} texels`);
    expect(await page.locator(".legend").nth(1).textContent()).toContain("at most 0.41");
    await page.close();
  });

  it("every control changes the picture", async () => {
    const { page, complaints } = await open(browser, fileUrl("near.html"));
    const changes = async (what: string, action: () => Promise<unknown>) => {
      const before = await pixels(page);
      await action();
      expect(await pixels(page), what).not.toBe(before);
    };
    const set = (label: string, value: number) => async () => {
      const field = page.getByLabel(`${label}, as a number`);
      await field.fill(String(value));
      await field.press("Enter");
    };
    expect(await page.locator(".legend").nth(1).textContent()).toContain("none within reach");
    for (const style of ["wire", "translucent", "solid"]) await changes(style, () => page.locator(`input[value="${style}"]`).check());
    await changes("nearest", () => page.getByLabel("interpolate between texels").setChecked(false));
    await changes("from", set("Colours from", 0.2));
    await changes("to", set("Colours to", 0.6));
    await changes("marks", () => page.getByLabel("mark small values").check());
    await changes("threshold", set("At most", 0.7));
    await changes("theme", () => page.getByLabel("Dark or light").click());
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("says where there is nothing within reach", async () => {
    const { page } = await open(browser, fileUrl("near.html"));
    const at = await onPage(page, [2.8, 0.2, 0.4]); // far from the ball
    await page.mouse.click(at.x, at.y);
    expect(await fact(page, "distance")).toBe("none within reach");
    await page.close();
  });
});

// The picture of the documents: VIEWER_PICTURES names the folder.
describe.runIf(process.env.VIEWER_PICTURES)("its picture", () => {
  it("is made", async () => {
    const out = join(process.env.VIEWER_PICTURES ?? "", "viewer-map.png");
    const { page } = await open(browser, fileUrl("map.html"), { width: 1200, height: 760 });
    const box = (await page.locator("#canvas").boundingBox())!;
    await page.mouse.click(box.x + 0.6 * box.width, box.y + 0.7 * box.height);
    await settled(page);
    await page.screenshot({ path: out });
    expect(readFileSync(out).length).toBeGreaterThan(10_000);
    await page.close();
  });
});
