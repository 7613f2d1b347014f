// A ball that falls onto a wavy ground and dents it: meshes, pairs and stages as a program would write them.

export type Pair = { kind: string; points: number[][]; distance: number; time?: number };
export type Frame = { pairs?: Pair[]; stages?: Record<string, number> };
export type MovingScene = { files: [name: string, text: string][]; frames: Frame[] };

const radius = 0.6;
const along = 40; // squares of the ground
const rings = 24;
const sectors = 48;

const groundAt = (x: number, y: number, t: number): number => 0.12 * Math.sin(2.5 * x + 3 * t) * Math.cos(2 * y);

/** Vertices and triangles of a grid whose rows may be closed. */
class Sheets {
  readonly vertices: number[][] = [];
  readonly triangles: number[][] = [];

  add(rows: number, columns: number, isClosed: boolean, at: (row: number, column: number) => number[]): void {
    const first = this.vertices.length;
    for (let i = 0; i < rows; ++i) for (let j = 0; j < columns; ++j) this.vertices.push(at(i, j));
    const index = (i: number, j: number) => first + i * columns + (j % columns);
    for (let i = 0; i + 1 < rows; ++i) {
      for (let j = 0; j < (isClosed ? columns : columns - 1); ++j) {
        this.triangles.push([index(i, j), index(i + 1, j), index(i, j + 1)]);
        this.triangles.push([index(i, j + 1), index(i + 1, j), index(i + 1, j + 1)]);
      }
    }
  }
  obj(): string {
    const lines = this.vertices.map((p) => `v ${p.map((x) => x.toFixed(6)).join(" ")}`);
    for (const triangle of this.triangles) lines.push(`f ${triangle.map((v) => v + 1).join(" ")}`);
    return lines.join("\n") + "\n";
  }
}

function meshAt(t: number, height: number): string {
  const sheets = new Sheets();
  const across = (k: number) => -1.6 + (3.2 * k) / along;
  sheets.add(along + 1, along + 1, false, (i, j) => [across(i), across(j), groundAt(across(i), across(j), t)]);
  sheets.add(rings + 1, sectors, true, (i, j) => {
    const [down, around] = [(Math.PI * i) / rings, (2 * Math.PI * j) / sectors];
    const wide = radius * Math.sin(down);
    return [wide * Math.cos(around), wide * Math.sin(around), height + radius * Math.cos(down)];
  });
  return sheets.obj();
}

/** Pairs straight below points of the ball's underside. */
function pairsAt(t: number, height: number): Pair[] {
  const places = [0, 1, 2, 3, 4, 5, 6].map((k) =>
    k === 0 ? [0, 0] : [0.34 * Math.cos((k * Math.PI) / 3), 0.34 * Math.sin((k * Math.PI) / 3)],
  );
  return places.map(([x, y]) => {
    const ball = height - Math.sqrt(radius * radius - x * x - y * y);
    const ground = groundAt(x, y, t);
    const gap = ball - ground;
    const points = [[x, y, ball], [x, y, ground]];
    if (gap > 0.03) return { kind: "closest", points, distance: gap };
    if (gap > -0.03) return { kind: "collision", points, distance: 0, time: Math.round(500 + 5000 * gap) / 1000 };
    return { kind: "penetration", points, distance: -gap };
  });
}

export function ballOnGround(count: number): MovingScene {
  const files: MovingScene["files"] = [];
  const frames: Frame[] = [];
  for (let k = 0; k < count; ++k) {
    const t = k / (count - 1);
    const height = 1.75 - 1.2 * t * t;
    files.push([`f${String(k).padStart(2, "0")}.obj`, meshAt(t, height)]);
    const pairs = pairsAt(t, height);
    const close = pairs.filter((pair) => pair.distance < 0.2).length;
    frames.push({
      pairs,
      stages: {
        objects: 0.0021 + 0.0003 * Math.sin(k),
        diagram: 0.004 + 0.0011 * close,
        "exact tests": 0.001 + 0.0016 * close + 0.0004 * Math.cos(3 * k),
      },
    });
  }
  frames[7] = {};
  return { files, frames };
}
