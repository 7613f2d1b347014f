// The scene from `blum view`: a JSON header and arrays, in the format that apps/cli/view/scene_blob.hpp describes.
import type { Colors } from "./colors.ts";

export type Numbers =
  | Float32Array
  | Float64Array
  | Int8Array
  | Uint8Array
  | Int16Array
  | Uint16Array
  | Int32Array
  | Uint32Array;

export type Triple = [number, number, number];
export type Box = { lower: Triple; upper: Triple };
export type Fact = [label: string, text: string];

type ArrayEntry = { type: string; count: number; offset: number; bytes: number; coding: "raw" | "deflate" | "delta" };

export type Grid = { origin: Triple; spacing: Triple; size: Triple; direction: [Triple, Triple, Triple] };

type ItemBase = { name: string; units: string; facts: Fact[]; bounds: Box | null };

export type MeshItem = ItemBase & {
  kind: "mesh";
  origin: Triple;
  counts: { vertices: number; edges: number; triangles: number };
  closed: boolean;
  positions: Float32Array;
  triangles: Uint32Array;
  segments: Uint32Array;
  points: Uint32Array;
};

export type FieldItem = ItemBase & {
  kind: "field";
  grid: Grid;
  distance: Float32Array;
  sites: Int32Array | undefined;
  siteIds: string;
  signed: boolean;
  band: number | null;
  range: [number, number] | null;
};

export type ImageItem = ItemBase & {
  kind: "image";
  grid: Grid;
  values: Numbers;
  labels: boolean;
  range: [number, number] | null;
};

export type AxisItem = ItemBase & {
  kind: "axis";
  content: string; // "medial axis", "Voronoi diagram" or "centreline"
  siteIds: string;
  hasLabels: boolean;
  theta: number | null;
  leastTheta: number | undefined; // if the file contains all angles
  betti: Triple;
  positions: Float64Array;
  roleNumbers: Roles;
  roles: Uint8Array;
  radii: Float64Array | undefined;
  angles: Float64Array | undefined;
  footprints: Float64Array | undefined;
  sites: Int32Array | undefined;
  vertexUntil: Float32Array | undefined;
  edges: Uint32Array;
  edgeRoles: Uint8Array;
  edgeFrom: Float32Array;
  edgeUntil: Float32Array;
  triangles: Uint32Array;
  triangleAngles: Float32Array;
  triangleUntil: Float32Array;
  sheets: Int32Array;
};

/** Close pairs in the frames of a moving scene, frame by frame. */
export type PairTable = {
  kindNames: string[];
  first: Uint32Array; // number of the first pair of each frame, then the number of pairs
  kinds: Uint8Array;
  points: Float32Array; // two for each pair, relative to the item's origin
  distances: Float64Array;
  times: Float32Array; // 0 to 1; NaN if the file has none
  range: [number, number]; // range of the distances
};

/** Durations of the stages of each frame. */
export type Stages = { names: string[]; seconds: Float64Array };

export type FramesItem = ItemBase & {
  kind: "frames";
  origin: Triple;
  meshes: Uint32Array[]; // triangles, which frames share
  frames: { name: string; mesh: number; positions: Float32Array }[];
  pairs: PairTable | undefined;
  stages: Stages | undefined;
};

/** A distance vector field over a surface, as a texture. Lists of texels have rows from the top, x fastest. */
export type MapItem = ItemBase & {
  kind: "map";
  quantity: string;
  signed: boolean;
  origin: Triple;
  width: number;
  height: number;
  range: [number, number] | null; // range of the finite values
  positions: Float32Array;
  triangles: Uint32Array;
  corners: Float32Array; // x, y of three places in the texture for each triangle, in texels
  distance: Float32Array; // infinite if nothing was found, NaN for texels without a triangle
  vectors: Float32Array; // from the surface to the closest point
  sites: Int32Array;
  owners: Int32Array; // triangle of each texel
  errors: Float32Array | undefined; // for triangles
};

/** Numbers of roles in files. */
export type Roles = Record<"sheet" | "rim" | "seam" | "curve" | "junction", number>;

export type ErrorItem = { kind: "error"; name: string; message: string };
export type Item = MeshItem | FieldItem | ImageItem | AxisItem | FramesItem | MapItem | ErrorItem;
export type Scene = { version: string; items: Item[]; colors: Colors };

export class SceneError extends Error {}

