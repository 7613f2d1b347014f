// Shaders of surfaces, lines, dots and slices. Colours are in sRGB and are not converted.
import * as THREE from "three";
import type { Color, Colors } from "./colors.ts";
import { mapColor, mapUniforms } from "./mapshader.ts";

function colorTexture(table: Uint8Array, width: number, filter: THREE.MagnificationTextureFilter): THREE.DataTexture {
  const texture = new THREE.DataTexture(table, width, table.length / 4 / width);
  texture.magFilter = filter;
  texture.minFilter = filter;
  texture.needsUpdate = true;
  return texture;
}

type Shared = Record<"diverging" | "sequential" | "palette", { value: THREE.DataTexture | null }>;
const shared: Shared = { diverging: { value: null }, sequential: { value: null }, palette: { value: null } };

/** Sets the colours of all materials, once after the scene is read. */
export function useColors({ diverging, sequential, palette }: Colors): void {
  shared.diverging.value = colorTexture(diverging, diverging.length / 4, THREE.LinearFilter);
  shared.sequential.value = colorTexture(sequential, sequential.length / 4, THREE.LinearFilter);
  shared.palette.value = colorTexture(palette, paletteHues, THREE.NearestFilter);
}

// Looks up the colour of a region in the palette. The scrambling of its number is that of region_color() in
// apps/cli/common/colors.cpp, because a graphics card has no table of all numbers.
const paletteHues = 256;
const regionColor = /* glsl */ `
  uniform sampler2D palette;
  vec3 regionColor(int id) {
    uint x = uint(id) + 0x9e3779b9u;
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    x = x ^ (x >> 16);
    return texelFetch(palette, ivec2(int(x >> 24), int(x & 15u)), 0).rgb;
  }
`;

/** Ways to colour a surface. */
export const Coloring = { plain: 0, scalar: 1, angle: 2, region: 3 } as const;

const surfaceVertex = /* glsl */ `
  precision highp float;
  uniform mat4 modelViewMatrix, projectionMatrix;
  uniform mat3 normalMatrix;
  in vec3 position;
  #ifdef CELLS
    in vec3 cell; // radius, angle, sheet
    out vec3 vCell;
  #endif
  #ifdef NORMALS
    in vec3 normal;
    out vec3 vNormal;
  #endif
  #ifdef MAP
    in vec2 place; // texels
    centroid out vec2 vPlace; // stays within the triangle, because other charts are beside it
  #endif
  out vec3 vView;
  void main() {
    vec4 view = modelViewMatrix * vec4(position, 1.0);
    vView = view.xyz;
    #ifdef CELLS
      vCell = cell;
    #endif
    #ifdef NORMALS
      vNormal = normalMatrix * normal;
    #endif
    #ifdef MAP
      vPlace = place;
    #endif
    gl_Position = projectionMatrix * view;
  }
`;

