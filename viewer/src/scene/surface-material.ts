// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { type DataTexture, GLSL3, RawShaderMaterial, Vector2, Vector3, Vector4 } from 'three';
import { EVIDENCE_M, EVIDENCE_RAMP } from './coloring';

const VERTEX = /* glsl */ `
precision highp float;
precision highp int;
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
in vec4 position;   // place in the chunk's cube; w: octahedral normal, 8 bits an axis
in vec4 color;     // w: how well the place is known, a fifth of a millimetre a step; 0: not told
in uint label;
out vec3 vColor;
out float vError;
out vec3 vNormal;
out vec3 vWorld;
flat out uint vLabel;

vec3 unfold(float packedNormal) {
  float bits = floor(packedNormal * 65535.0 + 0.5);
  vec2 e = vec2(floor(bits / 256.0), mod(bits, 256.0)) / 255.0 * 2.0 - 1.0;
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}

void main() {
  vec4 world = modelMatrix * vec4(position.xyz, 1.0);
  vWorld = world.xyz;
  vNormal = unfold(position.w);
  vColor = color.rgb;
  vError = color.a * 255.0 * 0.0002;
  vLabel = label;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
uniform sampler2D labelColors;  // 256 labels a row; alpha 0: hidden, about a half: selected
uniform bool ownColors;            // the surface's own instead of the table's
uniform bool showEvidence;         // how well places are known
uniform vec3 evidenceRamp[4];
uniform vec2 evidenceEnds;         // standard error, metres
uniform bool selecting;         // an object is selected
uniform vec4 section;              // what is beyond n.x + d > 0 is cut away; 0: nothing
uniform vec3 fade;                 // the colour that unselected surface fades to
uniform vec3 light;                // from where it shines
in vec3 vColor;
in float vError;
in vec3 vNormal;
in vec3 vWorld;
flat in uint vLabel;
out vec4 pixel;

vec3 evidence() {
  if (vError == 0.0) return vec3(0.55);
  float at = 3.0 * clamp(log(vError / evidenceEnds.x) / log(evidenceEnds.y / evidenceEnds.x), 0.0, 1.0);
  if (at < 1.0) return mix(evidenceRamp[0], evidenceRamp[1], at);
  if (at < 2.0) return mix(evidenceRamp[1], evidenceRamp[2], at - 1.0);
  return mix(evidenceRamp[2], evidenceRamp[3], at - 2.0);
}

void main() {
  if (dot(section.xyz, vWorld) + section.w > 0.0) discard;
  vec4 entry = texelFetch(labelColors, ivec2(int(vLabel & 255u), int(vLabel >> 8)), 0);
  if (entry.a == 0.0) discard;
  float facing = 0.5 + 0.5 * dot(normalize(vNormal), light);
  vec3 shown;
  if (ownColors) {
    shown = vColor * (0.82 + 0.25 * facing);
  } else if (showEvidence) {
    shown = evidence() * (0.65 + 0.45 * facing);
  } else {
    float luminance = dot(vColor, vec3(0.3, 0.59, 0.11));
    shown = entry.rgb * (0.5 + 0.4 * facing + 0.25 * luminance);
  }
  if (selecting)
    shown = entry.a < 0.75 ? shown * 1.12 + 0.03 : mix(shown, fade, 0.62);
  pixel = vec4(min(shown, 1.0), 1.0);
}`;

/** Draws chunks. Colours are shown as they are stored (sRGB), as in the map's pictures. */
export function surfaceMaterial(labelColors: DataTexture): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: {
      labelColors: { value: labelColors },
      ownColors: { value: true },
      showEvidence: { value: false },
      evidenceRamp: {
        value: EVIDENCE_RAMP.map((color) => new Vector3(...color).divideScalar(255)),
      },
      evidenceEnds: { value: new Vector2(...EVIDENCE_M) },
      selecting: { value: false },
      section: { value: new Vector4(0, 0, 0, 0) },
      fade: { value: [0.5, 0.5, 0.5] },
      light: { value: [0, 0, 1] },
    },
  });
}