type Constructor =
  | Float32ArrayConstructor
  | Float64ArrayConstructor
  | Int8ArrayConstructor
  | Uint8ArrayConstructor
  | Int16ArrayConstructor
  | Uint16ArrayConstructor
  | Int32ArrayConstructor
  | Uint32ArrayConstructor;

const constructors: Partial<Record<string, Constructor>> = {
  f4: Float32Array,
  f8: Float64Array,
  i1: Int8Array,
  u1: Uint8Array,
  i2: Int16Array,
  u2: Uint16Array,
  i4: Int32Array,
  u4: Uint32Array,
};

/** Reads a scene. Throws SceneError if the bytes are not a scene. */
export async function readScene(bytes: Uint8Array): Promise<Scene> {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 16 || new TextDecoder().decode(bytes.subarray(0, 8)) !== "BLUMVIEW") {
    throw new SceneError("this is not a scene of blum view");
  }
  if (view.getUint32(8, true) !== 2) throw new SceneError("the scene is of another version of blum than the page");
  const start = 16 + view.getUint32(12, true);
  if (start > bytes.length) throw new SceneError("the scene is cut off");
  const header = JSON.parse(new TextDecoder().decode(bytes.subarray(16, start))) as Header;
  const body = bytes.subarray(start);
  const { items, colors, roles } = header;
  if (colors === undefined || roles === undefined) throw new SceneError("the scene has no colours or roles");
  const read = (entry: ArrayEntry) => readArray(body, entry);
  const table = async (name: keyof Colors) => (await read(colors[name])) as Uint8Array;
  return {
    version: header.blum,
    items: await Promise.all(items.map((item) => readItem(item, roles, read))),
    colors: {
      diverging: await table("diverging"),
      sequential: await table("sequential"),
      palette: await table("palette"),
      regions: await table("regions"),
    },
  };
}

// The header: entries instead of arrays, and names as in C++.
// eslint-disable-next-line @typescript-eslint/no-explicit-any
type Raw = Record<string, any>;
type Header = { blum: string; items: Raw[]; colors?: Record<keyof Colors, ArrayEntry>; roles?: Roles };

type Reader = <T extends Numbers>(entry: ArrayEntry | undefined) => Promise<T>;

async function readItem(raw: Raw, roles: Roles, read: (entry: ArrayEntry) => Promise<Numbers>): Promise<Item> {
  const array: Reader = async <T extends Numbers>(entry: ArrayEntry | undefined): Promise<T> =>
    (entry === undefined ? undefined : await read(entry)) as T;
  const base = { name: raw.name, units: raw.units, facts: raw.facts, bounds: raw.bounds };
  switch (raw.kind) {
    case "mesh":
      return {
        ...base,
        kind: "mesh",
        origin: raw.origin,
        counts: raw.counts,
        closed: raw.closed,
        positions: await array<Float32Array>(raw.positions),
        triangles: await array<Uint32Array>(raw.triangles),
        segments: await array<Uint32Array>(raw.segments),
        points: await array<Uint32Array>(raw.points),
      };
    case "field":
      return {
        ...base,
        kind: "field",
        grid: raw.grid,
        distance: await array<Float32Array>(raw.distance),
        sites: await array<Int32Array>(raw.sites),
        siteIds: raw.site_ids,
        signed: raw.signed,
        band: raw.band,
        range: raw.range,
      };
    case "image":
      return {
        ...base,
        kind: "image",
        grid: raw.grid,
        values: await array<Numbers>(raw.values),
        labels: raw.labels,
        range: raw.range,
      };
    case "axis":
      return {
        ...base,
        kind: "axis",
        content: raw.content,
        siteIds: raw.site_ids,
        hasLabels: raw.has_labels,
        theta: raw.theta,
        leastTheta: raw.least_theta,
        betti: raw.betti,
        positions: await array<Float64Array>(raw.vertices.positions),
        roleNumbers: roles,
        roles: await array<Uint8Array>(raw.vertices.roles),
        radii: await array<Float64Array>(raw.vertices.radii),
        angles: await array<Float64Array>(raw.vertices.angles),
        footprints: await array<Float64Array>(raw.vertices.footprints),
        sites: await array<Int32Array>(raw.vertices.sites),
        vertexUntil: await array<Float32Array>(raw.vertex_until),
        edges: await array<Uint32Array>(raw.edges),
        edgeRoles: await array<Uint8Array>(raw.edge_roles),
        edgeFrom: await array<Float32Array>(raw.edge_from),
        edgeUntil: await array<Float32Array>(raw.edge_until),
        triangles: await array<Uint32Array>(raw.triangles),
        triangleAngles: await array<Float32Array>(raw.triangle_angles),
        triangleUntil: await array<Float32Array>(raw.triangle_until),
        sheets: await array<Int32Array>(raw.sheets),
      };
    case "frames":
      return { ...base, kind: "frames", origin: raw.origin, ...(await readFrames(raw, array)) };
    case "map":
      return {
        ...base,
        kind: "map",
        quantity: raw.quantity,
        signed: raw.signed,
        origin: raw.origin,
        width: raw.width,
        height: raw.height,
        range: raw.range,
        positions: await array<Float32Array>(raw.positions),
        triangles: await array<Uint32Array>(raw.triangles),
        corners: await array<Float32Array>(raw.corners),
        distance: await array<Float32Array>(raw.distance),
        vectors: await array<Float32Array>(raw.vectors),
        sites: await array<Int32Array>(raw.sites),
        owners: await array<Int32Array>(raw.owners),
        errors: await array<Float32Array>(raw.errors),
      };
    case "error":
      return { kind: "error", name: raw.name, message: raw.message };
    default:
      return { kind: "error", name: raw.name, message: `the page does not know what '${raw.kind}' is` };
  }
}