const surfaceFragment = /* glsl */ `
  precision highp float;
  precision highp int;
  uniform vec3 color;
  uniform float opacity;
  uniform int coloring;
  uniform vec2 range;
  uniform bool isWire;
  uniform sampler2D sequential;
  ${regionColor}
  #ifdef CELLS
    in vec3 vCell;
  #endif
  #ifdef NORMALS
    in vec3 vNormal;
  #endif
  #ifdef MAP
    ${mapColor}
  #endif
  in vec3 vView;
  out vec4 outColor;
  void main() {
    vec3 base = color;
    #ifdef CELLS
      float span = max(range.y - range.x, 1e-30);
      if (coloring == 1) base = texture(sequential, vec2((vCell.x - range.x) / span, 0.5)).rgb;
      if (coloring == 2) base = texture(sequential, vec2((vCell.y - range.x) / span, 0.5)).rgb;
      if (coloring == 3) base = regionColor(int(vCell.z + 0.5));
    #endif
    #ifdef MAP
      base = mapColorAt(vPlace);
    #endif
    if (isWire) {
      outColor = vec4(base, opacity);
      return;
    }
    #ifdef NORMALS
      vec3 n = normalize(vNormal);
      #ifdef CREASES
        // An edge stays sharp if the triangle's normal differs much from the mean of its neighbours. This also covers
        // vertices at which triangles of opposite orientations meet.
        vec3 geometric = normalize(cross(dFdx(vView), dFdy(vView)));
        if (dot(n, geometric) < 0.0) n = -n;
        float agreed = dot(n, geometric);
        n = agreed == agreed ? normalize(mix(geometric, n, smoothstep(0.72, 0.9, agreed))) : geometric;
      #endif
    #else
      vec3 n = normalize(cross(dFdx(vView), dFdy(vView)));
    #endif
    vec3 eye = normalize(-vView);
    if (dot(n, eye) < 0.0) n = -n;
    float key = max(dot(n, normalize(vec3(0.35, 0.6, 0.75))), 0.0);
    float fill = max(dot(n, normalize(vec3(-0.6, -0.25, 0.6))), 0.0);
    float facing = dot(n, eye);
    #ifdef MAP
      vec3 lit = base * (0.72 + 0.24 * key + 0.1 * fill); // close to the colours of the legend
    #else
      vec3 lit = base * (0.42 + 0.5 * key + 0.18 * fill) + 0.06 * pow(key, 24.0);
    #endif
    // Translucent surfaces are denser where seen from the side, so that their shape is visible.
    float alpha = opacity < 1.0 ? mix(min(opacity * 3.2, 1.0), opacity, clamp(facing * 1.25, 0.0, 1.0)) : 1.0;
    outColor = vec4(lit, alpha);
  }
`;

export type SurfaceOptions = { hasCells?: boolean; hasNormals?: boolean; hasCreases?: boolean; hasMap?: boolean };

export function surfaceMaterial(options: SurfaceOptions = {}): THREE.RawShaderMaterial {
  const defines: Record<string, string> = {};
  if (options.hasCells === true) defines.CELLS = "";
  if (options.hasNormals === true) defines.NORMALS = "";
  if (options.hasCreases === true) defines.CREASES = "";
  if (options.hasMap === true) defines.MAP = "";
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: surfaceVertex,
    fragmentShader: surfaceFragment,
    defines,
    side: THREE.DoubleSide,
    uniforms: {
      ...shared,
      color: { value: new THREE.Vector3(0.7, 0.75, 0.8) },
      opacity: { value: 1 },
      coloring: { value: Coloring.plain as number },
      range: { value: new THREE.Vector2(0, 1) },
      isWire: { value: false },
      ...(options.hasMap === true ? mapUniforms() : {}),
    },
  });
}

export type Style = "solid" | "translucent" | "wire";

export function setStyle(material: THREE.RawShaderMaterial, style: Style, translucency = 0.16): void {
  material.wireframe = style === "wire";
  material.uniforms.isWire.value = style === "wire";
  material.uniforms.opacity.value = style === "translucent" ? translucency : 1;
  material.transparent = style === "translucent";
  material.depthWrite = style !== "translucent";
}

export function setColor(material: THREE.RawShaderMaterial, color: Color): void {
  (material.uniforms.color.value as THREE.Vector3).set(...color);
}

/** Half the size of the picture in pixels, and the pixels per unit of line width. The stage sets both. */
export const viewport = { value: new THREE.Vector2(1, 1) };
export const pixelRatio = { value: 1 };

// Lines as quads, with widths in pixels.
const lineVertex = /* glsl */ `
  precision highp float;
  uniform mat4 modelViewMatrix, projectionMatrix;
  uniform vec2 viewport;
  uniform float width, pixelRatio;
  in vec2 position; // end, side
  in vec3 from, to;
  in vec2 values;
  out float vValue;
  void main() {
    // Slightly nearer along the view, so that lines are drawn before the surface that contains them.
    vec4 a = projectionMatrix * vec4((modelViewMatrix * vec4(from, 1.0)).xyz * 0.9985, 1.0);
    vec4 b = projectionMatrix * vec4((modelViewMatrix * vec4(to, 1.0)).xyz * 0.9985, 1.0);
    vec2 direction = (b.xy / b.w - a.xy / a.w) * viewport;
    direction = length(direction) > 1e-6 ? normalize(direction) : vec2(1.0, 0.0);
    vec2 across = vec2(-direction.y, direction.x);
    vec4 at = position.x < 0.5 ? a : b;
    vec2 offset = across * position.y + direction * (position.x - 0.5); // square caps: no gaps at bends
    at.xy += offset * 0.5 * width * pixelRatio / viewport * at.w;
    vValue = position.x < 0.5 ? values.x : values.y;
    gl_Position = at;
  }
`;

