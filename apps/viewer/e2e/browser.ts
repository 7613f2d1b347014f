// Pages in a real browser, and the tool that makes them.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium, type Browser, type Page } from "playwright-core";

const tool = process.env.BLUM_CLI ?? "blum";
export const folder = mkdtempSync(join(tmpdir(), "blum-viewer-"));
export const file = (name: string): string => join(folder, name);

/** Runs `make demo` with the tool, into a folder. */
export function demo(out: string): void {
  const script = fileURLToPath(new URL("../../../tools/demo.sh", import.meta.url));
  execFileSync("bash", [script, tool, out], { stdio: ["ignore", "pipe", "pipe"] });
}

export function blum(...args: string[]): string {
  return execFileSync(tool, args, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
}

/** Draws in software, where there is no graphics card. */
export async function launch(...more: string[]): Promise<Browser> {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...more],
  });
}

export type Watched = { page: Page; complaints: string[]; requests: string[] };
type Options = { width?: number; height?: number; colorScheme?: "light" | "dark"; hasTouch?: boolean };

/** Opens a page and waits until it shows something. */
export async function open(browser: Browser, url: string, options: Options = {}): Promise<Watched> {
  const { width = 1280, height = 800, ...rest } = options;
  const page = await browser.newPage({ viewport: { width, height }, ...rest });
  const complaints: string[] = [];
  const requests: string[] = [];
  page.on("console", (message) => {
    // Drivers remark that waiting for the first picture takes time: that is what is measured.
    if (message.text().includes("GL Driver Message (OpenGL, Performance")) return;
    if (message.type() === "error" || message.type() === "warning") complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(url);
  await page.waitForFunction(() => window.blum.isReady, undefined, { timeout: 60_000 });
  await settled(page);
  return { page, complaints, requests };
}

/** Waits for the next picture. */
export async function settled(page: Page): Promise<void> {
  await page.evaluate(
    () => new Promise<void>((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve()))),
  );
}

/** Returns a hash of the canvas's picture. */
export async function pixels(page: Page): Promise<number> {
  await settled(page);
  return page.evaluate(() => {
    const canvas = document.getElementById("canvas") as HTMLCanvasElement;
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d") as CanvasRenderingContext2D;
    context.drawImage(canvas, 0, 0);
    let hash = 0;
    for (const value of context.getImageData(0, 0, copy.width, copy.height).data) hash = (Math.imul(hash, 31) + value) | 0;
    return hash;
  });
}

/** The colour of the picture at a place of the window. */
export async function colorAt(page: Page, at: { x: number; y: number }): Promise<number[]> {
  await settled(page);
  return page.evaluate(({ x, y }) => {
    const canvas = document.getElementById("canvas") as HTMLCanvasElement;
    const box = canvas.getBoundingClientRect();
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d") as CanvasRenderingContext2D;
    context.drawImage(canvas, 0, 0);
    const scale = canvas.width / box.width;
    return [...context.getImageData(Math.round((x - box.left) * scale), Math.round((y - box.top) * scale), 1, 1).data];
  }, at);
}

export const fileUrl = (name: string): string => `file://${file(name)}`;

/** Runs the server. `stop` ends it as Ctrl-C does, and returns its exit status. */
export async function serve(...args: string[]): Promise<{ url: string; stop: () => Promise<number | null> }> {
  const child = spawn(tool, ["view", ...args], { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  const url = await new Promise<string>((resolve, reject) => {
    let text = "";
    child.stdout.on("data", (part: Buffer) => {
      text += part.toString();
      const found = /http:\/\/127\.0\.0\.1:\d+\//.exec(text);
      if (found) resolve(found[0]);
    });
    child.on("exit", () => reject(new Error(`the server ended: ${text}`)));
  });
  const stop = () =>
    new Promise<number | null>((resolve) => {
      child.on("exit", (status) => resolve(status));
      child.kill("SIGINT");
    });
  return { url, stop };
}

/** The controls of a page that have no name for those who do not see them. */
export const nameless = (page: Page): Promise<string[]> =>
  page.evaluate(() =>
    [...document.querySelectorAll<HTMLElement>("button, input, select, canvas, summary")]
      .filter((e) => {
        const label = e.closest("label")?.textContent || (e instanceof HTMLInputElement && e.labels?.[0]?.textContent);
        return !(e.getAttribute("aria-label") || label || e.textContent);
      })
      .map((e) => e.outerHTML),
  );
