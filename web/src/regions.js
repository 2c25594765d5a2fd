// Regions that somebody draws on the map, as GeoJSON.
import { createLines, discard } from './lines.js';

const COLOR = '#d81b60';
const KEEP_OUT_COLOR = '#111111';

/** Returns polygons (arrays of [x, y, z]) as the text of a GeoJSON geometry in the scene's x and y; "" without any. */
export function regionsText(polygons) {
  const rings = polygons.map((places) => [[...places, places[0]].map(([x, y]) => [x, y])]);
  if (rings.length === 0) return '';
  return JSON.stringify(
    rings.length === 1 ? { type: 'Polygon', coordinates: rings[0] } : { type: 'MultiPolygon', coordinates: rings },
  );
}

/** Returns the polygons of a text of regionsText(), at a height; null if the text is something else. */
export function regionsFromText(text, z) {
  if (!text) return [];
  try {
    const { type, coordinates } = JSON.parse(text);
    if (type !== 'Polygon' && type !== 'MultiPolygon') return null;
    const rings = type === 'Polygon' ? [coordinates] : coordinates;
    if (rings.some((polygon) => polygon.length !== 1)) return null; // holes
    return rings.map(([ring]) => ring.slice(0, -1).map(([x, y]) => [x, y, z]));
  } catch {
    return null;
  }
}

/**
 * Returns {active, begin(done), click(place), finish(), cancel(), show(option, polygons)}: each option has polygons of
 * its own. Places are in the scene.
 */
export function createRegions(view, origin, changed) {
  let corners = null;
  let whenDone = null;
  const shown = new Map(); // option: polygons
  let drawn = null;

  function redraw() {
    discard(drawn);
    const lines = [...shown].flatMap(([option, polygons]) =>
      polygons.map((places) => ({ places, color: option === '--keep-out' ? KEEP_OUT_COLOR : COLOR, closed: true })),
    );
    if (corners?.length > 1) lines.push({ places: corners, color: COLOR });
    // A single corner is shown as a short line.
    if (corners?.length === 1)
      lines.push({ places: [corners[0], corners[0].map((value) => value + 0.05)], color: COLOR });
    drawn = createLines(lines, origin, { width: 3, onTop: true });
    view.scene.add(drawn);
    view.requestRender();
  }

  function end(places) {
    const done = whenDone;
    corners = whenDone = null;
    redraw();
    changed(false);
    if (places) done(places);
  }

  return {
    get active() {
      return corners !== null;
    },
    begin(done) {
      corners = [];
      whenDone = done;
      changed(true);
    },
    click(place) {
      const last = corners.at(-1);
      // The second half of a double click is no corner.
      if (last && Math.hypot(place[0] - last[0], place[1] - last[1]) < 1e-6) return;
      corners.push(place);
      redraw();
    },
    finish() {
      if (corners) end(corners.length >= 3 ? corners : null);
    },
    cancel() {
      if (corners) end(null);
    },
    show(option, polygons) {
      shown.set(option, polygons);
      redraw();
    },
  };
}
