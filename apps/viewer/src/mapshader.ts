// Shader of surface maps. The texture contains values, so that the page can change their colours.
import * as THREE from "three";
import type { Color } from "./colors.ts";
import type { MapItem } from "./scene.ts";

// All texels are stored in rows of this length, because a map may be wider than the largest texture.
const fold = 4096;
const none = 3e38; // marks texels without a finite value

/** Colour of places below the threshold. */
export const markColor: Color = [0.93, 0.07, 0.5];

/** Computes the colour at a place in texels. Interpolates values like LINEAR without mipmaps, clamped. */
export const mapColor = /* glsl */ `
  precision highp sampler2D;
  uniform sampler2D values, diverging;
  uniform ivec2 size;
  uniform bool isLinear, isDiverging, isMarked;
  uniform vec2 extremes; // inside, outside
  uniform float threshold;
  centroid in vec2 vPlace;
  float valueOf(ivec2 at) {
    ivec2 inside = clamp(at, ivec2(0), size - 1);
    int texel = inside.y * size.x + inside.x;
    return texelFetch(values, ivec2(texel & ${fold - 1}, texel >> ${Math.log2(fold)}), 0).r;
  }
  vec3 mapColorAt(vec2 place) {
    float value = valueOf(ivec2(floor(place)));
    if (value > ${none / 10}) return vec3(0.72);
    if (isLinear) {
      ivec2 i = ivec2(floor(place - 0.5));
      vec2 f = place - 0.5 - vec2(i);
      vec4 four = vec4(valueOf(i), valueOf(i + ivec2(1, 0)), valueOf(i + ivec2(0, 1)), valueOf(i + ivec2(1, 1)));
      if (all(lessThan(four, vec4(${none / 10})))) value = mix(mix(four.x, four.y, f.x), mix(four.z, four.w, f.x), f.y);
    }
    if (isMarked && value <= threshold) return vec3(${markColor.join(", ")});
    if (!isDiverging) return texture(sequential, vec2((value - range.x) / max(range.y - range.x, 1e-30), 0.5)).rgb;
    float t = value < 0.0 ? max(value / extremes.x, -1.0) : min(value / extremes.y, 1.0);
    float colors = float(textureSize(diverging, 0).x);
    return texture(diverging, vec2(0.5 + 0.5 * t * (colors - 1.0) / colors, 0.5)).rgb;
  }
`;

export const mapUniforms = (): Record<string, THREE.IUniform> => ({
  values: { value: null },
  size: { value: [1, 1] },
  isLinear: { value: true },
  isDiverging: { value: false },
  isMarked: { value: false },
  extremes: { value: new THREE.Vector2(1, 1) },
  threshold: { value: 0 },
});

/** Returns the values of a map in the layout of mapColor. */
export function valueTexture({ distance }: MapItem): THREE.DataTexture {
  const rows = Math.ceil(distance.length / fold);
  const numbers = new Float32Array(rows * fold).fill(none);
  for (let i = 0; i < distance.length; ++i) if (Number.isFinite(distance[i])) numbers[i] = distance[i];
  const texture = new THREE.DataTexture(numbers, fold, rows, THREE.RedFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}
