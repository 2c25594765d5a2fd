// Regions that somebody draws on the map, as GeoJSON.
import { createLines, discard } from './lines.js';

const COLOR = '#d81b60';

/** Returns polygons (arrays of [x, y, z]) as the text of a GeoJSON geometry in the scene's x and y; "" without any. */
export function regionsText(polygons) {
  const rings = polygons.map((places) => [[...places, places[0]].map(([x, y]) => [x, y])]);
  if (rings.length === 0) return '';
  return JSON.stringify(
    rings.length === 1 ? { type: 'Polygon', coordinates: rings[0] } : { type: 'MultiPolygon', coordinates: rings },
  );
}

/** Returns the polygons of a text of regionsText(), at a height. */
export function regionsFromText(text, z) {
  if (!text) return [];
  const { type, coordinates } = JSON.parse(text);
  return (type === 'Polygon' ? [coordinates] : coordinates).map(([ring]) =>
    ring.slice(0, -1).map(([x, y]) => [x, y, z]),
  );
}

/** Returns {active, begin(done), click(place), finish(), cancel(), show(polygons)}. Places are in the scene. */
export function createRegions(view, origin, changed) {
  let corners = null;
  let whenDone = null;
  let polygons = [];
  let drawn = null;

  function redraw() {
    discard(drawn);
    const lines = polygons.map((places) => ({ places, color: COLOR, closed: true }));
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
    show(next) {
      polygons = next;
      redraw();
    },
  };
}
