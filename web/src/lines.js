// Lines that are some pixels wide: paths, support polygons, measures, regions.
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { rgb } from './palette.js';

/**
 * Returns one object for many lines: `lines` is an array of {places, color, closed}, with places of the scene. With
 * `onTop`, nothing hides them.
 */
export function createLines(lines, origin, { width = 3, onTop = false } = {}) {
  const positions = [];
  const colors = [];
  const local = (place) => place.map((value, axis) => value - origin[axis]);
  for (const { places, color, closed } of lines) {
    const ends = closed ? [...places.slice(1), places[0]] : places.slice(1);
    ends.forEach((end, at) => {
      positions.push(...local(places[at]), ...local(end));
      colors.push(...rgb(color), ...rgb(color));
    });
  }
  const geometry = new LineSegmentsGeometry();
  if (positions.length > 0) {
    geometry.setPositions(positions);
    geometry.setColors(colors);
  }
  const material = new LineMaterial({ linewidth: width, vertexColors: true, depthTest: !onTop, transparent: onTop });
  material.toneMapped = false;
  const object = new LineSegments2(geometry, material);
  object.visible = positions.length > 0;
  object.frustumCulled = false;
  object.renderOrder = 7;
  return object;
}

/** Frees what an object of this module, of robot_shapes.js or of verdict_layer.js holds, and takes it out. */
export function discard(object) {
  if (!object) return;
  object.removeFromParent();
  object.geometry.dispose();
  object.traverse(({ material }) => material.dispose());
  object.dispose?.();
}
