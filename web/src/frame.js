// The frame around the map: toolbar, tabs, theme, and the panels that are a sheet on phones.
import { byId, element } from './dom.js';
import { fillHelp } from './help.js';

/** Returns the toolbar over the map. `actions`: top(), isometric(), measure(). */
export function createToolbar(actions) {
  const button = (text, title, press) =>
    element('button', { type: 'button', text, title, 'aria-pressed': 'false', on: { click: press } });
  const top = button('Top', 'Seen from above (T)', () => toolbar.top());
  const isometric = button('Isometric', 'Seen from the south-west (I)', () => toolbar.isometric());
  const measure = button('Measure', 'Distance between two places (M)', actions.measure);
  const dialog = byId('help-dialog');
  isometric.setAttribute('aria-pressed', 'true');
  byId('toolbar').append(
    element('div', { class: 'group', role: 'group', 'aria-label': 'View' }, top, isometric),
    measure,
  );
  byId('help').addEventListener('click', () => dialog.showModal());
  const press = (pressed) =>
    [top, isometric].forEach((other) => other.setAttribute('aria-pressed', String(other === pressed)));

  const toolbar = {
    top() {
      press(top);
      actions.top();
    },
    isometric() {
      press(isometric);
      actions.isometric();
    },
    /** The map was turned, so the view is none of these any more. */
    turned() {
      isometric.setAttribute('aria-pressed', 'false');
    },
    setMeasuring(on) {
      measure.setAttribute('aria-pressed', String(on));
    },
    openHelp: () => dialog.showModal(),
    fill: (json, licences) => fillHelp(dialog, json, licences),
  };
  return toolbar;
}

/** Returns {node, open(name)} of panels of which one is seen: `panels` is an array of [name, node]. */
export function createTabs(panels) {
  const buttons = panels.map(([name, node], at) => {
    node.id ||= `panel-${name.toLowerCase()}`;
    node.setAttribute('role', 'tabpanel');
    return element('button', {
      type: 'button',
      role: 'tab',
      id: `tab-${name.toLowerCase()}`,
      'aria-controls': node.id,
      text: name,
      on: { click: () => show(at), keydown: (event) => move(event, at) },
    });
  });
  function show(shown) {
    panels.forEach(([, node], at) => {
      node.hidden = at !== shown;
      buttons[at].setAttribute('aria-selected', String(at === shown));
      buttons[at].tabIndex = at === shown ? 0 : -1;
    });
  }
  function move(event, at) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.stopPropagation();
    const next = (at + step + panels.length) % panels.length;
    show(next);
    buttons[next].focus();
  }
  show(0);
  return {
    node: element(
      'div',
      { id: 'lists' },
      element('div', { id: 'tabs', role: 'tablist', 'aria-label': 'Lists' }, ...buttons),
      ...panels.map(([, node]) => node),
    ),
    open: (name) =>
      show(
        Math.max(
          panels.findIndex(([other]) => other === name),
          0,
        ),
      ),
  };
}

/**
 * Follows the system's choice of light and dark until the button is pressed. Each change calls `changed(dark, color)`,
 * with the colour behind the map.
 */
export function setUpTheme(changed) {
  const system = matchMedia('(prefers-color-scheme: dark)');
  let chosen = null;
  const apply = () => {
    const dark = chosen ?? system.matches;
    document.documentElement.dataset.theme = dark ? 'dark' : 'light';
    byId('theme').textContent = dark ? 'Light' : 'Dark';
    changed(dark, getComputedStyle(document.documentElement).getPropertyValue('--map').trim());
  };
  system.addEventListener('change', apply);
  byId('theme').addEventListener('click', () => {
    chosen = !(chosen ?? system.matches);
    apply();
  });
  apply();
}

/** Returns {open(panel)}: phones show one of the two panels below the map, or none. A second press closes it. */
export function setUpSheet(view) {
  const buttons = [...byId('sheet-tabs').querySelectorAll('button')];
  const open = (panel) => {
    for (const button of buttons) {
      button.setAttribute('aria-pressed', String(button.dataset.panel === panel));
      byId(button.dataset.panel).classList.toggle('open', button.dataset.panel === panel);
    }
    view.requestRender();
  };
  for (const button of buttons)
    button.addEventListener('click', () =>
      open(button.getAttribute('aria-pressed') === 'true' ? null : button.dataset.panel),
    );
  open('answers');
  return { open };
}
