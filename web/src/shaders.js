// GLSL that several materials share, and their common uniforms.
import { DataTexture, NearestFilter, RedFormat, Vector2, Vector4 } from 'three';
import { patternPixels, PATTERN_SIZE, rgb, verdictPatterns } from './palette.js';

export const MOST_VERDICTS = 32;

export const shadeGlsl = /* glsl */ `
  // Light on a surface whose normal comes from the derivatives of its position: meshes need no normals.
  float shade(vec3 place, vec3 toEye) {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    if (dot(normal, toEye) < 0.0) normal = -normal;
    return 0.62 + 0.38 * max(dot(normal, normalize(vec3(-0.45, -0.55, 0.8))), 0.0) - 0.10 * max(-normal.z, 0.0);
  }
`;

export const inkGlsl = /* glsl */ `
  uniform sampler2D patternMap;
  uniform float patterns;    // 0: off, 1: on
  uniform float pixelRatio;
  // The colour of a verdict with its pattern, at a pixel of the screen.
  vec3 inked(vec3 color, int verdict) {
    if (patterns < 0.5) return color;
    ivec2 pixel = ivec2(gl_FragCoord.xy / pixelRatio) % ${PATTERN_SIZE};
    float ink = texelFetch(patternMap, ivec2(pixel.x, verdict * ${PATTERN_SIZE} + ${PATTERN_SIZE - 1} - pixel.y), 0).r;
    float light = step(0.5, dot(color, vec3(0.299, 0.587, 0.114)));
    return mix(color, vec3(1.0 - light), 0.85 * ink);
  }
`;

/** Returns the uniforms that all materials of a page share; changing a value changes all of them. */
export function sharedUniforms(verdicts) {
  const patterns = verdictPatterns(verdicts);
  const map = new DataTexture(patternPixels(patterns), PATTERN_SIZE, PATTERN_SIZE * patterns.length, RedFormat);
  map.minFilter = map.magFilter = NearestFilter;
  map.needsUpdate = true;
  const colors = Array.from(
    { length: MOST_VERDICTS },
    (_, verdict) => new Vector4(...rgb(verdicts[verdict]?.color), 1),
  );
  return {
    cut: { value: 1e30 }, // height above the origin; what is above is not drawn
    palette: { value: colors }, // colour of each verdict; the fourth value is 0 if it is switched off
    patterns: { value: 0 },
    patternMap: { value: map },
    pixelRatio: { value: 1 },
    viewport: { value: new Vector2(1, 1) }, // size of the picture in pixels
    dark: { value: 0 },
  };
}
