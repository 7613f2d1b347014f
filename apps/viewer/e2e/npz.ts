// Reads the arrays of an .npz file that Blum wrote: zip without compression, .npy inside.
import { readFileSync } from "node:fs";

export type Arrays = Record<string, { shape: number[]; values: ArrayLike<number> }>;

export function readNpz(path: string): Arrays {
  const bytes = readFileSync(path);
  const arrays: Arrays = {};
  // The directory at the end names every entry.
  const end = bytes.lastIndexOf(Buffer.from("PK\x05\x06"));
  let at = bytes.readUInt32LE(end + 16);
  for (let entry = 0; entry < bytes.readUInt16LE(end + 10); ++entry) {
    const nameLength = bytes.readUInt16LE(at + 28);
    const name = bytes.toString("utf8", at + 46, at + 46 + nameLength);
    const size = bytes.readUInt32LE(at + 24);
    const local = bytes.readUInt32LE(at + 42);
    const start = local + 30 + bytes.readUInt16LE(local + 26) + bytes.readUInt16LE(local + 28);
    const array = readNpy(bytes.subarray(start, start + size));
    if (array) arrays[name.replace(/\.npy$/, "")] = array;
    at += 46 + nameLength + bytes.readUInt16LE(at + 30) + bytes.readUInt16LE(at + 32);
  }
  return arrays;
}

const types = { f4: Float32Array, f8: Float64Array, i4: Int32Array, u1: Uint8Array } as const;

function readNpy(bytes: Buffer): Arrays[string] | undefined {
  const isLong = bytes[6] > 1;
  const start = (isLong ? 12 : 10) + (isLong ? bytes.readUInt32LE(8) : bytes.readUInt16LE(8));
  const header = bytes.toString("latin1", 10, start);
  const type = /'descr': '[<|]([a-z]\d)'/.exec(header)?.[1];
  if (type === undefined || !(type in types)) return undefined; // the metadata
  const shape = (/'shape': \(([^)]*)\)/.exec(header)?.[1] ?? "").split(",").filter((n) => n.trim()).map(Number);
  const data = new Uint8Array(bytes.subarray(start)).buffer;
  return { shape, values: new types[type as keyof typeof types](data) };
}