const lineFragment = /* glsl */ `
  precision highp float;
  uniform vec3 color;
  uniform float opacity;
  uniform int coloring;
  uniform vec2 range;
  uniform sampler2D sequential;
  in float vValue;
  out vec4 outColor;
  void main() {
    vec3 base = color;
    if (coloring != 0) base = texture(sequential, vec2((vValue - range.x) / max(range.y - range.x, 1e-30), 0.5)).rgb;
    outColor = vec4(base, opacity);
  }
`;

export function lineMaterial(color: Color, width: number): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: lineVertex,
    fragmentShader: lineFragment,
    side: THREE.DoubleSide,
    uniforms: {
      ...shared,
      color: { value: new THREE.Vector3(...color) },
      opacity: { value: 1 },
      width: { value: width },
      viewport,
      pixelRatio,
      coloring: { value: 0 },
      range: { value: new THREE.Vector2(0, 1) },
    },
  });
}

/** Returns lines between pairs of places; `values` has one number for each end. */
export function lineGeometry(ends: Float32Array, values?: Float32Array): THREE.InstancedBufferGeometry {
  const geometry = new THREE.InstancedBufferGeometry();
  const quad = new Float32Array([0, -1, 0, 1, 1, -1, 1, 1]);
  geometry.setAttribute("position", new THREE.BufferAttribute(quad, 2));
  geometry.setIndex([0, 2, 1, 1, 2, 3]);
  const pairs = new THREE.InstancedInterleavedBuffer(ends, 6);
  geometry.setAttribute("from", new THREE.InterleavedBufferAttribute(pairs, 3, 0));
  geometry.setAttribute("to", new THREE.InterleavedBufferAttribute(pairs, 3, 3));
  const count = ends.length / 6;
  geometry.setAttribute("values", new THREE.InstancedBufferAttribute(values ?? new Float32Array(2 * count), 2));
  geometry.instanceCount = count;
  geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), Infinity); // `position` contains no positions
  return geometry;
}

export function dotMaterial(color: Color, size: number): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: /* glsl */ `
      precision highp float;
      uniform mat4 modelViewMatrix, projectionMatrix;
      uniform float size, pixelRatio;
      in vec3 position;
      void main() {
        gl_Position = projectionMatrix * vec4((modelViewMatrix * vec4(position, 1.0)).xyz * 0.997, 1.0);
        gl_PointSize = size * pixelRatio;
      }
    `,
    fragmentShader: /* glsl */ `
      precision highp float;
      uniform vec3 color;
      uniform float opacity;
      out vec4 outColor;
      void main() {
        if (length(gl_PointCoord - 0.5) > 0.5) discard;
        outColor = vec4(color, opacity);
      }
    `,
    uniforms: {
      color: { value: new THREE.Vector3(...color) },
      opacity: { value: 1 },
      size: { value: size },
      pixelRatio,
    },
  });
}

/** Makes a line or dots faint, and visible through surfaces. For a second drawing below the first one. */
export function shineThrough(material: THREE.RawShaderMaterial, opacity: number): void {
  material.uniforms.opacity.value = opacity;
  material.transparent = true;
  material.depthTest = false;
  material.depthWrite = false;
}

/** Ways to draw the values of a slice. */
export const SliceMode = { distance: 0, sites: 1, labels: 2, grey: 3 } as const;

