// The world: one mesh, and one draw call, for each label.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  GLSL3,
  Group,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  ShaderMaterial,
} from 'three';
import { shadeGlsl } from './shaders.js';

const LOOKS = {
  terrain: { low: '#8d8f88', high: '#efeee6', darkLow: '#3c3f40', darkHigh: '#a6a8a2', opacity: 1, order: 0 },
  obstacle: { low: '#a2907c', high: '#d2c0aa', darkLow: '#6d6154', darkHigh: '#9c8b77', opacity: 1, order: 0 },
  water: { low: '#2f7fc1', high: '#4a9bdd', darkLow: '#2a6fa8', darkHigh: '#3f8cc9', opacity: 0.45, order: 5 },
};

const vertexShader = /* glsl */ `
  out vec3 place;
  void main() {
    place = (modelMatrix * vec4(position, 1.0)).xyz;
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
  }
`;

const fragmentShader = /* glsl */ `
  in vec3 place;
  out vec4 color;
  uniform float cut, dark, opacity;
  uniform vec2 heights;
  uniform vec3 low, high, darkLow, darkHigh;
  ${shadeGlsl}
  void main() {
    if (place.z > cut) discard;
    float share = clamp((place.z - heights.x) / max(heights.y - heights.x, 1e-3), 0.0, 1.0);
    vec3 base = mix(mix(low, high, share), mix(darkLow, darkHigh, share), dark);
    color = vec4(base * shade(place, cameraPosition - place), opacity);
  }
`;

const highlightShader = /* glsl */ `
  in vec3 place;
  out vec4 color;
  uniform float cut;
  ${shadeGlsl}
  void main() {
    if (place.z > cut) discard;
    color = vec4(vec3(1.0, 0.84, 0.1) * shade(place, cameraPosition - place), 1.0);
  }
`;

const raw = (color) => new Color(color);

/**
 * Returns {group, meshes, highlight(part), partAt(mesh, triangle)} of a pack's world. Positions are relative to the
 * pack's origin. `heights` are the lowest and the highest place of the shading, relative to it, too.
 */
export function createWorld(pack, shared, heights) {
  const group = new Group();
  const meshes = pack.json.world.meshes.map((json) => {
    const mesh = labelMesh(pack, json, shared, heights);
    group.add(mesh);
    return mesh;
  });
  let marked = [];
  return {
    group,
    meshes,
    highlight(part) {
      marked.forEach((mesh) => {
        group.remove(mesh);
        mesh.material[0].dispose();
      });
      marked = part === null ? [] : meshes.flatMap((mesh) => highlightMesh(mesh, part, shared));
      if (marked.length > 0) group.add(...marked);
      return marked.length > 0;
    },
  };
}

function labelMesh(pack, json, shared, [low, high]) {
  const positions = pack.array(json.positions);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new InterleavedBufferAttribute(new InterleavedBuffer(positions, 4), 3, 0));
  geometry.setIndex(new BufferAttribute(pack.array(json.indices), 1));
  const look = LOOKS[json.label] ?? LOOKS.obstacle;
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader,
    fragmentShader,
    side: DoubleSide,
    transparent: look.opacity < 1,
    depthWrite: look.opacity === 1,
    uniforms: {
      cut: shared.cut,
      dark: shared.dark,
      opacity: { value: look.opacity },
      heights: { value: [low, high] },
      low: { value: raw(look.low) },
      high: { value: raw(look.high) },
      darkLow: { value: raw(look.darkLow) },
      darkHigh: { value: raw(look.darkHigh) },
    },
  });
  const mesh = new Mesh(geometry, material);
  mesh.position.fromArray(json.offset);
  mesh.scale.setScalar(json.scale);
  mesh.updateMatrixWorld();
  mesh.renderOrder = look.order;
  mesh.frustumCulled = false;
  mesh.userData = { label: json.label, parts: json.parts, triangles: json.indices.count / 3 };
  return mesh;
}

/** Returns the index of the part to which a triangle of a mesh belongs. */
export function partOf(mesh, triangle) {
  const { parts } = mesh.userData;
  let [low, high] = [0, parts.length];
  while (low + 1 < high) {
    const middle = (low + high) >>> 1;
    if (parts[middle][1] <= triangle) low = middle;
    else high = middle;
  }
  return parts[low]?.[0] ?? -1;
}

/** Returns the triangles of a part in a mesh, as [first, behind the last] for each run of them. */
export function partRuns(mesh, part) {
  const { parts, triangles } = mesh.userData;
  return parts.flatMap(([index, first], at) => (index === part ? [[first, parts[at + 1]?.[1] ?? triangles]] : []));
}

/** Returns {center, radius} of a part, relative to the pack's origin, or null if no mesh has it. */
export function partBounds(meshes, part) {
  const [least, most] = [
    [Infinity, Infinity, Infinity],
    [-Infinity, -Infinity, -Infinity],
  ];
  for (const mesh of meshes) {
    const { position } = mesh.geometry.attributes;
    const index = mesh.geometry.index.array;
    for (const [first, end] of partRuns(mesh, part)) {
      for (let at = 3 * first; at < 3 * end; ++at) {
        for (let axis = 0; axis < 3; ++axis) {
          const value = mesh.position.getComponent(axis) + mesh.scale.x * position.data.array[4 * index[at] + axis];
          least[axis] = Math.min(least[axis], value);
          most[axis] = Math.max(most[axis], value);
        }
      }
    }
  }
  if (least[0] > most[0]) return null;
  return {
    center: least.map((low, axis) => (low + most[axis]) / 2),
    radius: Math.hypot(...least.map((low, axis) => most[axis] - low)) / 2,
  };
}

function highlightMesh(mesh, part, shared) {
  const runs = partRuns(mesh, part);
  if (runs.length === 0) return [];
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', mesh.geometry.attributes.position);
  geometry.setIndex(mesh.geometry.index);
  runs.forEach(([first, end]) => geometry.addGroup(3 * first, 3 * (end - first), 0));
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader,
    fragmentShader: highlightShader,
    side: DoubleSide,
    uniforms: { cut: shared.cut },
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -2,
  });
  const marked = new Mesh(geometry, [material]);
  marked.position.copy(mesh.position);
  marked.scale.copy(mesh.scale);
  marked.renderOrder = 1;
  marked.frustumCulled = false;
  return [marked];
}
