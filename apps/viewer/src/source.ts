// Reads the bytes of the scene from elements of the page, or from the page's server.
import { SceneError } from "./scene.ts";

export async function sceneBytes(): Promise<Uint8Array> {
  const elements = [...document.querySelectorAll<HTMLScriptElement>("script.scene")];
  if (elements.length > 0) {
    const bytes = joined(elements.map((element) => fromBase64(element.textContent)));
    for (const element of elements) element.remove(); // frees its text, which is even larger
    return bytes;
  }
  if (!location.protocol.startsWith("http")) {
    throw new SceneError("this page holds no scene; `blum view FILE... -o page.html` writes one that does");
  }
  const answer = await fetch("scene.bin").catch(() => {
    throw new SceneError("the server has gone; start `blum view` again");
  });
  if (!answer.ok) throw new SceneError(`the server has no scene (status ${answer.status})`);
  return new Uint8Array(await answer.arrayBuffer());
}

function joined(parts: Uint8Array[]): Uint8Array {
  if (parts.length === 1) return parts[0];
  const out = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}

const alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

export function fromBase64(text: string): Uint8Array {
  const native = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array }).fromBase64;
  if (native !== undefined) return native.call(Uint8Array, text);
  const digit = new Uint8Array(128);
  for (let i = 0; i < 64; ++i) digit[alphabet.charCodeAt(i)] = i;
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const out = new Uint8Array((text.length / 4) * 3 - padding);
  for (let i = 0, at = 0; i < text.length; i += 4) {
    const bits =
      (digit[text.charCodeAt(i)] << 18) |
      (digit[text.charCodeAt(i + 1)] << 12) |
      ((digit[text.charCodeAt(i + 2)] & 63) << 6) |
      (digit[text.charCodeAt(i + 3)] & 63);
    out[at++] = bits >> 16;
    if (at < out.length) out[at++] = bits >> 8;
    if (at < out.length) out[at++] = bits;
  }
  return out;
}
