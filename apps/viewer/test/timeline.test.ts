// Proves that the clock of moving scenes names the right frame, and that the chart of stages has the right scale.
import { describe, expect, it } from "vitest";
import { chartScale, columnsOf, frameAt, timeText, totalOf, unitOf } from "../src/chart.ts";
import { stageColor } from "../src/colors.ts";
import { Player } from "../src/player.ts";

describe("the clock", () => {
  it("counts frames from the one that it begins with, and goes round", () => {
    const player = new Player(10, 20);
    expect(player.at(0)).toBeUndefined();
    player.play(7, 1000);
    expect([1000, 1049, 1050, 1149, 1150, 1200].map((now) => player.at(now))).toEqual([7, 7, 8, 9, 0, 1]);
    player.pause();
    expect(player.isPlaying).toBe(false);
    expect(player.at(2000)).toBeUndefined();
  });

  it("ends at the last frame where it does not loop, and then begins anew", () => {
    const player = new Player(10, 10);
    player.isLooping = false;
    player.play(8, 0);
    expect([player.at(99), player.isPlaying]).toEqual([8, true]);
    expect([player.at(5000), player.isPlaying]).toEqual([9, false]);
    player.play(9, 6000);
    expect(player.at(6000)).toBe(0);
  });

  it("goes on from where it is at another speed", () => {
    const player = new Player(100, 10);
    player.play(0, 0);
    player.setSpeed(60, 1000);
    expect(player.at(1000)).toBe(10);
    expect(player.at(2000)).toBe(70);
  });
});

describe("the chart", () => {
  const stages = { names: ["objects", "diagram"], seconds: Float64Array.from([0.1, 0.2, NaN, 0.4, NaN, NaN]) };

  it("adds the stages of a frame, and takes none for nothing", () => {
    expect(totalOf(stages, 0)).toBeCloseTo(0.3, 12);
    expect(totalOf(stages, 1)).toBe(0.4);
    expect(totalOf(stages, 2)).toBe(0);
  });

  it.each([
    [[0.011, 0.03], 0.01, "ms"],
    [[2.5, 0.1], 1, "s"],
    [[3e-7], 1e-7, "µs"],
    [[4e-5, 0], 1e-5, "µs"],
  ] as const)("of %s has a line every %d s", (totals, step, unit) => {
    const scale = chartScale([...totals]);
    expect(scale.step).toBeCloseTo(step, 12);
    expect(scale.unit.name).toBe(unit);
    expect(scale.top).toBeGreaterThanOrEqual(Math.max(...totals));
  });

  it("has a scale where nothing took time", () => {
    expect(chartScale([0, 0]).top).toBeGreaterThan(0);
    expect(chartScale([]).top).toBeGreaterThan(0);
  });

  it("says times with few digits and a unit that suits them", () => {
    expect([0.0123456, 2, 4.2e-5, 0, NaN].map((s) => timeText(s))).toEqual(["12.3 ms", "2 s", "42 µs", "0 ms", "–"]);
    expect(timeText(0.5, unitOf(0.002))).toBe("500 ms");
  });

  it("draws every frame where there is room, and else the longest of each pixel", () => {
    expect(columnsOf([1, 2, 3], 500)).toEqual([0, 1, 2]);
    const totals = Array.from({ length: 1000 }, (_, f) => (f === 423 ? 9 : 1));
    const columns = columnsOf(totals, 100);
    expect(columns.length).toBe(100);
    expect(columns).toContain(423);
    columns.forEach((frame, c) => expect(Math.floor(frame / 10)).toBe(c));
    expect(columnsOf([5], 0)).toEqual([0]);
  });

  it("finds the frame under the pointer, and the ends beyond it", () => {
    expect([-5, 0, 9.9, 10, 399, 400, 900].map((x) => frameAt(x, 400, 40))).toEqual([0, 0, 0, 1, 39, 39, 39]);
    expect(frameAt(3, 0, 40)).toBe(39);
  });

  it("gives eight stages eight colours", () => {
    const palette = Uint8Array.from({ length: 4 * 16 * 256 }, (_, i) => (i * 2654435761) >>> 24);
    expect(new Set(Array.from({ length: 8 }, (_, s) => stageColor(palette, s))).size).toBe(8);
  });
});
