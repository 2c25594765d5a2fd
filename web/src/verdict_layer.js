// The layer of verdicts: all poses in one instanced draw call. Colours come from small tables, so switching verdicts
// off or showing another quantity does not build the poses' buffers again.
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  GLSL3,
  Group,
  InstancedBufferGeometry,
  LinearFilter,
  Mesh,
  Points,
  RGBAFormat,
  RGBAIntegerFormat,
  RGIntegerFormat,
  RedIntegerFormat,
  ShaderMaterial,
  UnsignedByteType,
  UnsignedIntType,
  UnsignedShortType,
  Vector2,
  Vector3,
} from 'three';
import { inkGlsl } from './shaders.js';
import { ISLAND_COLORS, NO_ISLAND_COLOR, NO_VALUE_COLOR, rgb, viridis } from './palette.js';
import { drawnValues, groundSlopes } from './layer_data.js';

const MODES = { verdict: 0, quantity: 1, island: 2, height: 3 };
// Poses are read from textures, and an instance is a batch of squares: graphics processors draw instances of a single
// square several times slower.
const BATCH = 256;
const TEXTURE_WIDTH = 2048;
const SMALLEST_SQUARE = 2.5; // pixels; where all squares are smaller, they are drawn as points

const vertexShader = /* glsl */ `
  uniform highp usampler2D places;  // cell, height
  uniform highp usampler2D looks;   // verdict, 128 + 64 * slope in x and in y
  uniform highp usampler2D values;  // of the quantity, or number of the island
  uniform int count, cols, mode;
  uniform vec2 corner;
  uniform float spacing, z0, unit, cut, lift, pointScale;
  uniform vec4 palette[32];
  flat out int verdict;
  flat out float amount;
  flat out float light;
  out vec2 inside;
  out float high;
  const vec4 NOWHERE = vec4(2.0, 2.0, 2.0, 1.0);
  void main() {
    #ifdef POINTS
      int pose = gl_VertexID;
      vec2 side = vec2(0.0);
    #else
      int pose = ${BATCH} * gl_InstanceID + (gl_VertexID >> 2);
      vec2 side = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) - 0.5;
    #endif
    gl_Position = NOWHERE;
    verdict = 0;
    amount = light = high = 0.0;
    inside = side + 0.5;
    if (pose >= count) return;
    ivec2 texel = ivec2(pose % ${TEXTURE_WIDTH}, pose / ${TEXTURE_WIDTH});
    uvec4 look = texelFetch(looks, texel, 0);
    verdict = int(look.x);
    if (palette[verdict].w < 0.5) return;
    uvec4 stored = texelFetch(places, texel, 0);
    high = z0 + unit * float(int(stored.y));
    if (high > cut) return;
    vec2 slope = (vec2(look.yz) - 128.0) / 64.0;
    int cell = int(stored.x);
    vec2 across = corner + spacing * (vec2(cell % cols, cell / cols) + side);
    vec3 place = vec3(across, high + spacing * dot(slope, side) + lift);
    #ifdef POINTS
      place.z += 0.3 * spacing;  // instead of the offset of polygons; less than a pixel
    #endif
    if (mode == 1 || mode == 2) amount = float(texelFetch(values, texel, 0).x);
    light = 0.74 + 0.26 * dot(normalize(vec3(-slope, 1.0)), normalize(vec3(-0.45, -0.55, 0.8))) / 0.72;
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
    #ifdef POINTS
      gl_PointSize = max(1.0, 1.5 * pointScale / gl_Position.w);
    #endif
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
      float share = (amount - range.x) / max(range.y - range.x, 1e-9);
      base = amount > 65534.5 ? noValue : texture(ramp, vec2(share, 0.5)).rgb;
    } else if (mode == 2) {
      base = islandColors[amount < 0.5 ? 7 : int(min(amount, 7.0) - 0.5)];
    } else if (mode == 3) {
      base = texture(ramp, vec2((high - range.x) / max(range.y - range.x, 1e-9), 0.5)).rgb;
    }
    base = mode == 0 ? inked(base, verdict) : base;
    #ifdef POINTS
      color = vec4(base * light, opacity);
      return;
    #endif
    vec2 width = fwidth(inside);
    vec2 edge = min(inside, 1.0 - inside) / width;
    // Lines between the poses appear gradually where a square has more than 11 pixels.
    float line = min(edge.x, edge.y) < 0.9 ? 1.0 - 0.16 * smoothstep(0.09, 0.045, max(width.x, width.y)) : 1.0;
    color = vec4(base * light * line, opacity);
  }
`;

