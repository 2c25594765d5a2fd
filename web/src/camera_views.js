// Views of the camera: presets, flights, and steps by keys.
import { Spherical, Vector3 } from 'three';

const ISOMETRIC = new Vector3(-1, -1, Math.SQRT2 * Math.tan(Math.PI / 5.1)).normalize();
const FLIGHT_MILLISECONDS = 450;
const FILLED = 0.93; // share of the view that the world fills
const HALF_FIELD = Math.tan((45 * Math.PI) / 360);

/** Returns the target and the position of a camera that sees all of the world's box as large as possible. */
function fitted(view, direction, firstDistance) {
  const camera = view.camera.clone();
  camera.updateProjectionMatrix(); // the size of the map may have changed after the last picture
  const target = view.center.clone();
  let distance = firstDistance;
  const { min, max } = view.box;
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(
    (corner) => new Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z),
  );
  for (let step = 0; step < 8; ++step) {
    camera.position.copy(target).addScaledVector(direction, distance);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    const seen = corners.map((corner) => corner.clone().project(camera));
    const [left, right] = [Math.min(...seen.map(({ x }) => x)), Math.max(...seen.map(({ x }) => x))];
    const [low, high] = [Math.min(...seen.map(({ y }) => y)), Math.max(...seen.map(({ y }) => y))];
    const side = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    target.addScaledVector(side, ((left + right) / 2) * distance * HALF_FIELD * camera.aspect);
    target.addScaledVector(up, ((low + high) / 2) * distance * HALF_FIELD);
    distance *= Math.min(Math.max(right - left, high - low) / 2 / FILLED, 1.5);
  }
  return { target, position: target.clone().addScaledVector(direction, distance) };
}

/** Returns the flights of a view. Places are relative to the origin. */
export function createCameraViews(view) {
  const { controls } = view;
  let flight = 0;
  let end = null; // of the flight of now

  function moveTo(target, position) {
    const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    const [fromTarget, fromPosition] = [controls.target.clone(), view.camera.position.clone()];
    const number = ++flight;
    end = { target: target.clone(), position: position.clone() };
    const began = performance.now();
    const step = (now) => {
      if (number !== flight) return;
      const share = still ? 1 : Math.min((now - began) / FLIGHT_MILLISECONDS, 1);
      const eased = share * share * (3 - 2 * share);
      controls.target.lerpVectors(fromTarget, target, eased);
      view.camera.position.lerpVectors(fromPosition, position, eased);
      controls.update();
      view.requestRender();
      if (share < 1) requestAnimationFrame(step);
      else end = null;
    };
    step(still ? began : performance.now());
  }

  function distanceFor(radius) {
    const aspect = view.canvas.clientWidth / Math.max(view.canvas.clientHeight, 1);
    return (radius / HALF_FIELD / Math.min(1, aspect)) * 1.05;
  }

  /** Flies to a place so that a sphere around it fills the view, from the direction of now or from `direction`. */
  function flyTo(place, radius, direction) {
    const target = new Vector3(...place);
    const from = direction ?? view.camera.position.clone().sub(controls.target).normalize();
    if (view.isTop) {
      flyTop(place, radius);
      return;
    }
    moveTo(target, target.clone().addScaledVector(from, distanceFor(Math.max(radius, 0.3))));
  }

  function flyTop(place, radius) {
    const aspect = view.canvas.clientWidth / Math.max(view.canvas.clientHeight, 1);
    view.setTop(true);
    view.setShownHeight((2.1 * Math.max(radius, 0.3)) / Math.min(1, aspect));
    const target = new Vector3(...place);
    // A camera exactly above its target would have no direction for "up", so it stands a little to the south.
    moveTo(target, target.clone().add(new Vector3(0, -1e-4, 1).multiplyScalar(view.radius * 3)));
  }

  return {
    flyTo,
    /** Ends a flight at its end at once. */
    finish() {
      if (!end) return;
      ++flight;
      view.controls.target.copy(end.target);
      view.camera.position.copy(end.position);
      view.controls.update();
      end = null;
    },
    isFlying: () => end !== null,
    /** Shows the whole world from above. */
    top() {
      const size = view.box.getSize(new Vector3());
      const aspect = view.canvas.clientWidth / Math.max(view.canvas.clientHeight, 1);
      flyTop(
        view.center.toArray(),
        0.52 * Math.max(size.y * Math.min(1, aspect), size.x * Math.min(1, 1 / aspect), 0.6),
      );
    },
    /** Shows the whole world from the south-west. */
    isometric() {
      view.setTop(false);
      const { target, position } = fitted(view, ISOMETRIC, distanceFor(view.radius));
      moveTo(target, position);
    },
    /** Moves the target by shares of the view: to the right and ahead. */
    pan(right, ahead) {
      const size = view.metresPerPixel() * view.canvas.clientHeight;
      const side = new Vector3().setFromMatrixColumn(view.camera.matrixWorld, 0);
      const front = new Vector3(0, 0, 1).cross(side).normalize();
      const move = side.multiplyScalar(right * size).addScaledVector(front, ahead * size);
      moveTo(controls.target.clone().add(move), view.camera.position.clone().add(move));
    },
    /** Turns the camera around its target by angles, rad. Without effect in the top view. */
    turn(around, up) {
      if (view.isTop) return;
      const offset = view.camera.position.clone().sub(controls.target);
      const round = new Spherical().setFromVector3(new Vector3(offset.x, offset.z, -offset.y));
      round.theta += around;
      round.phi = Math.min(Math.max(round.phi + up, 0.02), controls.maxPolarAngle);
      const turned = new Vector3().setFromSpherical(round);
      view.camera.position.copy(controls.target).add(new Vector3(turned.x, -turned.z, turned.y));
      controls.update();
      view.requestRender();
    },
    zoom(factor) {
      if (view.isTop) {
        view.camera.zoom *= factor;
        view.requestRender();
        return;
      }
      const offset = view.camera.position.clone().sub(controls.target).divideScalar(factor);
      moveTo(controls.target.clone(), controls.target.clone().add(offset));
    },
  };
}
