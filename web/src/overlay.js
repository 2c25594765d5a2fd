// What lies over the map: scale bar, axes with north, the place under the pointer.
import { Vector3 } from 'three';
import { byId, svg } from './dom.js';
import { niceBelow, rounded } from './numbers.js';

const LONGEST_BAR = 150; // CSS pixels
const AXES = [
  ['x', new Vector3(1, 0, 0), '#e0703a'],
  ['y', new Vector3(0, 1, 0), '#12a57a'],
  ['z', new Vector3(0, 0, 1), '#3391d6'],
];

export function createOverlay(view) {
  const bar = byId('scale-bar');
  const drawing = svg('svg', {
    viewBox: '-48 -48 96 96',
    width: '100%',
    height: '100%',
    role: 'img',
    'aria-label': 'Axes: x forward or east, y left or north, z up',
  });
  byId('gizmo').append(drawing);
  const axes = AXES.map(([name, direction, color]) => {
    const line = svg('line', { stroke: color, 'stroke-width': 3, 'stroke-linecap': 'round' });
    const label = svg('text', { fill: color, 'text-anchor': 'middle', 'dominant-baseline': 'middle' }, name);
    return { direction, line, label };
  });
  const northText = svg('text', { fill: 'currentColor', 'text-anchor': 'middle', 'dominant-baseline': 'middle' }, 'N');
  drawing.append(svg('circle', { r: 36, fill: 'none', stroke: 'currentColor', 'stroke-opacity': 0.25 }), northText);

  return function update() {
    const metres = niceBelow(LONGEST_BAR * view.metresPerPixel());
    bar.style.width = `${metres / view.metresPerPixel()}px`;
    const text =
      metres >= 1000
        ? `${rounded(metres / 1000)} km`
        : metres < 0.01
          ? `${rounded(metres * 1000)} mm`
          : metres < 1
            ? `${rounded(metres * 100)} cm`
            : `${rounded(metres)} m`;
    bar.firstElementChild.textContent = text;
    bar.setAttribute('aria-label', `Scale: this bar is ${text} long`);

    const turn = view.camera.quaternion.clone().invert();
    const ends = axes
      .map((axis) => ({ ...axis, end: axis.direction.clone().applyQuaternion(turn) }))
      .sort((a, b) => a.end.z - b.end.z);
    for (const { line, label, end } of ends) {
      line.setAttribute('x2', 20 * end.x);
      line.setAttribute('y2', -20 * end.y);
      label.setAttribute('x', 28 * end.x);
      label.setAttribute('y', -28 * end.y);
      label.setAttribute('visibility', Math.hypot(end.x, end.y) < 0.15 ? 'hidden' : 'visible');
      drawing.append(line, label);
    }
    const up = new Vector3(0, 1, 0).applyQuaternion(turn);
    const angle = (Math.atan2(up.x, up.y) * 180) / Math.PI;
    northText.setAttribute('x', 42 * Math.sin((angle * Math.PI) / 180));
    northText.setAttribute('y', -42 * Math.cos((angle * Math.PI) / 180));
  };
}