function rampTexture() {
  const pixels = new Uint8Array(256 * 4);
  for (let at = 0; at < 256; ++at)
    pixels.set([...viridis(at / 255).map((value) => Math.round(255 * value)), 255], 4 * at);
  const texture = new DataTexture(pixels, 256, 1, RGBAFormat);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/**
 * Returns {object, show(layer), aim(view), forget(layer), colorBy(how), setOpacity(share)}: the drawn layer, one draw
 * call. `show` takes a layer of layer_data.js; its textures are built once and kept as long as the layer is. `colorBy`
 * takes {mode, quantity, range}. `aim` has to be called before each picture.
 */
export function createVerdictLayer(shared, origin) {
  const uniforms = {
    ...shared,
    places: { value: null },
    looks: { value: null },
    values: { value: noValues() },
    count: { value: 0 },
    cols: { value: 1 },
    corner: { value: new Vector2() },
    spacing: { value: 1 },
    z0: { value: 0 },
    unit: { value: 1 },
    lift: { value: 0 },
    pointScale: { value: 1 },
    mode: { value: MODES.verdict },
    range: { value: new Vector2(0, 1) },
    opacity: { value: 0.75 },
    ramp: { value: rampTexture() },
    noValue: { value: new Vector3(...rgb(NO_VALUE_COLOR)) },
    islandColors: { value: [...ISLAND_COLORS, NO_ISLAND_COLOR].map((color) => new Vector3(...rgb(color))) },
  };
  const material = (defines) =>
    new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      uniforms,
      defines,
      transparent: true,
      side: 2,
      polygonOffset: true,
      polygonOffsetFactor: -2,
      polygonOffsetUnits: -8,
    });
  const squares = new Mesh(batchGeometry(), material({}));
  const points = new Points(new BufferGeometry(), material({ POINTS: 1 }));
  const object = new Group();
  object.add(squares, points);
  for (const drawn of [squares, points]) {
    drawn.frustumCulled = false;
    drawn.renderOrder = 2;
  }
  object.visible = false;
  const built = new WeakMap();
  let shown = null;

  function setValues(values) {
    const made = built.get(shown);
    if (made.valuesOf !== values) {
      made.values?.dispose();
      made.values = poseTexture(values, 1, Uint16Array, RedIntegerFormat, UnsignedShortType, 'R16UI');
      made.valuesOf = values;
    }
    uniforms.values.value = made.values;
  }

  return {
    object,
    show(layer) {
      shown = layer;
      object.visible = Boolean(layer && layer.count > 0);
      if (!object.visible) return;
      if (!built.has(layer)) built.set(layer, poseTextures(layer));
      const { places, looks } = built.get(layer);
      uniforms.places.value = places;
      uniforms.looks.value = looks;
      uniforms.count.value = layer.count;
      squares.geometry.instanceCount = Math.ceil(layer.count / BATCH);
      points.geometry.setDrawRange(0, layer.count);
      uniforms.cols.value = layer.grid.cols;
      uniforms.corner.value.set(layer.grid.x0 - origin[0], layer.grid.y0 - origin[1]);
      uniforms.spacing.value = layer.grid.step;
      uniforms.z0.value = layer.z0 - origin[2];
      uniforms.unit.value = layer.unit;
      uniforms.lift.value = Math.min(0.02 + 0.02 * layer.grid.step, 0.1);
    },
    /** Chooses squares or points for the view of now. */
    aim(view) {
      if (!object.visible) return;
      const pixels = shown.grid.step * view.largestScale();
      points.visible = pixels < SMALLEST_SQUARE;
      squares.visible = !points.visible;
      uniforms.pointScale.value = shown.grid.step * view.pixelsAtUnitDepth();
    },
    /** Frees the textures of a layer that is not shown again. */
    forget(layer) {
      const made = built.get(layer);
      [made?.places, made?.looks, made?.values].forEach((texture) => texture?.dispose());
      built.delete(layer);
    },
    colorBy({ mode, quantity, range }) {
      uniforms.mode.value = MODES[mode];
      if (!object.visible) return;
      if (mode === 'quantity') {
        setValues(quantity.values());
        uniforms.range.value.set(...range.map((value) => (value - quantity.offset) / quantity.scale));
      } else if (mode === 'island') {
        setValues(shown.island());
      } else if (mode === 'height') {
        uniforms.range.value.set(range[0] - origin[2], range[1] - origin[2]);
      }
    },
    setOpacity(share) {
      uniforms.opacity.value = share;
    },
  };
}

/** Returns the squares of a batch: four corners each, which the shader tells apart by their number. */
function batchGeometry() {
  const geometry = new InstancedBufferGeometry();
  const index = new Uint16Array(6 * BATCH);
  for (let square = 0; square < BATCH; ++square)
    index.set(
      [0, 1, 2, 2, 1, 3].map((corner) => 4 * square + corner),
      6 * square,
    );
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

/** Returns a texture with `width` values for each pose. */
function poseTexture(values, width, Type, format, type, internalFormat) {
  const poses = values.length / width;
  const rows = Math.max(1, Math.ceil(poses / TEXTURE_WIDTH));
  const padded = new Type(rows * TEXTURE_WIDTH * width);
  padded.set(values);
  const texture = new DataTexture(padded, TEXTURE_WIDTH, rows, format, type);
  texture.internalFormat = internalFormat;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  // The graphics memory has the values now; a second copy would double the page's memory.
  texture.onUpdate = () => {
    texture.image.data = null;
  };
  return texture;
}

const noValues = () => poseTexture(new Uint16Array(1), 1, Uint16Array, RedIntegerFormat, UnsignedShortType, 'R16UI');

function poseTextures(layer) {
  const places = new Uint32Array(2 * layer.count);
  const looks = new Uint8Array(4 * layer.count);
  const heights = drawnValues(layer);
  const slopes = groundSlopes(layer, heights);
  for (let pose = 0; pose < layer.count; ++pose) {
    places[2 * pose] = layer.cell[pose];
    places[2 * pose + 1] = heights[pose];
    looks[4 * pose] = layer.verdict[pose];
    looks[4 * pose + 1] = slopes[2 * pose];
    looks[4 * pose + 2] = slopes[2 * pose + 1];
  }
  return {
    places: poseTexture(places, 2, Uint32Array, RGIntegerFormat, UnsignedIntType, 'RG32UI'),
    looks: poseTexture(looks, 4, Uint8Array, RGBAIntegerFormat, UnsignedByteType, 'RGBA8UI'),
  };
}
