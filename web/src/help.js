// The dialog with the keys, the verdicts, and what the page was made of.
import { copyButton, element } from './dom.js';
import { verdictSwatch } from './legend.js';
import { verdictPatterns } from './palette.js';
import { TERMS } from './terms.js';

const KEYS = [
  ['Arrows or W A S D', 'move the map'],
  ['Shift + arrows, Q E', 'turn the map'],
  ['+  −', 'nearer, farther'],
  ['1 … 9, 0', 'a floor, all floors'],
  ['T', 'top view'],
  ['I', 'isometric view'],
  ['F', 'fly to what is selected'],
  ['Enter', 'ask about the place in the middle of the map'],
  ['M', 'measure a distance'],
  ['Esc', 'end measuring or drawing, close the answer'],
  ['?', 'this list'],
];

/** Fills the dialog. `licences` is an array of [name, text]. */
export function fillHelp(dialog, json, licences) {
  const patterns = verdictPatterns(json.verdicts);
  const table = (rows) => element('table', {}, element('tbody', {}, ...rows));
  const close = element('button', {
    type: 'button',
    class: 'main',
    text: 'Close',
    on: { click: () => dialog.close() },
  });
  dialog.replaceChildren(
    element(
      'div',
      {},
      element('div', { class: 'head' }, element('h2', { id: 'help-title', text: 'Help' }), close),
      element('p', {
        text:
          'Click a place on the map: the page says whether the robot can stand there, and why not. Drag to turn, ' +
          'drag with the right button (or two fingers) to move, use the wheel (or pinch) to come nearer.',
      }),
      element('h3', { text: 'Keys' }),
      table(
        KEYS.map(([keys, does]) =>
          element('tr', {}, element('td', {}, element('kbd', { text: keys })), element('td', { text: does })),
        ),
      ),
      element('h3', { text: 'Verdicts' }),
      table(
        json.verdicts.map((verdict, index) =>
          element(
            'tr',
            {},
            element('td', {}, verdictSwatch(verdict, patterns[index]), ` ${verdict.name.replace(/_/g, ' ')}`),
            element('td', { text: verdict.words }),
          ),
        ),
      ),
      element('h3', { text: 'Numbers of the robot' }),
      table(
        Object.entries(TERMS).map(([name, means]) =>
          element('tr', {}, element('td', { text: name.replace(/_/g, ' ') }), element('td', { text: means })),
        ),
      ),
      element('h3', { text: 'This page' }),
      json.command ? element('pre', { text: json.command }) : null,
      json.command ? copyButton('Copy the command', () => json.command) : null,
      element('p', {
        class: 'quiet',
        text: [
          json.program,
          json.map?.name && `map ${json.map.name}`,
          json.map?.hash && `hash ${json.map.hash}`,
          json.map?.resolution && `resolution ${json.map.resolution} m`,
          json.robot?.name && `robot ${json.robot.name}`,
        ]
          .filter(Boolean)
          .join(', '),
      }),
      element(
        'details',
        {},
        element('summary', { text: 'Settings of the judge' }),
        element('pre', { text: JSON.stringify(json.settings ?? {}, null, 1) }),
      ),
      element(
        'details',
        {},
        element('summary', { text: 'Licences of the libraries in this page' }),
        ...licences.map(([name, text]) => element('div', {}, element('h3', { text: name }), element('pre', { text }))),
      ),
    ),
  );
}
