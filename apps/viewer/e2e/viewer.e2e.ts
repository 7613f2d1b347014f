// Proves in a real browser that the page loads without complaints and without a network. Every control must change the
// picture, texts must agree with the files, and bad files must give a message.
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { blum, colorAt, demo, file, fileUrl, folder, launch, nameless, open, pixels, serve, settled } from "./browser.ts";
import { readNpz } from "./npz.ts";

const thetas = [10, 60, 120];
let browser: Browser;

beforeAll(async () => {
  blum("make", "bracket", "-o", "bracket.ply");
  blum("field", "bracket.ply", "-o", "field.npz", "--resolution", "48");
  blum("make", "balls_image", "--count", "3", "-o", "balls.nrrd");
  blum("field", "balls.nrrd", "-o", "balls-field.npz");
  blum("medial", "bracket.ply", "-o", "axis.npz", "--theta", "10", "--nested", "--resolution", "64");
  blum("medial", "bracket.ply", "-o", "cut.npz", "--theta", thetas.join(","), "--resolution", "64", "--decimate", "0");
  blum("view", "bracket.ply", "field.npz", "axis.npz", "-o", "all.html");
  browser = await launch();
});

afterAll(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

/** Where a node of the field or image is in the browser's window. */
const nodeOnPage = async (page: Page, node: number[]): Promise<{ x: number; y: number }> =>
  page.evaluate(([i, j, k]) => {
    const { page: shown } = window.blum;
    const view = shown!.views.find((v) => v.item.kind === "field" || v.item.kind === "image")!;
    const { grid } = view.item as { grid: { origin: number[]; spacing: number[] } };
    const at = [i, j, k].map((n, a) => grid.origin[a] + n * grid.spacing[a] - shown!.stage.center[a]);
    return shown!.stage.project(at as [number, number, number]);
  }, node);

const fact = (page: Page, name: string): Promise<string | null> =>
  page.locator(`.readout dd[data-fact="${name}"]`).textContent();

describe("a page in a file", () => {
  it("shows everything without complaints and without a network", async () => {
    const { page, complaints, requests } = await open(browser, fileUrl("all.html"));
    expect(complaints).toEqual([]);
    expect(requests.filter((url) => !/^(file|blob|data):/.test(url))).toEqual([]);
    expect(requests.filter((url) => url.startsWith("file:"))).toEqual([fileUrl("all.html")]);
    expect(await page.title()).toContain("bracket.ply, field.npz, axis.npz");
    expect(await page.locator(".item").count()).toBe(3);
    expect(await page.locator(".legend").count()).toBe(2);
    expect(await page.locator("#facts").textContent()).toContain("1 component, 4 tunnels, 0 voids");
    await page.close();
  });

  it("every control changes the picture", async () => {
    const { page, complaints } = await open(browser, fileUrl("all.html"));
    const changes = async (what: string, action: () => Promise<void>, wait?: () => Promise<unknown>) => {
      const before = await pixels(page);
      await action();
      await wait?.();
      expect(await pixels(page), what).not.toBe(before);
    };
    const section = (k: number) => page.locator(".item").nth(k);
    const radio = (k: number, legend: string, value: string) =>
      section(k).locator("fieldset", { hasText: legend }).first().locator(`input[value="${value}"]`).check();
    const check = (k: number, text: string, isOn: boolean) => section(k).getByLabel(text, { exact: true }).setChecked(isOn);
    const number = async (k: number, label: string, value: number) => {
      const field = section(k).getByLabel(`${label}, as a number`);
      await field.fill(String(value));
      await field.press("Enter");
    };

    for (const style of ["wire", "solid", "translucent"]) {
      await changes(`mesh ${style}`, () => radio(0, "Surface", style));
    }
    await changes("sites", () => radio(1, "Show", "sites"));
    await changes("another layer of sites", () => number(1, "Layer", 30));
    await changes("distance", () => radio(1, "Show", "distance"));
    for (const axis of ["x", "y", "z"]) await changes(`across ${axis}`, () => radio(1, "Across", axis));
    await changes("layer", () => number(1, "Layer", 12));
    await changes("contours", () => number(1, "Lines every", 0.37));
    await changes("nodes", () => check(1, "interpolate between nodes", false));
    const surface = () => page.evaluate(() => (window.blum.page!.views[1] as unknown as { surfaceShown(): Promise<void> }).surfaceShown());
    await changes("level surface", () => check(1, "level surface", true), surface);
    await changes("its distance", () => number(1, "At distance", 0.3), surface);
    await changes("its style", () => radio(1, "Surface", "wire"));
    await changes("no level surface", () => check(1, "level surface", false));
    await changes("no slice", () => check(1, "slice", false));
    await changes("no mesh", () => section(0).locator("h2 input").setChecked(false));

    await changes("theta", () => number(2, "Theta", 120));
    await changes("theta back", () => number(2, "Theta", 10));
    for (const by of ["angle", "sheet", "radius"]) await changes(`by ${by}`, () => radio(2, "Colour by", by));
    for (const style of ["wire", "translucent", "solid"]) await changes(`sheets ${style}`, () => radio(2, "Sheets", style));
    for (const part of ["rims", "seams", "junctions", "sheets"]) {
      const box = section(2).getByLabel(part, { exact: true });
      const isOn = await box.isChecked();
      await changes(part, () => box.setChecked(!isOn));
    }
    await changes("theme", () => page.getByLabel("Dark or light").click());
    await page.locator("#canvas").focus();
    for (const key of ["ArrowLeft", "ArrowUp", "+", "-", "3", "0"]) await changes(key, () => page.keyboard.press(key));
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("a slice is dragged by its handle, and moved by keys", async () => {
    const { page } = await open(browser, fileUrl("all.html"));
    const knob = page.locator(".knob");
    const layer = async () => {
      await settled(page);
      return Number(await knob.getAttribute("aria-valuenow"));
    };
    const first = await layer();
    const box = (await knob.boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2, box.y - 60, { steps: 4 });
    await page.mouse.up();
    const dragged = await layer();
    expect(dragged).toBeGreaterThan(first + 2);
    await knob.focus();
    await page.keyboard.press("ArrowDown");
    expect(await layer()).toBe(dragged - 1);
    await page.keyboard.press("Home");
    expect(await layer()).toBe(0);
    await page.close();
  });

  it("a click says what the field's file holds there, and where the footprint is", async () => {
    const { page } = await open(browser, fileUrl("all.html"));
    const { distance, site } = readNpz(file("field.npz"));
    const [nz, ny, nx] = distance.shape;
    await page.locator(".item").nth(2).locator("h2 input").setChecked(false); // lest the axis is in the way
    await page.locator("#canvas").focus();
    await page.keyboard.press("3"); // from above
    const k = Math.floor((nz - 1) / 2);
    for (const [i, j] of [[3, 4], [Math.floor(nx / 2), 5], [nx - 4, ny - 3], [10, Math.floor(ny / 2)]]) {
      const at = await nodeOnPage(page, [i, j, k]);
      await page.mouse.click(at.x, at.y);
      const index = (k * ny + j) * nx + i;
      expect(await fact(page, "node")).toBe(`${i}, ${j}, ${k} (x, y, z)`);
      const said = (await fact(page, "distance"))!.split(" ")[0];
      expect(Math.fround(Number(said))).toBe(distance.values[index]);
      expect(await fact(page, "site")).toBe(String(site.values[index]));
      expect(await fact(page, "footprint is on")).toBe("bracket.ply");
      const numbers = async (name: string) => [...(await fact(page, name))!.matchAll(/-?[\d.e-]+/g)].map(Number);
      const [place, foot] = [await numbers("place"), await numbers("footprint")];
      const away = Math.hypot(...place.map((p, a) => p - foot[a]));
      expect(away).toBeCloseTo(Math.abs(distance.values[index]), 3);
    }
    await page.getByLabel("Close").click();
    expect(await page.locator(".readout").isVisible()).toBe(false);
    await page.close();
  });

  it("the inside is warm and the outside is blue", async () => {
    blum("view", "field.npz", "-o", "field.html");
    const { page } = await open(browser, fileUrl("field.html"));
    const { distance } = readNpz(file("field.npz"));
    const [nz, ny, nx] = distance.shape;
    await page.locator('input[value="x"]').check();
    await page.locator("#canvas").focus();
    await page.keyboard.press("1");
    const i = Math.floor((nx - 1) / 2);
    const nodes = [];
    for (let k = 1; k < nz - 1; ++k) for (let j = 1; j < ny - 1; ++j) nodes.push([i, j, k]);
    const value = ([x, y, z]: number[]) => distance.values[(z * ny + y) * nx + x];
    nodes.sort((a, b) => value(a) - value(b));
    const [deepest, farthest] = [nodes[0], nodes[nodes.length - 1]];
    expect(value(deepest)).toBeLessThan(0);
    const [inR, , inB] = await colorAt(page, await nodeOnPage(page, deepest));
    expect(inR).toBeGreaterThan(inB + 20);
    const [outR, , outB] = await colorAt(page, await nodeOnPage(page, farthest));
    expect(outB).toBeGreaterThan(outR + 20);
    await page.close();
  });

  it("a click on an axis says what its file holds", async () => {
    blum("view", "cut-theta60.npz", "-o", "axis.html");
    const { page } = await open(browser, fileUrl("axis.html"));
    const axis = readNpz(file("cut-theta60.npz"));
    const box = (await page.locator("#canvas").boundingBox())!;
    let hits = 0;
    for (const [u, v] of [[0.5, 0.5], [0.4, 0.4], [0.35, 0.5], [0.5, 0.65], [0.6, 0.7], [0.3, 0.35]]) {
      await page.mouse.click(box.x + u * box.width, box.y + v * box.height);
      if (!(await page.locator(".readout").isVisible())) continue;
      ++hits;
      const vertex = Number(await fact(page, "vertex"));
      expect(Number((await fact(page, "radius"))!.split(" ")[0])).toBe(axis.radius.values[vertex]);
      expect(await fact(page, "sites")).toBe(`${axis.site_0.values[vertex]} and ${axis.site_1.values[vertex]}`);
      const numbers = [...(await fact(page, "footprint 2"))!.matchAll(/-?[\d.e-]+/g)].map(Number);
      numbers.forEach((n, a) => expect(n).toBeCloseTo(axis.footprint_1.values[3 * vertex + a], 4));
      expect(axis.vertices.shape[0]).toBeGreaterThan(vertex);
    }
    expect(hits).toBeGreaterThan(1);
    await page.close();
  });

  it.each(thetas)("theta %d shows what blum medial --decimate 0 writes for it", async (theta) => {
    const { page } = await open(browser, fileUrl("all.html"));
    const field = page.getByLabel("Theta, as a number");
    await field.fill(String(theta));
    await field.press("Enter");
    const text = (await page.locator(".counts").first().textContent())!;
    const { vertices, triangles, edges, edge_role: roles } = readNpz(file(`cut-theta${theta}.npz`));
    const place = (v: number) => [0, 1, 2].map((a) => vertices.values[3 * v + a]).join();
    let withExtent = 0;
    for (let t = 0; t < triangles.shape[0]; ++t) {
      const corners = [0, 1, 2].map((c) => place(triangles.values[3 * t + c]));
      if (new Set(corners).size === 3) ++withExtent;
    }
    let curves = 0;
    for (let e = 0; e < edges.shape[0]; ++e) {
      if (roles.values[e] === 3 && place(edges.values[2 * e]) !== place(edges.values[2 * e + 1])) ++curves;
    }
    expect(Number(/^([\d,]+) triangles/.exec(text)![1].replaceAll(",", ""))).toBe(withExtent);
    expect(Number(/([\d,]+) line segments? on curves/.exec(text)![1].replaceAll(",", ""))).toBe(curves);
    await page.close();
  });

  it("images show labels, and fields of images the voxel that is closest", async () => {
    blum("view", "balls.nrrd", "balls-field.npz", "-o", "balls.html");
    const { page, complaints } = await open(browser, fileUrl("balls.html"));
    await page.locator("#canvas").focus();
    await page.keyboard.press("3");
    const before = await pixels(page);
    await page.locator('input[value="grey"]').check();
    await page.locator(".item").nth(1).locator("h2 input").setChecked(false);
    expect(await pixels(page)).not.toBe(before);
    const box = (await page.locator("#canvas").boundingBox())!;
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    expect(await fact(page, "value")).toMatch(/^\d+$/);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("labels have the colours of regions", async () => {
    // The labels 0 to 11 along x.
    const header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 4 2\nencoding: raw\n\n";
    const values = Uint8Array.from({ length: 12 * 4 * 2 }, (_, i) => i % 12);
    writeFileSync(file("labels.nrrd"), Buffer.concat([Buffer.from(header), values]));
    blum("view", "labels.nrrd", "-o", "labels.html");
    const { page } = await open(browser, fileUrl("labels.html"));
    await page.locator("#canvas").focus();
    await page.keyboard.press("3");
    const regions = await page.evaluate(() => [...window.blum.scene!.colors.regions]);
    for (let label = 1; label < 12; ++label) {
      const shown = await colorAt(page, await nodeOnPage(page, [label, 1, 0]));
      // The palette of the shaders has 256 hues only.
      shown.forEach((part, k) => expect(Math.abs(part - regions[4 * label + k]), `label ${label}`).toBeLessThanOrEqual(2));
    }
    await page.close();
  });

  it("saves the picture", async () => {
    const { page } = await open(browser, fileUrl("all.html"));
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByLabel("Save the picture").click()]);
    expect(download.suggestedFilename()).toBe("bracket.png");
    const bytes = readFileSync(await download.path());
    expect(bytes.subarray(1, 4).toString()).toBe("PNG");
    expect(bytes.readUInt32BE(16)).toBe(await page.evaluate(() => (document.getElementById("canvas") as HTMLCanvasElement).width));
    await page.close();
  });

  it("fits what is shown, and not what is hidden", async () => {
    writeFileSync(file("far.obj"), "v 90 0 0\nv 91 0 0\nv 90 1 0\nf 1 2 3\n");
    blum("view", "bracket.ply", "far.obj", "-o", "far.html");
    const { page } = await open(browser, fileUrl("far.html"));
    const width = async () => {
      const [left, right] = await page.evaluate(() => {
        const { stage, views } = window.blum.page!;
        const { lower, upper } = views[0].item.bounds!;
        return [lower, upper].map((p) => stage.project([0, 1, 2].map((a) => p[a] - stage.center[a]) as never).x);
      });
      return Math.abs(right - left);
    };
    const small = await width();
    await page.locator(".item").nth(1).locator("h2 input").setChecked(false);
    await page.getByLabel("Look at all").click();
    expect(await width()).toBeGreaterThan(10 * small);
    await page.close();
  });

  it("forgets what was clicked when that is hidden", async () => {
    const { page } = await open(browser, fileUrl("all.html"));
    const at = await nodeOnPage(page, [20, 20, await page.evaluate(() => {
      const view = window.blum.page!.views.find((v) => v.item.kind === "field") as never as { slice: { layer: number } };
      return view.slice.layer;
    })]);
    await page.mouse.click(at.x, at.y);
    expect(await page.locator(".readout").isVisible()).toBe(true);
    await page.locator(".item").nth(1).getByLabel("slice", { exact: true }).setChecked(false);
    const isSlice = (await page.locator(".readout").count()) === 0 || !(await page.locator(".readout").isVisible());
    expect(isSlice).toBe(true);
    expect(await page.locator(".legend").count()).toBe(1);
    await page.close();
  });

  it("is readable at 400 pixels, with a sheet below that closes", async () => {
    const { page, complaints } = await open(browser, fileUrl("all.html"), { width: 400, height: 800, hasTouch: true });
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(400);
    const tall = (await page.locator("#panel").boundingBox())!.height;
    await page.locator("#sheet").tap();
    expect((await page.locator("#panel").boundingBox())!.height).toBeLessThan(tall / 3);
    expect(await page.locator("#sheet").getAttribute("aria-expanded")).toBe("false");
    const box = (await page.locator("#canvas").boundingBox())!;
    await page.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 2);
    await settled(page);
    expect(await page.locator(".readout").isVisible()).toBe(true);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("every control has a name, and the picture too", async () => {
    const { page } = await open(browser, fileUrl("all.html"));
    expect(await nameless(page)).toEqual([]);
    await page.close();
  });
});

describe("what cannot be shown", () => {
  it("a file that is broken is named, and the others are shown", async () => {
    writeFileSync(file("broken.ply"), "ply\nformat nonsense\n");
    expect(() => blum("view", "broken.ply", "bracket.ply", "-o", "broken.html")).not.toThrow();
    const { page, complaints } = await open(browser, fileUrl("broken.html"));
    expect(await page.locator(".errors").textContent()).toContain("broken.ply");
    expect(await page.locator(".item").count()).toBe(1);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("a page without a scene, or with a spoilt one, says so", async () => {
    const whole = readFileSync(file("all.html"), "utf8");
    const from = whole.indexOf('<script type="application/octet-stream"');
    const begin = whole.indexOf(">", from) + 1;
    const to = whole.indexOf("</script>", from);
    for (const [name, text, message] of [
      ["none.html", whole.slice(0, from) + whole.slice(to), "holds no scene"],
      ["cut.html", whole.slice(0, to - 4000) + whole.slice(to), "cut off"],
      ["other.html", whole.slice(0, begin) + "AAAA".repeat(30) + whole.slice(to), "not a scene of blum view"],
    ]) {
      writeFileSync(file(name), text);
      const { page } = await open(browser, fileUrl(name));
      expect(await page.locator("#status").textContent(), name).toContain(message);
      expect(await page.locator(".errors").isVisible(), name).toBe(true);
      await page.close();
    }
  });

  it("without WebGL the facts are there as text", async () => {
    const plain = await launch("--disable-3d-apis");
    const { page } = await open(plain, fileUrl("all.html"));
    expect(await page.locator(".errors").textContent()).toContain("WebGL");
    expect(await page.locator("#facts").getAttribute("open")).not.toBeNull();
    expect(await page.locator("#facts").textContent()).toContain("triangles");
    await plain.close();
  });
});

describe("the server", () => {
  const get = (url: string, headers: Record<string, string> = {}, method = "GET") =>
    new Promise<{ status: number; policy: string }>((resolve, reject) => {
      request(url, { headers, method }, (answer) => {
        answer.resume();
        resolve({ status: answer.statusCode!, policy: String(answer.headers["content-security-policy"]) });
      })
        .on("error", reject)
        .end();
    });

  it("serves the page and the scene, and nothing else", async () => {
    const { url, stop } = await serve("bracket.ply", "axis.npz");
    const { page, complaints, requests } = await open(browser, url);
    expect(complaints).toEqual([]);
    expect(new Set(requests.filter((r) => r.startsWith("http")))).toEqual(new Set([url, `${url}scene.bin`]));
    expect(await page.locator(".item").count()).toBe(2);
    await page.close();
    for (const path of ["bracket.ply", "../bracket.ply", "%2e%2e/bracket.ply", "etc/passwd", "favicon.ico", "scene.bin/"]) {
      expect((await get(url + path)).status, path).toBe(404);
    }
    expect((await get(url)).policy).toContain("default-src 'none'");
    expect((await get(url, { host: "evil.example" })).status).toBe(403);
    expect((await get(url, {}, "POST")).status).toBe(405);
    expect(await stop()).toBe(0);
  });
});

// Pictures of the documents: VIEWER_PICTURES names the folder.
describe.runIf(process.env.VIEWER_PICTURES)("pictures", () => {
  const out = process.env.VIEWER_PICTURES ?? "";
  const set = async (page: Page, label: string, value: number) => {
    const field = page.getByLabel(`${label}, as a number`);
    await field.fill(String(value));
    await field.press("Enter");
  };

  it("are made", async () => {
    mkdirSync(out, { recursive: true });
    blum("medial", "bracket.ply", "-o", "fine.npz", "--theta", "10", "--nested", "--resolution", "160");
    blum("field", "bracket.ply", "-o", "fine.nrrd", "--resolution", "160");
    blum("view", "bracket.ply", "fine.nrrd", "fine.npz", "-o", "fine.html");
    const { page } = await open(browser, fileUrl("fine.html"), { width: 1200, height: 760 });
    await page.locator('input[value="x"]').check();
    await set(page, "Layer", 60);
    await settled(page);
    await page.screenshot({ path: join(out, "viewer.png") });
    await page.close();
    const night = await open(browser, fileUrl("fine.html"), { width: 400, height: 760, colorScheme: "dark" });
    await night.page.locator('input[value="sites"]').check();
    await night.page.locator(".item").nth(2).locator("h2 input").setChecked(false);
    await settled(night.page);
    await night.page.screenshot({ path: join(out, "viewer-narrow.png") });
    await night.page.close();
    const cut = await open(browser, fileUrl("fine.html"), { width: 1200, height: 760 });
    await cut.page.locator(".item").nth(1).locator("h2 input").setChecked(false);
    await set(cut.page, "Theta", 120);
    const box = (await cut.page.locator("#canvas").boundingBox())!;
    await cut.page.mouse.click(box.x + 0.42 * box.width, box.y + 0.45 * box.height);
    await settled(cut.page);
    await cut.page.screenshot({ path: join(out, "viewer-theta.png") });
    await cut.page.close();
    demo(file("demo"));
    const shown = await open(browser, fileUrl("demo/page.html"), { width: 1200, height: 760 });
    await settled(shown.page);
    await shown.page.screenshot({ path: join(out, "demo-page.png") });
    await shown.page.close();
    expect(execFileSync("ls", [out], { encoding: "utf8" })).toContain("viewer.png");
  });
});
