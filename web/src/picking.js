// What is at a pixel: the place of the world and its part, or a robot.
import { Box3, Matrix4, Vector3 } from 'three';
import { firstHit, treesOf } from './bvh_worker.js';
import { partOf } from './world_mesh.js';
import { poseMatrix } from './robot_shapes.js';

/**
 * Returns {ready, isReady(), setRobot(bounds), place(ray, cut), robot(ray, robots, cut)}. Places are relative to the
 * origin. What is above `cut` is not seen by a ray, nor are meshes that are not visible.
 */
export function createPicking(world, robotBounds, origin, scriptText) {
  let trees = null;
  const ready = treesOf(world.meshes, scriptText).then((made) => {
    trees = made;
  });
  let box = boxOf(robotBounds);

  return {
    ready,
    isReady: () => trees !== null,
    setRobot(bounds) {
      box = boxOf(bounds);
    },
    /** Returns {place, part, label, distance} or null. Needs `ready`. */
    place(ray, cut) {
      if (!trees) return null;
      const [near, far] = visibleRange(ray, cut);
      let best = null;
      world.meshes.forEach((mesh, at) => {
        if (!mesh.visible) return;
        const hit = firstHit(mesh, trees[at], ray, near, best?.distance ?? far);
        if (hit) best = { ...hit, mesh };
      });
      if (!best) return null;
      return {
        place: ray.at(best.distance, new Vector3()).toArray(),
        distance: best.distance,
        part: partOf(best.mesh, best.triangle),
        label: best.mesh.userData.label,
      };
    },
    /** Returns {index, distance} of the first robot whose box the ray meets, or null. */
    robot(ray, robots, cut) {
      let best = null;
      robots.forEach(({ pose }, index) => {
        if (pose[2] - origin[2] > cut) return;
        const matrix = poseMatrix(pose, origin);
        const local = ray.clone().applyMatrix4(new Matrix4().copy(matrix).invert());
        const hit = local.intersectBox(box, new Vector3());
        if (!hit) return;
        const distance = hit.distanceTo(local.origin);
        if (!best || distance < best.distance) best = { index, distance };
      });
      return best;
    },
  };
}

const boxOf = ({ min, max }) => new Box3(new Vector3(...min), new Vector3(...max)).expandByScalar(0.02);

// The distances along a ray between which it is below the cut.
function visibleRange(ray, cut) {
  const above = ray.origin.z - cut;
  const down = -ray.direction.z;
  if (above <= 0) return [0, down < 0 ? above / down : Infinity];
  return down > 0 ? [above / down, Infinity] : [Infinity, Infinity];
}
