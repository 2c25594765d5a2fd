// Colours of the layer: what it shows, the switches of the verdicts with their counts, patterns, the heading.
import { element } from './dom.js';
import { drawSwatch, ISLAND_COLORS, NO_ISLAND_COLOR, NO_VALUE_COLOR, safeColor, verdictPatterns, viridis } from './palette.js';
import { grouped, rounded, withUnit } from './numbers.js';
import { quantityRange } from './layer_data.js';

/** Returns a canvas with the colour of a verdict, and its pattern if patterns are on. */
export function verdictSwatch(verdict, pattern) {
  const canvas = element('canvas', { class: 'swatch', width: 26, height: 16, 'aria-hidden': 'true' });
  drawSwatch(canvas, safeColor(verdict.color), pattern);
  return canvas;
}

const plainSwatch = (color) => verdictSwatch({ color }, null);

/**
 * Returns {node, showLayer(layer, index), colorBy(how), swatch(verdict)} of the legend. `islands()` and `layers()` are
 * those of now. `colors`: what the layer shows at first, by name. `actions`: toggleVerdict(index, on), colorBy({mode, quantity, range}),
 * setPatterns(on), setLayer(index), setOpacity(share), show(label, on).
 */
export function createLegend({ verdicts, islands, labels, layers, heights, colors, actions }) {
  const patterns = verdictPatterns(verdicts);
  const hidden = new Set();
  let patternsOn = false;
  let layer = null;
  let way = colors;

  const choice = element('select', { 'aria-label': 'What the colours of the layer show', id: 'color-by' });
  const scale = element('div');
  const list = element('div', { id: 'legend', role: 'group', 'aria-label': 'Verdicts' });
  const about = element('p', { class: 'quiet', id: 'about-layer' });
  const heading = element(
    'label',
    { class: 'control' },
    element('span', {}, 'Heading', element('output')),
    element('input', { type: 'range', id: 'heading', min: 0, step: 1 }),
  );
  const headingSlider = heading.querySelector('input');
  headingSlider.addEventListener('input', () => actions.setLayer(Number(headingSlider.value)));
  choice.addEventListener('change', () => recolor(choice.value));

  function recolor(next) {
    way = next;
    scale.replaceChildren();
    const quantity = layer?.quantities[Number(next)];
    if (next === 'island') {
      scale.append(islandLegend(islands()));
      actions.colorBy({ mode: 'island' });
    } else if (next === 'height') {
      scale.append(...ramp(heights, 'm'));
      actions.colorBy({ mode: 'height', range: heights });
    } else if (quantity) {
      const range = quantityRange(quantity);
      if (range) scale.append(...ramp(range, quantity.unit), colorRow(NO_VALUE_COLOR, 'without a value'));
      else scale.append(element('p', { class: 'quiet', text: 'No pose of this layer has a value.' }));
      actions.colorBy({ mode: 'quantity', quantity, range: range ?? [0, 1] });
    } else {
      actions.colorBy({ mode: 'verdict' });
    }
  }

  function fillChoice() {
    const options = [
      ['verdict', 'Verdict'],
      ...(layer?.quantities ?? []).map((quantity, at) => [
        String(at),
        `${quantity.name[0].toUpperCase()}${quantity.name.slice(1)}`,
      ]),
      ['height', 'Height of the ground'],
    ];
    if (layer?.hasIslands) options.push(['island', 'Island']);
    const named = layer?.quantities.findIndex((quantity) => quantity.name === way) ?? -1;
    if (named >= 0) way = String(named);
    if (!options.some(([value]) => value === way)) way = 'verdict';
    choice.replaceChildren(...options.map(([value, text]) => element('option', { value, text })));
    choice.value = way;
  }

  function fillList() {
    list.replaceChildren(
      ...verdicts
        .map((verdict, index) => {
          const count = layer?.counts[index] ?? 0;
          if (count === 0) return null;
          const box = element('input', { type: 'checkbox', 'data-verdict': verdict.name });
          box.checked = !hidden.has(index);
          box.addEventListener('change', () => {
            if (box.checked) hidden.delete(index);
            else hidden.add(index);
            actions.toggleVerdict(index, box.checked);
          });
          return element(
            'label',
            { class: 'check', title: verdict.words },
            box,
            verdictSwatch(verdict, patternsOn ? patterns[index] : null),
            element('span', { class: 'words', text: verdict.name.replace(/_/g, ' ') }),
            element('span', { class: 'count', text: grouped(count) }),
          );
        })
        .filter(Boolean),
    );
    if (list.children.length === 0)
      list.append(element('p', { class: 'quiet', text: 'This page has no layer of verdicts.' }));
  }

  const patternBox = element('input', { type: 'checkbox', id: 'patterns' });
  patternBox.addEventListener('change', () => {
    patternsOn = patternBox.checked;
    actions.setPatterns(patternsOn);
    fillList();
  });
  const opacity = element('input', { type: 'range', id: 'opacity', min: 0.2, max: 1, step: 0.05, value: 0.75 });
  opacity.addEventListener('input', () => actions.setOpacity(Number(opacity.value)));
  const labelBoxes = labels.map((label) => {
    const box = element('input', { type: 'checkbox', 'data-label': label });
    box.checked = true;
    box.addEventListener('change', () => actions.show(label, box.checked));
    return element('label', { class: 'check' }, box, element('span', { class: 'words', text: label }));
  });

  const node = element(
    'div',
    {},
    element(
      'section',
      { class: 'block' },
      element('h2', { text: 'Where the robot can stand' }),
      about,
      list,
      element(
        'label',
        { class: 'check' },
        patternBox,
        element('span', { class: 'words', text: 'Patterns (for greyscale)' }),
      ),
      element('label', { class: 'control' }, element('span', { text: 'Colours show' }), choice),
      scale,
      heading,
    ),
    element(
      'section',
      { class: 'block' },
      element('h2', { text: 'World' }),
      ...labelBoxes,
      element('label', { class: 'control' }, element('span', { text: 'Strength of the colours' }), opacity),
    ),
  );

  return {
    node,
    hidden,
    showLayer(next, index) {
      layer = next;
      const degrees = next && `${rounded((next.yaw * 180) / Math.PI, 1)}°`;
      about.textContent = next
        ? `A colour is for the robot's origin at this place, at heading ${degrees}. Robots reach into other colours.`
        : '';
      heading.hidden = layers().length < 2;
      headingSlider.max = layers().length - 1;
      headingSlider.value = index;
      if (next) heading.querySelector('output').textContent = `${degrees} (${next.name})`;
      headingSlider.setAttribute('aria-valuetext', next?.name ?? '');
      fillChoice();
      fillList();
      recolor(way);
    },
    colorBy(next) {
      choice.value = next;
      recolor(next);
    },
    swatch: (index) => verdictSwatch(verdicts[index] ?? {}, patternsOn ? patterns[index] : null),
  };
}