async function readFrames(
  raw: Raw,
  array: Reader,
): Promise<Pick<FramesItem, "meshes" | "frames" | "pairs" | "stages">> {
  const meshes = (raw.meshes as ArrayEntry[]).map((entry) => array<Uint32Array>(entry));
  const frames = (raw.frames as Raw[]).map(async ({ name, mesh, positions }) => ({
    name: name as string,
    mesh: mesh as number,
    positions: await array<Float32Array>(positions),
  }));
  return {
    meshes: await Promise.all(meshes),
    frames: await Promise.all(frames),
    pairs: raw.pairs && (await readPairs(raw.pairs, array)),
    stages: raw.stages && { names: raw.stages.names, seconds: await array<Float64Array>(raw.stages.seconds) },
  };
}

async function readPairs(raw: Raw, array: Reader): Promise<PairTable> {
  return {
    kindNames: raw.kind_names,
    first: await array<Uint32Array>(raw.first),
    kinds: await array<Uint8Array>(raw.kinds),
    points: await array<Float32Array>(raw.points),
    distances: await array<Float64Array>(raw.distances),
    times: await array<Float32Array>(raw.times),
    range: raw.range,
  };
}

async function readArray(body: Uint8Array, entry: ArrayEntry): Promise<Numbers> {
  const stored = body.subarray(entry.offset, entry.offset + entry.bytes);
  if (stored.length !== entry.bytes) throw new SceneError("the scene is cut off");
  const make = constructors[entry.type];
  if (make === undefined) throw new SceneError(`the scene holds numbers of an unknown type, '${entry.type}'`);
  let bytes: Uint8Array;
  if (entry.coding === "raw") {
    // Arrays are aligned for their types if the scene itself is aligned.
    const at = body.byteOffset + entry.offset;
    if (at % make.BYTES_PER_ELEMENT === 0) return new make(body.buffer as ArrayBuffer, at, entry.count);
    bytes = stored.slice();
  } else {
    bytes = await inflate(stored, entry.count * make.BYTES_PER_ELEMENT);
    if (entry.coding === "delta") bytes = undoDelta(bytes);
  }
  return new make(bytes.buffer as ArrayBuffer, 0, entry.count);
}

async function inflate(stored: Uint8Array, size: number): Promise<Uint8Array> {
  const stream = new Blob([stored as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate"));
  const out = new Uint8Array(size);
  let at = 0;
  const reader = stream.getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (at + value.length > size) throw new SceneError("the scene holds more numbers than it says");
    out.set(value, at);
    at += value.length;
  }
  if (at !== size) throw new SceneError("the scene is cut off");
  return out;
}

/** Decodes "delta": sums differences of bit patterns that are stored as four planes of bytes. */
export function undoDelta(planes: Uint8Array): Uint8Array {
  const count = planes.length / 4;
  const out = new Uint32Array(count);
  let last = 0;
  for (let i = 0; i < count; ++i) {
    last +=
      planes[i] | (planes[count + i] << 8) | (planes[2 * count + i] << 16) | (planes[3 * count + i] << 24);
    last |= 0;
    out[i] = last;
  }
  return new Uint8Array(out.buffer);
}
