// Robots in their own shape, coloured by verdict, and markers of constant size on the screen above them.
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Euler,
  GLSL3,
  InstancedBufferAttribute,
  InstancedMesh,
  Matrix4,
  Points,
  Quaternion,
  ShaderMaterial,
  Vector3,
} from 'three';
import { inkGlsl, shadeGlsl } from './shaders.js';

const robotVertex = /* glsl */ `
  in float verdict;
  uniform vec3 center;
  uniform vec2 viewport;  // size of the picture in pixels
  uniform float pixelRatio;
  out vec3 place;
  flat out int kind;
  void main() {
    place = (modelMatrix * instanceMatrix * vec4(position, 1.0)).xyz;
    kind = int(verdict + 0.5);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
    #ifdef OUTLINE
      // Corners move outwards on the screen, so that a dark rim of constant width is seen around the robot.
      vec4 middle = projectionMatrix * viewMatrix * modelMatrix * instanceMatrix * vec4(center, 1.0);
      vec2 away = (gl_Position.xy / gl_Position.w - middle.xy / middle.w) * viewport;
      gl_Position.xy += normalize(away + 1e-6) * 3.0 * pixelRatio / viewport * gl_Position.w;
    #endif
  }
`;

const robotFragment = /* glsl */ `
  in vec3 place;
  flat in int kind;
  out vec4 color;
  uniform vec4 palette[32];
  uniform float cut;
  ${shadeGlsl}
  ${inkGlsl}
  void main() {
    if (place.z > cut) discard;
    #ifdef OUTLINE
      color = vec4(0.07, 0.07, 0.07, 1.0);
      return;
    #endif
    color = vec4(inked(palette[kind].rgb, kind) * (1.6 * shade(place, cameraPosition - place) - 0.45), 1.0);
  }
`;

const markerVertex = /* glsl */ `
  in vec2 look;    // verdict, shape: 0 disc, 1 disc with a cross, 2 diamond with +, 3 diamond with -, 4 ring
  in float poseHeight;  // the marker disappears with it where the world is cut
  uniform float pixelRatio, cut;
  flat out int verdict;
  flat out int shape;
  void main() {
    verdict = int(look.x + 0.5);
    shape = int(look.y + 0.5);
    gl_PointSize = (shape == 4 ? 34.0 : shape == 0 ? 12.0 : 17.0) * pixelRatio;
    gl_Position = poseHeight > cut ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * viewMatrix * vec4(position, 1.0);
  }
`;

const markerFragment = /* glsl */ `
  flat in int verdict;
  flat in int shape;
  out vec4 color;
  uniform vec4 palette[32];
  void main() {
    vec2 at = 2.0 * gl_PointCoord - 1.0;
    float distance = shape == 2 || shape == 3 ? abs(at.x) + abs(at.y) : length(at);
    if (distance > 1.0) discard;
    if (shape == 4) {
      if (distance < 0.72) discard;
      color = vec4(distance < 0.79 || distance > 0.93 ? vec3(1.0) : vec3(0.05), 1.0);
      return;
    }
    vec3 base = shape == 2 ? vec3(0.0, 0.45, 0.7) : shape == 3 ? vec3(0.84, 0.37, 0.0) : palette[verdict].rgb;
    float cross_ = min(abs(at.x - at.y), abs(at.x + at.y));
    float light = step(0.5, dot(base, vec3(0.299, 0.587, 0.114)));
    vec3 ink = vec3(1.0 - light);
    if (distance > 0.86) base = vec3(1.0);
    else if (distance > 0.66) base = vec3(0.05);
    else if (shape == 1 && cross_ < 0.22) base = ink;
    else if (shape == 2 && min(abs(at.x), abs(at.y)) < 0.12 && max(abs(at.x), abs(at.y)) < 0.5) base = vec3(1.0);
    else if (shape == 3 && abs(at.y) < 0.12 && abs(at.x) < 0.5) base = vec3(1.0);
    color = vec4(base, 1.0);
  }
`;

export const MARKER = { disc: 0, crossed: 1, good: 2, bad: 3, ring: 4 };

/** Returns the matrix of a pose [x, y, z, roll, pitch, yaw], relative to the origin (URDF's rpy). */
export function poseMatrix([x, y, z, roll, pitch, yaw], origin) {
  const place = new Vector3(x - origin[0], y - origin[1], z - origin[2]);
  const turn = new Quaternion().setFromEuler(new Euler(roll, pitch, yaw, 'ZYX'));
  return new Matrix4().compose(place, turn, new Vector3(1, 1, 1));
}

/** Returns the geometry of a pack's robot. */
export function robotGeometry(pack) {
  const { robot } = pack.json;
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(pack.array(robot.positions), 3));
  geometry.setIndex(new BufferAttribute(pack.array(robot.indices), 1));
  geometry.computeBoundingSphere();
  geometry.computeBoundingBox();
  return geometry;
}

/** Returns one object for many robots, an array of {pose, verdict}. Two draw calls: shapes and their rims. */
export function createRobots(geometry, robots, shared, origin) {
  const own = new BufferGeometry();
  // Copies, because three.js frees an attribute with the first geometry that has it.
  own.setAttribute('position', geometry.attributes.position.clone());
  own.setIndex(geometry.index.clone());
  own.setAttribute(
    'verdict',
    new InstancedBufferAttribute(
      Float32Array.from(robots, (robot) => robot.verdict),
      1,
    ),
  );
  const uniforms = { ...shared, center: { value: geometry.boundingBox.getCenter(new Vector3()) } };
  const material = (settings) =>
    new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: robotVertex,
      fragmentShader: robotFragment,
      uniforms,
      ...settings,
    });
  const object = new InstancedMesh(own, material({ side: DoubleSide }), Math.max(robots.length, 1));
  object.count = robots.length;
  robots.forEach(({ pose }, at) => object.setMatrixAt(at, poseMatrix(pose, origin)));
  const rim = new InstancedMesh(own, material({ side: BackSide, defines: { OUTLINE: 1 } }), 1);
  rim.instanceMatrix = object.instanceMatrix;
  rim.count = robots.length;
  object.add(rim);
  for (const drawn of [object, rim]) {
    drawn.frustumCulled = false;
    drawn.renderOrder = 3;
  }
  return object;
}

/**
 * Returns one object for many markers: `markers` is an array of {place, height, verdict, shape}. Places are in the scene;
 * `height` is that of the pose, with which the marker disappears where the world is cut.
 */
export function createMarkers(markers, shared, origin) {
  const geometry = new BufferGeometry();
  geometry.setAttribute(
    'position',
    new BufferAttribute(
      Float32Array.from(markers.flatMap(({ place }) => place.map((value, axis) => value - origin[axis]))),
      3,
    ),
  );
  geometry.setAttribute(
    'look',
    new BufferAttribute(Float32Array.from(markers.flatMap(({ verdict, shape }) => [verdict, shape])), 2),
  );
  geometry.setAttribute(
    'poseHeight',
    new BufferAttribute(
      Float32Array.from(markers, ({ height }) => height - origin[2]),
      1,
    ),
  );
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: markerVertex,
    fragmentShader: markerFragment,
    uniforms: shared,
    transparent: true,
  });
  const object = new Points(geometry, material);
  object.frustumCulled = false;
  object.renderOrder = 6;
  return object;
}
