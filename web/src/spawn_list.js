// The lists of spawns and pairs: sorted, filtered, and flown to with a click.
import { element } from './dom.js';
import { spawnName, withoutVerdict } from './answers.js';
import { grouped, withUnit } from './numbers.js';

const SHOWN_AT_ONCE = 200;
const ORDERS = {
  verdict: 'not valid first',
  row: 'row',
  name: 'name',
  clearance: 'clearance',
  margin: 'margin',
  tilt: 'tilt',
};

/** Returns the indices of a list's poses in an order of ORDERS. Poses without a value come last. */
export function sortedPoses(list, order, isValid, reverse = false) {
  const number = (values) => (index) => values?.[index] ?? Infinity;
  const keys = {
    verdict: (index) => (isValid(list.verdicts[index]) ? 1000 : list.verdicts[index]),
    row: () => 0,
    name: (index) => spawnName(list, index),
    clearance: number(list.clearance),
    margin: number(list.margin),
    tilt: number(list.tilt),
  };
  const key = keys[order];
  const compare = (a, b) => (typeof a === 'string' ? a.localeCompare(b, 'en', { numeric: true }) : a === b ? 0 : a - b);
  const indices = list.poses.map((_, index) => index).sort((a, b) => compare(key(a), key(b)) || a - b);
  return reverse ? indices.reverse() : indices;
}

/**
 * Returns {node, show(lists), select(list, index)}. `actions`: swatch(verdict), pick(list, index). `verdicts` are those
 * of the pack.
 */
export function createSpawnList(verdicts, actions) {
  const isValid = (verdict) => verdicts[verdict]?.name === 'valid';
  let lists = [];
  let current = 0;
  let shown = SHOWN_AT_ONCE;
  let selected = -1;
  const file = element('select', { 'aria-label': 'File' });
  const order = element(
    'select',
    { id: 'spawn-order', 'aria-label': 'Sort by' },
    ...Object.entries(ORDERS).map(([value, text]) => element('option', { value, text: `Sort: ${text}` })),
  );
  const turn = element('button', {
    type: 'button',
    text: '↓',
    title: 'Turn the order around',
    'aria-pressed': 'false',
    'aria-label': 'Turn the order around',
  });
  const onlyRefused = element('input', { type: 'checkbox', id: 'only-refused' });
  const rows = element('ol', { class: 'list', id: 'spawn-rows' });
  const count = element('p', { class: 'quiet', id: 'spawn-count' });
  file.addEventListener('change', () => showFile(Number(file.value)));
  order.addEventListener('change', fill);
  onlyRefused.addEventListener('change', fill);
  turn.addEventListener('click', () => {
    turn.setAttribute('aria-pressed', String(turn.getAttribute('aria-pressed') !== 'true'));
    fill();
  });
  const controls = element(
    'div',
    { class: 'row' },
    file,
    order,
    turn,
    element('label', { class: 'check' }, onlyRefused, element('span', { text: 'only not valid' })),
  );
  const node = element('div', { class: 'block' }, count, controls, rows);

  function showFile(index) {
    current = index;
    shown = SHOWN_AT_ONCE;
    selected = -1;
    fill();
  }

  function fill() {
    const list = lists[current];
    controls.hidden = !list;
    rows.replaceChildren();
    if (!list) {
      count.textContent = 'This page has no list of spawns. Add one with: spawnfield review … --spawns FILE';
      return;
    }
    const refused = list.verdicts.filter((verdict) => !isValid(verdict)).length;
    count.textContent =
      refused === 0
        ? `All ${grouped(list.poses.length)} spawns are valid.`
        : `${grouped(refused)} of ${grouped(list.poses.length)} spawns ${refused === 1 ? 'is' : 'are'} not valid.`;
    const indices = sortedPoses(list, order.value, isValid, turn.getAttribute('aria-pressed') === 'true').filter(
      (index) => !onlyRefused.checked || !isValid(list.verdicts[index]),
    );
    rows.append(...indices.slice(0, shown).map((index) => spawnRow(list, index)));
    if (indices.length > shown)
      rows.append(
        element(
          'li',
          {},
          element(
            'button',
            {
              type: 'button',
              on: {
                click: () => {
                  shown += 5 * SHOWN_AT_ONCE;
                  fill();
                },
              },
            },
            '',
            `Show more (${grouped(indices.length - shown)})`,
          ),
        ),
      );
  }

  function spawnRow(list, index) {
    const verdict = verdicts[list.verdicts[index]];
    const reason = withoutVerdict(list.reasons?.[index] ?? '', verdict?.name ?? '');
    const why = reason || (isValid(list.verdicts[index]) ? '' : (verdict?.words ?? ''));
    const numbers = { clearance: [list.clearance, 'm'], margin: [list.margin, 'm'], tilt: [list.tilt, 'rad'] };
    const [values, unit] = numbers[order.value] ?? [];
    const side = values ? withUnit(values[index], unit) : (verdict?.name ?? '').replace(/_/g, ' ');
    return element(
      'li',
      {},
      element(
        'button',
        {
          type: 'button',
          'data-spawn': index,
          'aria-pressed': String(index === selected),
          on: { click: () => actions.pick(current, index) },
        },
        actions.swatch(list.verdicts[index]),
        element('span', { class: 'name', text: spawnName(list, index) }),
        element('span', { class: 'side', text: side }),
        why && element('span', { class: 'why', text: why, title: why }),
      ),
    );
  }

  return {
    node,
    refresh: fill,
    show(next, index = 0) {
      lists = next;
      file.replaceChildren(...lists.map((list, at) => element('option', { value: at, text: list.file })));
      file.hidden = lists.length < 2;
      file.value = String(index);
      showFile(index);
    },
    select(list, index) {
      if (list >= 0 && list !== current) {
        file.value = String(list);
        showFile(list);
      }
      selected = list === current ? index : -1;
      for (const button of rows.querySelectorAll('[data-spawn]')) {
        const pressed = Number(button.dataset.spawn) === selected;
        button.setAttribute('aria-pressed', String(pressed));
        if (pressed) button.scrollIntoView({ block: 'nearest' });
      }
    },
  };
}

/** Returns the list of pairs as an element. `actions`: pick(list, index), color(pair). */
export function pairList(lists, actions) {
  const node = element('div', { class: 'block' });
  lists.forEach((list, l) => {
    const refused = list.pairs.filter((pair) => pair.verdict !== 'valid').length;
    node.append(
      element('p', {
        class: 'quiet',
        text: `${list.file}: ${
          refused === 0
            ? `all ${list.pairs.length} pairs are valid`
            : `${refused} of ${list.pairs.length} pairs ${refused === 1 ? 'is' : 'are'} not valid`
        }.`,
      }),
    );
    const order = list.pairs
      .map((_, index) => index)
      .sort((a, b) => (list.pairs[a].verdict === 'valid') - (list.pairs[b].verdict === 'valid') || a - b);
    node.append(
      element(
        'ol',
        { class: 'list' },
        ...order.map((index) => {
          const pair = list.pairs[index];
          return element(
            'li',
            {},
            element(
              'button',
              { type: 'button', 'data-pair': index, on: { click: () => actions.pick(l, index) } },
              actions.swatch(pair),
              element('span', { class: 'name', text: pair.name || `pair ${index + 1}` }),
              element('span', { class: 'side', text: pair.verdict.replace(/_/g, ' ') }),
              pair.reason && element('span', { class: 'why', text: pair.reason, title: pair.reason }),
            ),
          );
        }),
      ),
    );
  });
  return node;
}
