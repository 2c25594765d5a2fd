// All that is drawn on the map, with the names that the panels use: layers, spawns, marks, pairs, the selected answer.
import { partBounds, createWorld } from './world_mesh.js';
import { createVerdictLayer } from './verdict_layer.js';
import { createMarkers, createRobots, MARKER, robotGeometry } from './robot_shapes.js';
import { createLines, discard } from './lines.js';
import { createView } from './scene.js';
import { createCameraViews } from './camera_views.js';
import { createPicking } from './picking.js';
import { createSelection } from './selection.js';
import { sharedUniforms } from './shaders.js';

export const UNCUT = 1e30;
const MANY_THINGS = 600000; // triangles and poses
const MANY_IN_SOFTWARE = 50000;
const PAIR_COLOR = '#d81b60';

/**
 * Returns the map of a pack on a canvas. `scriptText` is that of the page, for the worker. `isSoftware`: the processor
 * draws.
 */
export function createMap(pack, canvas, scriptText, { isSoftware }) {
  const { json } = pack;
  const { origin } = json;
  const shared = sharedUniforms(json.verdicts);
  const bounds = worldBounds(json);
  const view = createView(canvas, bounds, shared, drawnThings(json) > (isSoftware ? MANY_IN_SOFTWARE : MANY_THINGS));
  const world = createWorld(pack, shared, [bounds.min[2], bounds.max[2]]);
  const verdictLayer = createVerdictLayer(shared, origin);
  view.scene.add(world.group, verdictLayer.object);
  view.beforeRender(() => verdictLayer.aim(view));
  const robot = robotGeometry(pack);
  const map = {
    json,
    origin,
    shared,
    view,
    world,
    verdictLayer,
    robot,
    heights: [bounds.min[2] + origin[2], bounds.max[2] + origin[2]],
    robotBounds: json.robot.bounds,
    robotRadius: radiusOf(robot),
    cameraViews: createCameraViews(view),
    picking: createPicking(world, json.robot.bounds, origin, scriptText),
    spawns: [], // {pose, verdict, list, index} of all lists
    marks: [],
    local: (place) => place.map((value, axis) => value - origin[axis]),
    inScene: (place) => place.map((value, axis) => value + origin[axis]),
    cut: () => shared.cut.value,
  };
  map.drawSelection = createSelection(view, () => map.robot, shared, origin);
  view.scene.add(pathLines(map));
  return map;
}

const radiusOf = (geometry) => Math.max(geometry.boundingSphere.radius, 0.1);

/** Calls a change of the map and draws it. */
export function changed(map, change) {
  change(map);
  map.view.requestRender();
}

// Relative to the origin. A map without bounds in some direction has those of its meshes.
function worldBounds({ map, world, origin }) {
  const bound = (side, pick, ofMesh) =>
    [0, 1, 2].map((axis) => {
      const value = map.bounds[side][axis];
      return Number.isFinite(value) ? value - origin[axis] : pick(...world.meshes.map((mesh) => ofMesh(mesh, axis)));
    });
  return {
    min: bound('min', Math.min, ({ offset }, axis) => offset[axis]),
    max: bound('max', Math.max, ({ offset, scale }, axis) => offset[axis] + 65535 * scale),
  };
}

function drawnThings({ world, layers }) {
  const triangles = world.meshes.reduce((sum, { indices }) => sum + indices.count / 3, 0);
  return triangles + (layers?.[0]?.count ?? 0);
}

const lift = ([x, y, z]) => [x, y, z + 0.05];

function pathLines({ json, origin }) {
  const color = (name) => json.verdicts.find((verdict) => verdict.name === name)?.color ?? '#808080';
  const lines = (json.pairs ?? []).flatMap(({ pairs }) =>
    pairs
      .filter(({ path }) => path?.length > 1)
      .map(({ path, verdict }) => ({ places: path.map(lift), color: color(verdict) })),
  );
  return createLines(lines, origin, { width: 3 });
}

/** Draws the robots of all lists of spawns, and their markers. */
export function drawSpawns(map, lists) {
  map.spawns = lists.flatMap((list, l) =>
    list.poses.map((pose, index) => ({ pose, verdict: list.verdicts[index], list: l, index })),
  );
  drawRobots(map);
  drawMarkers(map);
}

