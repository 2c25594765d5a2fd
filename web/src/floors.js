// Floors: the height at which the world is cut, one button for each floor, and islands to fly to.
import { element } from './dom.js';
import { rounded } from './numbers.js';

/**
 * Returns the height at which the world is cut to show a floor: a robot's height above its ground, but below the next
 * floor. The limits of the lowest and the highest floor are null.
 */
export function cutAbove(floors, index, robotHeight) {
  const cut = floors[index].height + Math.max(1.3 * robotHeight, 0.5);
  const next = floors[index + 1];
  return next ? Math.min(cut, Math.max((floors[index].height + next.height) / 2, next.height - 0.3)) : cut;
}

/**
 * Returns {node, cutAt(z), showFloor(index), setIslands(islands)}. `heights` is [lowest, highest] of the
 * world in the scene, `robotHeight()` that of the robot now. `actions`: setCut(z or null), flyToFloor(index), flyToIsland(index).
 */
export function createFloors({ floors, islands, heights, robotHeight, actions }) {
  const [low, high] = heights;
  const step = 10 ** Math.floor(Math.log10(Math.max(high - low, 0.01) / 200));
  const slider = element('input', { type: 'range', id: 'cut', min: low, max: high + step, step, value: high + step });
  const value = element('output');
  const everything = floorButton('All', () => showFloor(-1));
  const buttons = floors.map(({ name }, index) => floorButton(name, () => showFloor(index)));

  function floorButton(text, press) {
    return element('button', { type: 'button', text, 'aria-pressed': 'false', on: { click: press } });
  }

  function cutAt(z) {
    const whole = z === null || z >= high;
    slider.value = whole ? high + step : z;
    value.textContent = whole ? 'off' : `${rounded(z, 2)} m`;
    slider.setAttribute('aria-valuetext', value.textContent);
    actions.setCut(whole ? null : z);
  }

  function press(index) {
    [everything, ...buttons].forEach((button, at) => button.setAttribute('aria-pressed', String(at === index + 1)));
  }

  function showFloor(index) {
    if (index >= floors.length) return;
    press(index);
    cutAt(index < 0 ? null : cutAbove(floors, index, robotHeight()));
    if (index >= 0) actions.flyToFloor(index);
  }

  slider.addEventListener('input', () => {
    press(-2);
    cutAt(Number(slider.value));
  });
  press(-1);
  value.textContent = 'off';

  const island = element('select', { id: 'island', 'aria-label': 'Fly to an island' });
  const islandRow = element('div', { class: 'row' }, island);
  function setIslands(next) {
    island.replaceChildren(
      element('option', { value: '', text: 'Fly to an island …' }),
      ...next.map(({ number, area }, index) =>
        element('option', { value: index, text: `Island ${number}: ${rounded(area, 1)} m²` }),
      ),
    );
    islandRow.hidden = next.length === 0;
  }
  setIslands(islands);
  island.addEventListener('change', () => {
    if (island.value !== '') actions.flyToIsland(Number(island.value));
  });

  const node = element(
    'section',
    { class: 'block' },
    element('h2', { text: 'Floors' }),
    floors.length > 0 &&
      element('div', { class: 'row', role: 'group', 'aria-label': 'Floors' }, everything, ...buttons),
    element('label', { class: 'control' }, element('span', {}, 'Cut the world at a height', value), slider),
    islandRow,
  );
  return { node, cutAt, showFloor, setIslands };
}
