// What tests and the browser's console use: window.spawnfield. web/README.md describes it.
import { answerRow, layerAnswer } from './answers.js';
import { marksCsv } from './marks.js';
import { placeAt } from './map_objects.js';
import { pick, selectSpawn } from './review.js';

/** Returns the functions of window.spawnfield. `times` has decodeMilliseconds and loadMilliseconds. */
export function testInterface(page, times) {
  const { map } = page;
  const { view, cameraViews } = map;

  function turn(pictures) {
    const began = performance.now();
    for (let picture = 0; picture < pictures; ++picture) {
      cameraViews.turn(0.02, 0);
      view.renderNow();
      pixel(view, 0, 0);
    }
    return (performance.now() - began) / pictures;
  }

  return {
    pickingReady: map.picking.ready,
    pick: (x, y) => pick(page, x, y),
    placeAt: (x, y) => placeAt(map, x, y),
    answerAt: (layer, pose) => layerAnswer(page.json, page.layers[layer], pose),
    select: (list, index) => selectSpawn(page, list, index),
    project: (place) => view.project(map.local(place)),
    answer: () => page.answer,
    answerCsv: () => answerRow(page.answer),
    marksCsv: () => marksCsv(page.marks.marks),
    cut: page.floors.cutAt,
    top: cameraViews.top,
    isFlying: cameraViews.isFlying,
    target: () => map.inScene(view.controls.target.toArray()),
    turn,
    statistics() {
      const frameMilliseconds = turn(5);
      const { calls, triangles } = view.renderer.info.render;
      return { drawCalls: calls, triangles, bytesUploaded: view.uploads.bytes, ...times, frameMilliseconds };
    },
    pixelAt(x, y) {
      view.renderNow();
      return pixel(view, x, view.canvas.clientHeight - y);
    },
    runs: () => page.live?.runs ?? [],
  };
}

/** Returns [red, green, blue] of a CSS pixel, counted from the lower left; waits until the picture is drawn. */
export function pixel(view, x, y) {
  const gl = view.renderer.getContext();
  const ratio = view.renderer.getPixelRatio();
  const color = new Uint8Array(4);
  gl.readPixels(Math.round(x * ratio), Math.round(y * ratio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, color);
  return [...color.subarray(0, 3)];
}