/** Changes the robot to that of another pack. */
export function changeRobot(map, pack) {
  map.robot = robotGeometry(pack);
  map.robotBounds = pack.json.robot.bounds;
  map.robotRadius = radiusOf(map.robot);
  map.picking.setRobot(map.robotBounds);
  drawRobots(map);
  drawMarkers(map);
}

function drawRobots(map) {
  discard(map.spawnRobots);
  map.spawnRobots = createRobots(map.robot, map.spawns, map.shared, map.origin);
  map.view.scene.add(map.spawnRobots);
  map.view.requestRender();
}

/** Draws the markers of spawns and of marks. */
export function drawMarkers(map) {
  discard(map.markers);
  const above = map.robotBounds.max[2] + 0.3 * map.robotRadius;
  const valid = map.json.verdicts.findIndex(({ name }) => name === 'valid');
  const over = ([x, y, z], heights) => [x, y, z + heights * above];
  const ofSpawns = map.spawns.map(({ pose, verdict }) => {
    return { place: over(pose, 1), height: pose[2], verdict, shape: verdict === valid ? MARKER.disc : MARKER.crossed };
  });
  const ofMarks = map.marks.map(({ pose, mark }) => {
    return { place: over(pose, 2), height: pose[2], verdict: 0, shape: mark === 'good' ? MARKER.good : MARKER.bad };
  });
  map.markers = createMarkers([...ofSpawns, ...ofMarks], map.shared, map.origin);
  map.view.scene.add(map.markers);
  map.view.requestRender();
}

/** Shows a pair with its path and its two robots, and flies to it; null takes the one before away. */
export function showPair(map, pair) {
  (map.pair ?? []).forEach(discard);
  map.pair = [];
  map.view.requestRender();
  if (!pair) return;
  const verdict = Math.max(
    0,
    map.json.verdicts.findIndex(({ name }) => name === pair.verdict),
  );
  const path = pair.path?.length > 1 ? pair.path : [pair.start.slice(0, 3), pair.goal.slice(0, 3)];
  const ends = [pair.start, pair.goal].map((pose) => ({ pose, verdict }));
  map.pair = [
    createLines([{ places: path.map(lift), color: PAIR_COLOR }], map.origin, { width: 5, onTop: true }),
    createRobots(map.robot, ends, map.shared, map.origin),
  ];
  map.view.scene.add(...map.pair);
  const low = [0, 1, 2].map((axis) => path.reduce((least, place) => Math.min(least, place[axis]), Infinity));
  const high = [0, 1, 2].map((axis) => path.reduce((most, place) => Math.max(most, place[axis]), -Infinity));
  const middle = low.map((value, axis) => (value + high[axis]) / 2);
  const size = Math.hypot(...high.map((value, axis) => value - low[axis]));
  map.cameraViews.flyTo(map.local(middle), Math.max(size * 0.6, map.robotRadius * 4));
}

/** Shows an answer, and the part that was hit unless it is ground; null takes the one before away. */
export function showAnswer(map, answer) {
  showPair(map, null);
  const part = answer?.hit?.part ?? null;
  map.world.highlight(part !== null && answer.hit.label !== 'terrain' ? part : null);
  map.drawSelection(answer, answer?.kind === 'layer');
}

/** Highlights a part and flies to it. Returns whether the world of the page has it. */
export function showPart(map, part) {
  map.world.highlight(part);
  map.view.requestRender();
  const bounds = partBounds(map.world.meshes, part);
  if (bounds) map.cameraViews.flyTo(bounds.center, Math.max(bounds.radius * 1.3, map.robotRadius * 3));
  return bounds !== null;
}

export function flyToPose(map, pose) {
  map.cameraViews.flyTo(map.local(pose.slice(0, 3)), map.robotRadius * 4);
}

/** Returns {place, part, label} of the world at a CSS pixel, with the place in the scene, or null. */
export function placeAt(map, x, y) {
  const found = map.picking.place(map.view.rayAt(x, y), map.cut());
  return found && { ...found, place: map.inScene(found.place) };
}

/** Returns the spawn at a CSS pixel if nothing of the world hides it, or null. */
export function spawnAt(map, x, y) {
  const ray = map.view.rayAt(x, y);
  const found = map.picking.robot(ray, map.spawns, map.cut());
  if (!found) return null;
  const place = map.picking.place(ray, map.cut());
  return !place || found.distance < place.distance + map.robotRadius ? map.spawns[found.index] : null;
}
