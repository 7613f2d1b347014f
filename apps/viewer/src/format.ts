// Numbers as text.

/** Returns the shortest text that reads back as the same single-precision number, as in a file with float32. */
export function exactFloat32(value: number): string {
  if (!Number.isFinite(value)) return String(value);
  for (let digits = 1; digits < 9; ++digits) {
    const text = Number(value.toPrecision(digits));
    if (Math.fround(text) === value) return String(text);
  }
  return String(Number(value.toPrecision(9)));
}

/** Returns a number with few digits, for people. */
export function rounded(value: number, digits = 6): string {
  return Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : String(value);
}

export function counted(count: number): string {
  return count.toLocaleString("en-US");
}

export function plural(count: number, one: string, many = `${one}s`): string {
  return `${counted(count)} ${count === 1 ? one : many}`;
}

export function place(p: ArrayLike<number>): string {
  return `(${rounded(p[0])}, ${rounded(p[1])}, ${rounded(p[2])})`;
}

/** Returns 1, 2 or 5 times a power of ten, such that about `wanted` steps fit into a range. */
export function roundStep(range: number, wanted: number): number {
  if (!(range > 0) || !Number.isFinite(range)) return 0;
  const power = 10 ** Math.floor(Math.log10(range / wanted));
  const lead = range / wanted / power;
  // Powers of ten below 1 are not exact, but their texts are.
  return Number((power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10)).toPrecision(3));
}
