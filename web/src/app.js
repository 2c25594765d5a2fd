// Start of the page: reads the data, shows the review, or says why it cannot be shown.
import { byId, element, visibleText } from './dom.js';
import { bytesFromBase64, PackError, readPack } from './pack.js';
import { createMap } from './map_objects.js';
import { createReview } from './review.js';
import { MOST_VERDICTS } from './shaders.js';
import { pixel, testInterface } from './test_interface.js';

/** Starts the page. `scriptText` is the text of its script, which the worker runs, too. */
export function startPage(scriptText) {
  const ready = hasSize()
    .then(paintedOnce)
    .then(() => openPage(scriptText));
  window.spawnfield = { ready };
  ready.catch(showFailure);
}

// In a frame that is not shown yet, the map has no size, which the camera needs.
function hasSize() {
  return new Promise((known) => {
    const observer = new ResizeObserver(([{ contentRect }]) => {
      if (contentRect.width === 0 || contentRect.height === 0) return;
      observer.disconnect();
      known();
    });
    observer.observe(byId('map'));
  });
}

// The browser shows "Loading" before the page starts to decode.
function paintedOnce() {
  return new Promise((painted) => requestAnimationFrame(() => setTimeout(painted)));
}

async function openPage(scriptText) {
  const pack = await readPack(packBytes());
  const { json } = pack;
  if (json.verdicts.length > MOST_VERDICTS)
    throw new PackError(`The data has ${json.verdicts.length} verdicts; the page shows at most ${MOST_VERDICTS}.`);
  const graphics = needWebGl2();
  const title = visibleText(json.title ?? 'spawnfield review');
  document.title = `${title} – spawnfield`;
  byId('title').textContent = title;

  const map = createMap(pack, byId('canvas'), scriptText, graphics);
  const page = createReview(pack, map);
  const decodeMilliseconds = performance.now();
  map.view.renderNow();
  pixel(map.view, 0, 0);
  byId('loading').remove();
  const loadMilliseconds = performance.now();
  Object.assign(window.spawnfield, testInterface(page, { decodeMilliseconds, loadMilliseconds }));
}

function packBytes() {
  const script = byId('spawnfield-data');
  if (!script)
    throw new PackError(
      'This page has no data. "spawnfield review MAP --robot R -o review.html" writes a page with data.',
    );
  const bytes = bytesFromBase64(script.textContent);
  script.remove();
  return bytes;
}

// Returns {isSoftware}: whether the processor draws, because the browser has no graphics hardware.
function needWebGl2() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl)
    throw new PackError(
      'This browser has no WebGL 2. Allow graphics (WebGL) in its settings, or open the page in a current Firefox or ' +
        'Chromium.',
    );
  // Firefox gives the name at once; other browsers have an extension for it.
  const generic = String(gl.getParameter(gl.RENDERER));
  const info = /^webkit/i.test(generic) ? gl.getExtension('WEBGL_debug_renderer_info') : null;
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : generic;
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return { isSoftware: /swiftshader|llvmpipe|software/i.test(name) };
}

function showFailure(error) {
  const text =
    error instanceof PackError
      ? error.message
      : `The page cannot be shown: ${error.message}. If the file was changed on its way, write it again with ` +
        '"spawnfield review".';
  const message = [element('h2', { text: 'This review cannot be shown' }), element('p', { text })];
  const failure = element('div', { class: 'failure', role: 'alert', id: 'failure' }, ...message);
  document.querySelector('main').replaceWith(failure);
  byId('sheet-tabs').hidden = document.querySelector('.tools').hidden = true;
  byId('hint').textContent = '';
}
