// Mouse and touch on the map: clicks that are not drags, and the name of the part under the pointer.
import { byId, visibleText } from './dom.js';

const CLICK_PIXELS = 6;

/** Calls click(x, y), doubleClick() and hover(x, y), with CSS pixels of the canvas. */
export function listenToPointer(canvas, { click, doubleClick, hover }) {
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  let down = null;
  let asked = false;
  canvas.addEventListener('pointerdown', (event) => {
    down = event.isPrimary && event.button === 0 ? at(event) : null;
  });
  canvas.addEventListener('pointerup', (event) => {
    if (!down) return;
    const [x, y] = at(event);
    if (Math.hypot(x - down[0], y - down[1]) < CLICK_PIXELS) click(x, y);
    down = null;
  });
  canvas.addEventListener('dblclick', doubleClick);
  canvas.addEventListener('pointerleave', () => showUnderPointer(null));
  canvas.addEventListener('pointermove', (event) => {
    if (asked || event.pointerType === 'touch') return;
    if (event.buttons !== 0) {
      byId('tooltip').hidden = true;
      return;
    }
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      hover(...at(event));
    });
  });
}

/** Shows words about what is at a pixel, and its place; null for none. */
export function showUnderPointer(found, words, x, y) {
  const tooltip = byId('tooltip');
  byId('under-pointer').textContent = found ? found.place.map((value) => value.toFixed(2)).join(', ') : '';
  tooltip.hidden = !found || !words;
  if (tooltip.hidden) return;
  tooltip.textContent = visibleText(words);
  const map = byId('map');
  tooltip.style.left = `${Math.min(x + 14, map.clientWidth - tooltip.offsetWidth - 6)}px`;
  tooltip.style.top = `${Math.min(y + 16, map.clientHeight - tooltip.offsetHeight - 6)}px`;
}