function ramp([low, high], unit) {
  const stops = Array.from(
    { length: 11 },
    (_, at) =>
      `rgb(${viridis(at / 10)
        .map((value) => Math.round(255 * value))
        .join(' ')})`,
  );
  const bar = element('div', {
    class: 'ramp',
    role: 'img',
    'aria-label': `Scale from ${withUnit(low, unit)} to ${withUnit(high, unit)}`,
  });
  bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
  const ticks = [0, 0.5, 1].map((share) =>
    element('span', { text: withUnit(Number((low + share * (high - low)).toPrecision(3)), unit) }),
  );
  return [bar, element('div', { class: 'ticks' }, ...ticks)];
}

function islandLegend(islands) {
  const rows = islands
    .slice(0, 6)
    .map((island, at) => [ISLAND_COLORS[at], `island ${island.number}`, `${rounded(island.area, 1)} m²`]);
  if (islands.length > 6) rows.push([ISLAND_COLORS[6], 'other islands', `${islands.length - 6}`]);
  rows.push([NO_ISLAND_COLOR, 'on no island', '']);
  return element(
    'div',
    {},
    ...rows.map(([color, words, count]) => colorRow(color, words, count)),
  );
}

function colorRow(color, words, count = '') {
  return element(
    'div',
    { class: 'check' },
    plainSwatch(color),
    element('span', { class: 'words', text: words }),
    element('span', { class: 'count', text: count }),
  );
}
