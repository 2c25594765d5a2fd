// Measuring a distance: two clicks on the world.
import { createLines, discard } from './lines.js';
import { byId } from './dom.js';
import { rounded } from './numbers.js';

/** Returns the texts of the distance between two places: in 3D, seen from above, and in height. */
export function distanceText(from, to) {
  const [dx, dy, dz] = to.map((value, axis) => value - from[axis]);
  return (
    `${rounded(Math.hypot(dx, dy, dz))} m\nseen from above ${rounded(Math.hypot(dx, dy))} m, ` +
    `height ${dz >= 0 ? '+' : '−'}${rounded(Math.abs(dz))} m`
  );
}

/** Returns {active, toggle(on), click(place), update()}. Places are in the scene. `changed(active)` is called. */
export function createMeasure(view, origin, changed) {
  const label = byId('measure-label');
  let active = false;
  let places = [];
  let line = null;

  function redraw() {
    discard(line);
    line = null;
    if (places.length === 2) {
      line = createLines([{ places, color: '#d81b60' }], origin, { width: 3, onTop: true });
      view.scene.add(line);
    }
    label.hidden = places.length === 0;
    label.textContent =
      places.length === 2 ? distanceText(...places) : places.length === 1 ? 'Click the second place' : '';
    view.requestRender();
  }

  const measure = {
    get active() {
      return active;
    },
    toggle(on = !active) {
      active = on;
      places = [];
      redraw();
      changed(active);
    },
    click(place) {
      places = places.length === 2 ? [place] : [...places, place];
      redraw();
    },
    /** Puts the label at its place on the screen; called after each picture. */
    update() {
      label.hidden = places.length === 0;
      if (label.hidden) return;
      const middle = places[0].map((value, axis) => (value + (places[1] ?? places[0])[axis]) / 2 - origin[axis]);
      const { x, y, visible } = view.project(middle);
      label.hidden = !visible;
      label.style.left = `${x}px`;
      label.style.top = `${y}px`;
    },
  };
  return measure;
}
