// Lays out scenes as apps/cli/view/scene_blob.cpp does.
import { deflateSync } from "node:zlib";

const types = new Map<unknown, string>([
  [Float32Array, "f4"],
  [Float64Array, "f8"],
  [Uint32Array, "u4"],
  [Uint8Array, "u1"],
]);

export type Part = { numbers: Float32Array | Float64Array | Uint32Array | Uint8Array; coding: "raw" | "deflate" | "delta" };

export function delta(numbers: Part["numbers"]): Uint8Array {
  const bits = new Uint32Array(numbers.buffer.slice(0));
  const out = new Uint8Array(4 * bits.length);
  bits.forEach((value, i) => {
    const difference = (value - (i > 0 ? bits[i - 1] : 0)) >>> 0;
    for (let b = 0; b < 4; ++b) out[b * bits.length + i] = difference >>> (8 * b);
  });
  return out;
}

/** A scene as apps/cli/view/scene_blob.cpp lays it out. */
export function sceneOf(header: (entries: object[]) => object, parts: Part[]): Uint8Array {
  const stored: Uint8Array[] = [];
  let offset = 0;
  const entries = parts.map(({ numbers, coding }) => {
    const bytes = new Uint8Array(numbers.buffer);
    const data = coding === "raw" ? bytes : deflateSync(coding === "delta" ? delta(numbers) : bytes);
    const type = types.get(numbers.constructor);
    const entry = { type, count: numbers.length, offset, bytes: data.length, coding };
    const padded = new Uint8Array(Math.ceil(data.length / 8) * 8);
    padded.set(data);
    stored.push(padded);
    offset += padded.length;
    return entry;
  });
  let text = JSON.stringify(header(entries));
  while (text.length % 8 !== 0) text += " ";
  const out = new Uint8Array(16 + text.length + offset);
  out.set(new TextEncoder().encode("BLUMVIEW"));
  new DataView(out.buffer).setUint32(8, 2, true);
  new DataView(out.buffer).setUint32(12, text.length, true);
  out.set(new TextEncoder().encode(text), 16);
  let at = 16 + text.length;
  for (const part of stored) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
