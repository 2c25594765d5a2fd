// The layer of verdicts: all poses in one instanced draw call. Colours come from small tables, so switching verdicts
// off or showing another quantity does not build the poses' buffers again.
import {
  BufferAttribute, DataTexture, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, IntType, LinearFilter, Mesh,
  RGBAFormat, ShaderMaterial, Vector2, Vector3,
} from 'three';
import { inkGlsl } from './shaders.js';
import { ISLAND_COLORS, NO_ISLAND_COLOR, NO_VALUE_COLOR, rgb, viridis } from './palette.js';
import { drawnValues, groundSlopes } from './layer_data.js';

const MODES = { verdict: 0, quantity: 1, island: 2, height: 3 };

const vertexShader = /* glsl */ `
  in uint cell;
  in int height;
  in vec4 look;    // verdict, 128 + 64 * slope in x and in y
  in float value;  // of the quantity, or number of the island
  uniform uint cols;
  uniform vec2 corner;
  uniform float spacing, z0, unit, cut, lift;
  uniform vec4 palette[32];
  flat out int verdict;
  flat out float amount;
  flat out float light;
  out vec2 inside;
  out float high;
  void main() {
    verdict = int(look.x + 0.5);
    vec2 slope = (look.yz - 128.0) / 64.0;
    vec3 place = vec3(corner + spacing * vec2(float(cell % cols), float(cell / cols)), z0 + unit * float(height));
    high = place.z;
    amount = value;
    inside = position.xy + 0.5;
    light = 0.74 + 0.26 * dot(normalize(vec3(-slope, 1.0)), normalize(vec3(-0.45, -0.55, 0.8))) / 0.72;
    if (palette[verdict].w < 0.5 || place.z > cut) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      return;
    }
    place += vec3(spacing * position.xy, spacing * dot(slope, position.xy) + lift);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
  }
`;

const fragmentShader = /* glsl */ `
  flat in int verdict;
  flat in float amount;
  flat in float light;
  in vec2 inside;
  in float high;
  out vec4 color;
  uniform vec4 palette[32];
  uniform vec3 islandColors[8];
  uniform vec3 noValue;
  uniform sampler2D ramp;
  uniform int mode;
  uniform vec2 range;      // quantity: stored values; height: m above the origin
  uniform float opacity;
  ${inkGlsl}
  void main() {
    vec3 base = palette[verdict].rgb;
    if (mode == 1) {
      base = amount > 65534.5 ? noValue : texture(ramp, vec2((amount - range.x) / max(range.y - range.x, 1e-9), 0.5)).rgb;
    } else if (mode == 2) {
      base = islandColors[amount < 0.5 ? 7 : int(min(amount, 7.0) - 0.5)];
    } else if (mode == 3) {
      base = texture(ramp, vec2((high - range.x) / max(range.y - range.x, 1e-9), 0.5)).rgb;
    }
    base = mode == 0 ? inked(base, verdict) : base;
    vec2 width = fwidth(inside);
    vec2 edge = min(inside, 1.0 - inside) / width;
    // Lines between the poses appear gradually where a square has more than 11 pixels.
    float line = min(edge.x, edge.y) < 0.9 ? 1.0 - 0.16 * smoothstep(0.09, 0.045, max(width.x, width.y)) : 1.0;
    color = vec4(base * light * line, opacity);
  }
`;

