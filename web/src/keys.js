// Keys of the page. Keys of form fields and of open dialogs stay theirs.
import { byId } from './dom.js';

const STEP = 0.1; // share of the view
const TURN = 0.15; // rad

export function listenToKeys({ cameraViews, floors, toolbar, measure, fly, enter, escape, help }) {
  const turn = (around, up) => {
    cameraViews.turn(around, up);
    toolbar.turned();
  };
  const moves = {
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
    ArrowUp: [0, 1],
    ArrowDown: [0, -1],
    a: [-1, 0],
    d: [1, 0],
    w: [0, 1],
    s: [0, -1],
  };
  const others = {
    q: () => turn(TURN, 0),
    e: () => turn(-TURN, 0),
    '+': () => cameraViews.zoom(1.25),
    '=': () => cameraViews.zoom(1.25),
    '-': () => cameraViews.zoom(0.8),
    t: toolbar.top,
    i: toolbar.isometric,
    m: () => measure.toggle(),
    f: fly,
    '?': help,
    0: () => floors.showFloor(-1),
  };

  document.addEventListener('keydown', (event) => {
    const field = event.target.closest?.('input, select, textarea, dialog');
    const button = event.target.closest?.('button, summary, a');
    if (event.ctrlKey || event.altKey || event.metaKey || byId('help-dialog').open) return;
    if (event.key === 'Escape') {
      escape();
      return;
    }
    if (field && !(field.type === 'checkbox')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (key === 'Enter') {
      if (button || field) return;
      enter();
    } else if (moves[key]) {
      const [right, ahead] = moves[key];
      if (event.shiftKey) turn(-right * TURN, ahead * TURN);
      else cameraViews.pan(right * STEP, ahead * STEP);
    } else if (/^[1-9]$/.test(key)) {
      floors.showFloor(Number(key) - 1);
    } else if (others[key]) {
      others[key]();
    } else {
      return;
    }
    event.preventDefault();
  });
  const canvas = byId('canvas');
  const crosshair = () => {
    byId('crosshair').hidden = !canvas.matches(':focus-visible');
  };
  canvas.addEventListener('focus', crosshair);
  canvas.addEventListener('blur', crosshair);
}
