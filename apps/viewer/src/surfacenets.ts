// Level surfaces of fields by surface nets (Gibson 1998). Each cell that the level passes gets a vertex. Each grid edge
// that it crosses gets a quad. Blocks of cells that the level does not reach are skipped.

export type Surface = { positions: Float32Array; normals: Float32Array; triangles: Uint32Array };

const blockSize = 16;

/** Extracts level surfaces of one field. */
export class SurfaceNets {
  readonly #values: Float32Array;
  readonly #size: readonly number[];
  readonly #spacing: readonly number[];
  readonly #blocks: number[];
  readonly #least: Float32Array;
  readonly #most: Float32Array;

  constructor(values: Float32Array, size: readonly number[], spacing: readonly number[]) {
    this.#values = values;
    this.#size = size;
    this.#spacing = spacing;
    this.#blocks = size.map((n) => Math.max(Math.ceil((n - 1) / blockSize), 0));
    const count = this.#blocks[0] * this.#blocks[1] * this.#blocks[2];
    this.#least = new Float32Array(count);
    this.#most = new Float32Array(count);
    this.#findRanges();
  }

  /** Returns the surface in the grid's frame: first node at 0, axes along x, y, z, in units of the spacing. */
  extract(level: number): Surface {
    const [nx, ny] = this.#size;
    const positions: number[] = [];
    const normals: number[] = [];
    const cells = new Map<number, number>();
    this.#forEachCell(level, (i, j, k) => {
      const vertex = this.#vertexIn(i, j, k, level);
      if (vertex === undefined) return;
      cells.set((k * ny + j) * nx + i, positions.length / 3);
      positions.push(...vertex.place);
      normals.push(...vertex.normal);
    });
    return {
      positions: new Float32Array(positions),
      normals: new Float32Array(normals),
      triangles: this.#quads(cells, level),
    };
  }

  #findRanges(): void {
    const [nx, ny, nz] = this.#size;
    const [bx, by, bz] = this.#blocks;
    for (let bk = 0, block = 0; bk < bz; ++bk) {
      for (let bj = 0; bj < by; ++bj) {
        for (let bi = 0; bi < bx; ++bi, ++block) {
          let least = Infinity;
          let most = -Infinity;
          for (let k = bk * blockSize; k <= Math.min((bk + 1) * blockSize, nz - 1); ++k) {
            for (let j = bj * blockSize; j <= Math.min((bj + 1) * blockSize, ny - 1); ++j) {
              const row = (k * ny + j) * nx;
              const end = row + Math.min((bi + 1) * blockSize, nx - 1);
              for (let at = row + bi * blockSize; at <= end; ++at) {
                const value = this.#values[at];
                if (value < least) least = value;
                if (value > most) most = value;
              }
            }
          }
          this.#least[block] = least;
          this.#most[block] = most;
        }
      }
    }
  }

  #forEachCell(level: number, visit: (i: number, j: number, k: number) => void): void {
    const [nx, ny, nz] = this.#size;
    const [bx, by, bz] = this.#blocks;
    for (let bk = 0, block = 0; bk < bz; ++bk) {
      for (let bj = 0; bj < by; ++bj) {
        for (let bi = 0; bi < bx; ++bi, ++block) {
          if (!(this.#least[block] < level && this.#most[block] >= level)) continue;
          for (let k = bk * blockSize; k < Math.min((bk + 1) * blockSize, nz - 1); ++k) {
            for (let j = bj * blockSize; j < Math.min((bj + 1) * blockSize, ny - 1); ++j) {
              for (let i = bi * blockSize; i < Math.min((bi + 1) * blockSize, nx - 1); ++i) visit(i, j, k);
            }
          }
        }
      }
    }
  }

  /** Returns the mean of the level's crossings with the edges of a cell; undefined if there are none. */
  #vertexIn(i: number, j: number, k: number, level: number) {
    const [nx, ny] = this.#size;
    const first = (k * ny + j) * nx + i;
    const v = corners;
    let below = 0;
    for (let c = 0; c < 8; ++c) {
      const value = this.#values[first + (c & 1) + ((c >> 1) & 1) * nx + (c >> 2) * nx * ny];
      v[c] = value - level;
      if (v[c] < 0) ++below;
    }
    if (below === 0 || below === 8) return undefined;
    const sum = [0, 0, 0];
    let crossings = 0;
    for (let axis = 0; axis < 3; ++axis) {
      const bit = 1 << axis;
      for (let c = 0; c < 8; ++c) {
        if ((c & bit) !== 0 || v[c] < 0 === v[c | bit] < 0) continue;
        const t = v[c] / (v[c] - v[c | bit]);
        if (!Number.isFinite(t)) continue;
        for (let a = 0; a < 3; ++a) sum[a] += a === axis ? t : (c >> a) & 1;
        ++crossings;
      }
    }
    const at = [i, j, k];
    const slope = [0, 0, 0];
    for (let axis = 0; axis < 3; ++axis) {
      const bit = 1 << axis;
      for (let c = 0; c < 8; ++c) slope[axis] += ((c & bit) !== 0 ? v[c] : -v[c]) / this.#spacing[axis];
    }
    const length = Math.hypot(...slope) || 1;
    const count = Math.max(crossings, 1);
    return {
      place: at.map((n, a) => (n + sum[a] / count) * this.#spacing[a]),
      normal: slope.map((s) => s / length),
    };
  }

  #quads(cells: Map<number, number>, level: number): Uint32Array {
    const [nx, ny] = this.#size;
    const strides = [1, nx, nx * ny];
    const triangles: number[] = [];
    for (const [cell, vertex] of cells) {
      const inside = this.#values[cell] < level;
      for (let axis = 0; axis < 3; ++axis) {
        if (this.#values[cell + strides[axis]] < level === inside) continue;
        const u = strides[(axis + 1) % 3];
        const w = strides[(axis + 2) % 3];
        const a = cells.get(cell - u);
        const b = cells.get(cell - w);
        const c = cells.get(cell - u - w);
        if (a === undefined || b === undefined || c === undefined) continue; // at the border of the grid
        if (inside) triangles.push(vertex, a, c, vertex, c, b);
        else triangles.push(vertex, c, a, vertex, b, c);
      }
    }
    return new Uint32Array(triangles);
  }
}

const corners = new Float64Array(8);