function rampTexture() {
  const pixels = new Uint8Array(256 * 4);
  for (let at = 0; at < 256; ++at) pixels.set([...viridis(at / 255).map((value) => Math.round(255 * value)), 255], 4 * at);
  const texture = new DataTexture(pixels, 256, 1, RGBAFormat);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

const SQUARE = [-0.5, -0.5, 0, 0.5, -0.5, 0, -0.5, 0.5, 0, 0.5, 0.5, 0];
const SQUARE_INDEX = [0, 1, 2, 2, 1, 3];

/**
 * Returns {object, show(layer), colorBy(how), setOpacity(share)}: the drawn layer. `show` takes a layer of
 * layer_data.js; its buffers are built once and kept as long as the layer is. `colorBy` takes {mode, quantity, range}.
 */
export function createVerdictLayer(shared, origin) {
  const uniforms = {
    ...shared, cols: { value: 1 }, corner: { value: new Vector2() }, spacing: { value: 1 }, z0: { value: 0 },
    unit: { value: 1 }, lift: { value: 0 }, mode: { value: MODES.verdict }, range: { value: new Vector2(0, 1) },
    opacity: { value: 0.75 }, ramp: { value: rampTexture() }, noValue: { value: new Vector3(...rgb(NO_VALUE_COLOR)) },
    islandColors: { value: [...ISLAND_COLORS, NO_ISLAND_COLOR].map((color) => new Vector3(...rgb(color))) },
  };
  const material = new ShaderMaterial({
    glslVersion: GLSL3, vertexShader, fragmentShader, uniforms, transparent: true, side: 2,
    polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -8,
  });
  const object = new Mesh(new InstancedBufferGeometry(), material);
  object.frustumCulled = false;
  object.renderOrder = 2;
  object.visible = false;
  const built = new WeakMap();
  let shown = null;

  return {
    object,
    show(layer) {
      shown = layer;
      object.visible = Boolean(layer && layer.count > 0);
      if (!object.visible) return;
      if (!built.has(layer)) built.set(layer, poseGeometry(layer));
      object.geometry = built.get(layer);
      uniforms.cols.value = layer.grid.cols;
      uniforms.corner.value.set(layer.grid.x0 - origin[0], layer.grid.y0 - origin[1]);
      uniforms.spacing.value = layer.grid.step;
      uniforms.z0.value = layer.z0 - origin[2];
      uniforms.unit.value = layer.unit;
      uniforms.lift.value = Math.min(0.02 + 0.02 * layer.grid.step, 0.1);
    },
    /** Frees the buffers of a layer that is not shown again. */
    forget(layer) {
      built.get(layer)?.dispose();
      built.delete(layer);
    },
    colorBy({ mode, quantity, range }) {
      uniforms.mode.value = MODES[mode];
      if (!shown || shown.count === 0) return;
      if (mode === 'quantity') {
        setValues(object.geometry, quantity.values());
        uniforms.range.value.set(...range.map((value) => (value - quantity.offset) / quantity.scale));
      } else if (mode === 'island') {
        setValues(object.geometry, shown.island());
      } else if (mode === 'height') {
        uniforms.range.value.set(range[0] - origin[2], range[1] - origin[2]);
      }
    },
    setOpacity(share) {
      uniforms.opacity.value = share;
      material.depthWrite = true;
    },
  };
}

function setValues(geometry, values) {
  if (geometry.userData.values === values) return;
  geometry.userData.values = values;
  geometry.setAttribute('value', new InstancedBufferAttribute(values, 1));
}

function poseGeometry(layer) {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(SQUARE), 3));
  geometry.setIndex(new BufferAttribute(new Uint16Array(SQUARE_INDEX), 1));
  geometry.instanceCount = layer.count;
  geometry.setAttribute('cell', integers(layer.cell));
  geometry.setAttribute('height', integers(drawnValues(layer)));
  const slopes = groundSlopes(layer);
  const look = new Uint8Array(4 * layer.count);
  for (let pose = 0; pose < layer.count; ++pose) {
    look[4 * pose] = layer.verdict[pose];
    look[4 * pose + 1] = slopes[2 * pose];
    look[4 * pose + 2] = slopes[2 * pose + 1];
  }
  geometry.setAttribute('look', new InstancedBufferAttribute(look, 4));
  return geometry;
}

function integers(values) {
  const attribute = new InstancedBufferAttribute(values, 1);
  attribute.gpuType = IntType;
  return attribute;
}
