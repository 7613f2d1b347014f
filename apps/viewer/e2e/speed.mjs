// Measures how long pages take until their first picture. Usage: node e2e/speed.mjs URL... (file:// or http://)
import { chromium } from "playwright-core";

const runs = Number(process.env.RUNS ?? 5);
for (const url of process.argv.slice(2)) {
  const seconds = [];
  for (let run = 0; run < runs; ++run) {
    const browser = await chromium.launch({
      executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
      args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    });
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    await page.goto(url);
    await page.waitForFunction(() => window.blum?.isReady, undefined, { timeout: 120_000 });
    seconds.push((await page.evaluate(() => window.blum.milliseconds)) / 1000);
    if (run === 0) {
      const frames = await page.evaluate(() => {
        const { stage } = window.blum.page;
        const turn = () => {
          stage.turn(0.05, 0);
          stage.measure(); // waits until it is drawn
        };
        turn();
        const start = performance.now();
        for (let i = 0; i < 8; ++i) turn();
        return 8000 / (performance.now() - start);
      });
      console.log(`${url}: about ${frames.toFixed(1)} pictures a second`);
    }
    await browser.close();
  }
  seconds.sort((a, b) => a - b);
  const [least, middle, most] = [seconds[0], seconds[runs >> 1], seconds[runs - 1]].map((s) => s.toFixed(2));
  console.log(`${url}: median ${middle} s (${least} to ${most})`);
}
