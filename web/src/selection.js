// What the map shows of the selected answer: the robot at its pose, a ring, contacts and support polygon.
import { Vector3 } from 'three';
import { createLines, discard } from './lines.js';
import { createMarkers, createRobots, MARKER, poseMatrix } from './robot_shapes.js';

const SUPPORT_COLOR = '#d81b60';

/** Returns the convex hull of places, seen from above, counter-clockwise (Andrew's monotone chain). */
export function convexHull(places) {
  const sorted = [...places].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (points) => {
    const hull = [];
    for (const place of points) {
      while (hull.length > 1 && turn(hull.at(-2), hull.at(-1), place) <= 0) hull.pop();
      hull.push(place);
    }
    return hull.slice(0, -1);
  };
  return sorted.length < 3 ? sorted : [...half(sorted), ...half(sorted.reverse())];
}

/** Returns show(answer or null, withRobot), which replaces what was shown before. `robot()` is the geometry of now. */
export function createSelection(view, robot, shared, origin) {
  let objects = [];

  return function show(answer, withRobot) {
    objects.forEach(discard);
    objects = [];
    if (answer) {
      const place = [answer.pose[0], answer.pose[1], Math.max(answer.pose[2], answer.drawnHeight)];
      const ring = { place, height: place[2], verdict: answer.verdict, shape: MARKER.ring };
      objects.push(createMarkers([ring], shared, origin));
      objects[0].material.depthTest = false;
      if (withRobot) objects.push(createRobots(robot(), [answer], shared, origin));
      objects.push(outline(answer.pose));
      if (answer.contacts.length > 0) objects.push(contactLines(answer.contacts));
      view.scene.add(...objects);
    }
    view.requestRender();
  };

  // The robot's box, seen through all else, with an arrow to where it looks.
  function outline(pose) {
    const matrix = poseMatrix(pose, [0, 0, 0]);
    const { min, max } = robot().boundingBox;
    const at = (x, y, z) => new Vector3(x, y, z).applyMatrix4(matrix).toArray();
    const ring = (z) => [at(min.x, min.y, z), at(max.x, min.y, z), at(max.x, max.y, z), at(min.x, max.y, z)];
    const [low, high] = [ring(min.z), ring(max.z)];
    const [middle, tip] = [(min.y + max.y) / 2, max.x + 0.35 * (max.x - min.x)];
    const wing = 0.15 * (max.y - min.y);
    const back = tip - 0.12 * (max.x - min.x);
    const lines = [low, high].map((places) => ({ places, closed: true }));
    low.forEach((place, k) => lines.push({ places: [place, high[k]] }));
    lines.push({ places: [at((min.x + max.x) / 2, middle, max.z), at(tip, middle, max.z)] });
    lines.push({ places: [at(back, middle - wing, max.z), at(tip, middle, max.z), at(back, middle + wing, max.z)] });
    const color = '#111111';
    return createLines(
      lines.map((line) => ({ ...line, color })),
      origin,
      { width: 1.5, onTop: true },
    );
  }

  function contactLines(contacts) {
    const arm = Math.max(robot().boundingSphere.radius * 0.06, 0.01);
    const crosses = contacts.flatMap(([x, y, z]) => [
      {
        places: [
          [x - arm, y, z],
          [x + arm, y, z],
        ],
        color: SUPPORT_COLOR,
      },
      {
        places: [
          [x, y - arm, z],
          [x, y + arm, z],
        ],
        color: SUPPORT_COLOR,
      },
      {
        places: [
          [x, y, z - arm],
          [x, y, z + arm],
        ],
        color: SUPPORT_COLOR,
      },
    ]);
    const hull = { places: convexHull(contacts), color: SUPPORT_COLOR, closed: contacts.length > 2 };
    return createLines([hull, ...crosses], origin, { width: 3, onTop: true });
  }
}