const sliceFragment = /* glsl */ `
  precision highp float;
  precision highp int;
  precision highp sampler2D;
  precision highp isampler2D;
  uniform sampler2D values;
  uniform isampler2D sites;
  uniform ivec2 size;
  uniform int mode;
  uniform bool isLinear, hasSign;
  uniform vec2 range;     // range of the values
  uniform vec2 extremes;  // inside, outside
  uniform float band;     // 0: none
  uniform float contour;  // 0: none
  uniform sampler2D diverging, sequential;
  ${regionColor}
  in vec2 vAt; // index coordinates
  out vec4 outColor;
  const vec3 ink = vec3(0.09, 0.10, 0.13);
  const vec3 nothing = vec3(0.72);
  float valueAt(ivec2 at) { return texelFetch(values, clamp(at, ivec2(0), size - 1), 0).r; }
  float interpolated(vec2 at) {
    vec2 low = floor(at);
    vec2 f = at - low;
    ivec2 i = ivec2(low);
    return mix(mix(valueAt(i), valueAt(i + ivec2(1, 0)), f.x),
               mix(valueAt(i + ivec2(0, 1)), valueAt(i + ivec2(1, 1)), f.x), f.y);
  }
  void main() {
    ivec2 nearest = clamp(ivec2(floor(vAt + 0.5)), ivec2(0), size - 1);
    float smoothValue = interpolated(vAt);
    float slope = fwidth(smoothValue);
    float value = isLinear && mode != ${SliceMode.labels} ? smoothValue : valueAt(nearest);
    vec3 color;
    if (mode == ${SliceMode.sites}) {
      int site = texelFetch(sites, nearest, 0).r;
      color = site < 0 ? nothing : regionColor(site);
    } else if (mode == ${SliceMode.labels}) {
      color = value == 0.0 ? vec3(0.93) : regionColor(int(value));
    } else if (mode == ${SliceMode.grey}) {
      color = vec3(mix(0.06, 0.96, clamp((value - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0)));
    } else {
      bool isBeyond = band > 0.0 && abs(value) >= band * (1.0 - 1e-6);
      float t = value < 0.0 ? max(value / extremes.x, -1.0) : min(value / extremes.y, 1.0);
      float colors = float(textureSize(diverging, 0).x);
      color = hasSign ? texture(diverging, vec2(0.5 + 0.5 * t * (colors - 1.0) / colors, 0.5)).rgb
                      : texture(sequential, vec2(t, 0.5)).rgb;
      if (isBeyond) color = nothing;
    }
    if (mode == ${SliceMode.distance} && slope > 0.0 && !(band > 0.0 && abs(smoothValue) >= band * (1.0 - 1e-6))) {
      if (contour > 0.0) {
        float level = round(smoothValue / contour);
        bool isStrong = mod(abs(level), 5.0) == 0.0;
        float pixels = abs(smoothValue - level * contour) / slope;
        float room = clamp(contour / slope / 3.0 - 1.0, 0.0, 1.0);
        float cover = clamp((isStrong ? 1.25 : 1.0) - pixels, 0.0, 1.0) * room;
        if (level != 0.0) color = mix(color, ink, cover * (isStrong ? 0.6 : 0.33));
      }
      if (hasSign) color = mix(color, ink, clamp(1.8 - abs(smoothValue) / slope, 0.0, 1.0));
    }
    if (!(value == value)) color = nothing;
    outColor = vec4(color, 1.0);
  }
`;

export function sliceMaterial(): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: /* glsl */ `
      precision highp float;
      uniform mat4 modelViewMatrix, projectionMatrix;
      in vec3 position;
      in vec2 at;
      out vec2 vAt;
      void main() {
        vAt = at;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }
    `,
    fragmentShader: sliceFragment,
    side: THREE.DoubleSide,
    // Draws it behind items in its plane, for example sheets of a plate's axis.
    polygonOffset: true,
    polygonOffsetFactor: 2,
    polygonOffsetUnits: 8,
    uniforms: {
      ...shared,
      values: { value: null },
      sites: { value: null },
      size: { value: [1, 1] },
      mode: { value: SliceMode.distance as number },
      isLinear: { value: true },
      hasSign: { value: true },
      range: { value: new THREE.Vector2(0, 1) },
      extremes: { value: new THREE.Vector2(1, 1) },
      band: { value: 0 },
      contour: { value: 0 },
    },
  });
}
