// Proves in a real browser that moving scenes play, scrub and loop. Also proves that pairs and their texts agree with
// the file, and that a click on the chart of stages shows a frame.
import { rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { blum, colorAt, file, fileUrl, folder, launch, nameless, open, pixels, serve, settled } from "./browser.ts";
import { ballOnGround } from "./moving_scene.ts";

let browser: Browser;
const scene = ballOnGround(24);
const kinds = ["closest", "collision", "penetration"];
/** The number of a frame that has pairs of every kind. */
const mixed = 1 + scene.frames.findIndex(({ pairs }) => kinds.every((kind) => pairs?.some((pair) => pair.kind === kind)));

beforeAll(async () => {
  for (const [name, text] of scene.files) writeFileSync(file(name), text);
  writeFileSync(file("pairs.json"), JSON.stringify({ frames: scene.frames }));
  const names = scene.files.map(([name]) => name);
  blum("view", ...names, "--frames", "--pairs", "pairs.json", "-o", "moving.html");
  blum("view", ...names.slice(0, 3), "--frames", "-o", "plain.html");
  browser = await launch();
});

afterAll(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

const numberField = (page: Page) => page.getByLabel("Frame, as a number");
const frameOf = async (page: Page): Promise<number> => Number(await numberField(page).inputValue());
const goTo = async (page: Page, frame: number): Promise<void> => {
  await numberField(page).fill(String(frame));
  await numberField(page).press("Enter");
  await settled(page);
};
const fact = (page: Page, name: string): Promise<string | null> =>
  page.locator(`.readout dd[data-fact="${name}"]`).textContent();

/** Where the middle of a pair is in the browser's window. */
const pairOnPage = (page: Page, [a, b]: number[][]): Promise<{ x: number; y: number }> =>
  page.evaluate(
    (middle) => {
      const { stage } = window.blum.page!;
      return stage.project(middle.map((x, k) => x - stage.center[k]) as [number, number, number]);
    },
    a.map((x, k) => (x + b[k]) / 2),
  );

describe("a moving scene", () => {
  it("is shown without complaints and without a network", async () => {
    const { page, complaints, requests } = await open(browser, fileUrl("moving.html"));
    expect(complaints).toEqual([]);
    expect(requests.filter((url) => url.startsWith("file:"))).toEqual([fileUrl("moving.html")]);
    expect(requests.filter((url) => !/^(file|blob|data):/.test(url))).toEqual([]);
    expect(await page.title()).toContain("f00.obj to f23.obj");
    expect(await page.locator(".legend").count()).toBe(2);
    expect(await page.locator("#facts").textContent()).toContain("moving scene");
    await page.close();
  });

  it("goes to frames by slider, number, keys and chart, and each looks different", async () => {
    const { page, complaints } = await open(browser, fileUrl("moving.html"));
    const changes = async (frame: number, action: () => Promise<unknown>) => {
      const before = await pixels(page);
      await action();
      expect(await pixels(page), `frame ${frame}`).not.toBe(before);
      expect(await frameOf(page)).toBe(frame);
      expect(await page.locator(".transport .file").textContent()).toBe(scene.files[frame - 1][0]);
    };
    await changes(12, () => goTo(page, 12));
    await changes(24, () => page.getByLabel("Frame", { exact: true }).fill("24"));
    await changes(23, () => page.getByLabel("Frame", { exact: true }).press("ArrowLeft"));
    await page.locator("#canvas").focus();
    await changes(22, () => page.keyboard.press(","));
    await changes(23, () => page.keyboard.press("."));
    const box = (await page.locator(".plot").boundingBox())!;
    await changes(6, () => page.mouse.click(box.x + (5.5 / 24) * box.width, box.y + 20));
    await page.mouse.down();
    await page.mouse.move(box.x + (17.5 / 24) * box.width, box.y + 10, { steps: 3 });
    await page.mouse.up();
    expect(await frameOf(page)).toBe(18);
    await goTo(page, 99);
    expect(await frameOf(page)).toBe(24);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("plays, pauses, and ends where it does not loop", async () => {
    const { page, complaints } = await open(browser, fileUrl("moving.html"));
    await page.locator("#canvas").focus();
    await page.keyboard.press("Space");
    await page.waitForFunction(() => Number(document.querySelector<HTMLInputElement>(".number")!.value) > 2);
    await page.getByLabel("Pause (space)").click();
    const frame = await frameOf(page);
    await page.waitForTimeout(300);
    expect(await frameOf(page)).toBe(frame);
    await page.getByLabel("loop").setChecked(false);
    await page.getByLabel("Speed").selectOption("60");
    await page.getByLabel("Play (space)").click();
    await page.getByLabel("Play (space)").waitFor(); // it has ended
    expect(await frameOf(page)).toBe(24);
    await page.getByLabel("loop").setChecked(true);
    await page.getByLabel("Play (space)").click();
    await page.waitForFunction(() => Number(document.querySelector<HTMLInputElement>(".number")!.value) < 20);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("every control of pairs and surface changes the picture", async () => {
    const { page, complaints } = await open(browser, fileUrl("moving.html"));
    await goTo(page, mixed);
    const changes = async (what: string, action: () => Promise<void>) => {
      const before = await pixels(page);
      await action();
      expect(await pixels(page), what).not.toBe(before);
    };
    for (const style of ["wire", "translucent", "solid"]) {
      await changes(style, () => page.locator(`input[value="${style}"]`).check());
    }
    await changes("by kind", () => page.locator('input[value="kind"]').check());
    expect(await page.locator(".legend").count()).toBe(1);
    for (const kind of kinds) {
      await changes(`no ${kind}`, () => page.getByLabel(kind, { exact: true }).setChecked(false));
    }
    expect(await page.locator(".legend").count()).toBe(0);
    await changes("penetration", () => page.getByLabel("penetration", { exact: true }).setChecked(true));
    await changes("not through", () => page.getByLabel("seen through surfaces").setChecked(false));
    await changes("theme", () => page.getByLabel("Dark or light").click());
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("says of each frame what it holds", async () => {
    const { page } = await open(browser, fileUrl("moving.html"));
    for (const frame of [1, 8, mixed]) {
      await goTo(page, frame);
      const pairs = scene.frames[frame - 1].pairs ?? [];
      const count = (kind: string) => pairs.filter((pair) => pair.kind === kind).length;
      const text = await page.locator(".item .counts").textContent();
      expect(text).toContain(`${count("closest")} closest pair`);
      expect(text).toContain(`${count("collision")} collision`);
      expect(text).toContain(`${count("penetration")} penetration`);
      const seconds = await page.locator(".stages dd").allTextContents();
      const stages = Object.values(scene.frames[frame - 1].stages ?? {});
      const all = stages.reduce((a, b) => a + b, 0);
      const told = [...(stages.length > 0 ? stages : [NaN, NaN, NaN]), all];
      expect(seconds).toEqual(told.map((s) => (Number.isNaN(s) ? "–" : `${Number((s * 1000).toPrecision(3))} ms`)));
    }
    await page.close();
  });

  it("a click on a pair says its distance and time, until the frame changes", async () => {
    const { page } = await open(browser, fileUrl("moving.html"));
    for (const frame of [1, mixed]) {
      await goTo(page, frame);
      for (const kind of kinds) {
        const pair = scene.frames[frame - 1].pairs?.find((one) => one.kind === kind);
        if (pair === undefined) continue;
        const at = await pairOnPage(page, pair.points);
        await page.mouse.click(at.x, at.y);
        expect(await page.locator(".readout h2").textContent()).toContain(kind);
        expect(parseFloat((await fact(page, "distance"))!)).toBeCloseTo(pair.distance, 5);
        if (pair.time !== undefined) expect(Number(await fact(page, "time"))).toBeCloseTo(pair.time, 5);
      }
    }
    expect(await page.locator(".readout").isVisible()).toBe(true);
    await page.locator("#canvas").focus();
    await page.keyboard.press(",");
    expect(await page.locator(".readout").isVisible()).toBe(false);
    await page.close();
  });

  it("lines have the colour of their distance, or of their kind", async () => {
    const { page } = await open(browser, fileUrl("moving.html"));
    await goTo(page, 1);
    const pair = scene.frames[0].pairs![2];
    const at = await pairOnPage(page, pair.points);
    const distances = scene.frames.flatMap(({ pairs }) => (pairs ?? []).map(({ distance }) => distance));
    const most = distances.reduce((a, b) => Math.max(a, b));
    const ramp = await page.evaluate(() => [...window.blum.scene!.colors.sequential]);
    const entry = Math.round((pair.distance / most) * (ramp.length / 4 - 1)); // the least distance is 0
    const byDistance = await colorAt(page, at);
    for (let k = 0; k < 3; ++k) expect(Math.abs(byDistance[k] - ramp[4 * entry + k])).toBeLessThan(4);
    await page.locator('input[value="kind"]').check();
    const byKind = await colorAt(page, at);
    [0, 0.58, 0.52].forEach((part, k) => expect(Math.abs(byKind[k] - 255 * part)).toBeLessThan(3));
    await page.close();
  });

  it("needs no pairs and no stages", async () => {
    const { page, complaints } = await open(browser, fileUrl("plain.html"));
    expect(await page.locator(".chart").count()).toBe(0);
    expect(await page.locator(".legend").count()).toBe(0);
    const before = await pixels(page);
    await goTo(page, 3);
    expect(await pixels(page)).not.toBe(before);
    const box = (await page.locator("#canvas").boundingBox())!;
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    expect(await page.locator(".readout h2").textContent()).toBe("f02.obj");
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("is drawn with fewer triangles while it moves slowly, and whole when it rests", async () => {
    blum("make", "torus", "-o", "large.ply", "--ring-segments", "160", "--tube-segments", "80");
    blum("view", "large.ply", "large.ply", "--frames", "-o", "large.html");
    const { page, complaints } = await open(browser, fileUrl("large.html"));
    const moving = (isMoving: boolean) =>
      page.evaluate((is) => {
        window.blum.page!.views[0].setMoving!(is);
        window.blum.page!.stage.drawNow();
      }, isMoving);
    // Where the first picture took long, a resize of the stage sets the view moving and lets it rest a moment later.
    await page.evaluate(() => {
      window.blum.page!.stage.onMoving = () => undefined;
    });
    await moving(false);
    const whole = await pixels(page);
    await moving(true);
    expect(await pixels(page)).not.toBe(whole);
    await moving(false);
    expect(await pixels(page)).toBe(whole);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("is served as pages are", async () => {
    const { url, stop } = await serve("f00.obj", "f01.obj", "--frames");
    const { page, complaints } = await open(browser, url);
    expect(complaints).toEqual([]);
    expect(await page.locator(".transport").count()).toBe(1);
    await page.close();
    expect(await stop()).toBe(0);
  });

  it("is readable at 400 pixels", async () => {
    const { page, complaints } = await open(browser, fileUrl("moving.html"), { width: 400, height: 800, hasTouch: true });
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(400);
    expect((await page.locator("#canvas").boundingBox())!.height).toBeGreaterThan(300);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it("every control has a name", async () => {
    const { page } = await open(browser, fileUrl("moving.html"));
    expect(await nameless(page)).toEqual([]);
    await page.close();
  });
});

// The picture of the documents: VIEWER_PICTURES names the folder.
describe.runIf(process.env.VIEWER_PICTURES)("the picture of a moving scene", () => {
  it("is made", async () => {
    const { page } = await open(browser, fileUrl("moving.html"), { width: 1200, height: 760 });
    await goTo(page, mixed - 5);
    await page.locator("#canvas").focus();
    for (const key of ["5", "ArrowUp", "ArrowRight"]) await page.keyboard.press(key);
    await settled(page);
    await page.locator("#canvas").blur();
    await page.screenshot({ path: join(process.env.VIEWER_PICTURES ?? "", "viewer-frames.png") });
    await page.close();
  });
});
