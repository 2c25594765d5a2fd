// The panel that answers why: verdict, reason, what was hit, and the numbers of the pose.
import { copyButton, element } from './dom.js';
import { answerRow, CSV_COLUMNS, withoutVerdict } from './answers.js';
import { withUnit } from './numbers.js';
import { TERMS } from './terms.js';

/**
 * Returns {node, show(answer), showProgram(answer of the program), clear(message)}. `actions`: swatch(verdict),
 * showPart(part), fly(answer), markOf(answer), mark(answer, "good", "bad" or null, note), close().
 */
export function createAnswerPanel(actions) {
  const node = element('section', { id: 'answer', class: 'block', 'aria-live': 'polite', 'aria-label': 'Answer' });
  const program = element('div', { id: 'program-answer' });

  function clear(message) {
    node.replaceChildren(
      element('h2', { text: 'Answer' }),
      element('p', { class: 'empty', text: message ?? 'Click a place on the map, or a spawn in the list below.' }),
    );
  }

  function show(answer) {
    const note = element('input', { type: 'text', placeholder: 'Note', 'aria-label': 'Note for the mark', id: 'note' });
    const markButtons = [
      ['Good', 'good'],
      ['Bad', 'bad'],
    ].map(([text, kind]) =>
      element('button', {
        type: 'button',
        text,
        title: `Mark this pose as ${kind}; once more takes the mark away`,
        'data-mark': kind,
        on: {
          click: () => {
            const isMarked = actions.markOf(answer)?.mark === kind;
            actions.mark(answer, isMarked ? null : kind, note.value);
            showMark();
          },
        },
      }),
    );
    const showMark = () => {
      const marked = actions.markOf(answer);
      for (const button of markButtons)
        button.setAttribute('aria-pressed', String(button.dataset.mark === marked?.mark));
      note.value = marked?.note ?? '';
    };
    note.addEventListener('change', () => {
      const marked = actions.markOf(answer);
      if (marked) actions.mark(answer, marked.mark, note.value);
    });
    showMark();
    program.replaceChildren();
    const { hit, name, kind } = answer;
    const reason = withoutVerdict(answer.reason, answer.verdictName);
    node.replaceChildren(
      ...[
        element(
          'p',
          { class: 'verdict' },
          actions.swatch(answer.verdict),
          element(
            'span',
            {},
            element('span', { id: 'answer-verdict', text: answer.verdictName.replace(/_/g, ' ') }),
            answer.words && `: ${answer.words}`,
          ),
        ),
        kind === 'spawn' && element('p', { class: 'where quiet', text: `${name}, ${answer.source}` }),
        answer.remark && element('p', { class: 'quiet', id: 'answer-remark', text: answer.remark }),
        reason && element('p', { class: 'reason', id: 'answer-reason', text: reason }),
        hit &&
          element(
            'div',
            { class: 'hit', id: 'answer-hit' },
            element(
              'span',
              {},
              'Hits ',
              element('strong', { text: hit.name }),
              hit.part === null ? '' : ` (${hit.label})`,
            ),
            hit.part !== null &&
              element('button', {
                type: 'button',
                text: 'Show this part',
                on: {
                  click: () => actions.showPart(hit.part),
                },
              }),
          ),
        facts(answer),
        element(
          'div',
          { class: 'row' },
          element('button', {
            type: 'button',
            text: 'Fly here',
            on: {
              click: () => actions.fly(answer),
            },
          }),
          copyRowButton(answer),
          element('button', { type: 'button', text: 'Close', on: { click: actions.close } }),
        ),
        element('div', { class: 'note' }, note, ...markButtons),
        details(answer),
        program,
      ].filter(Boolean),
    );
    node.querySelector('.row').style.marginTop = '10px';
    node.scrollIntoView?.({ block: 'nearest' });
  }

  clear();
  return {
    node,
    show,
    clear,
    showProgram(answer) {
      program.replaceChildren(
        element('h3', { text: 'The program says' }),
        element('p', {
          text: answer.reason || String(answer.verdict ?? '').replace(/_/g, ' '),
        }),
        element(
          'details',
          {},
          element('summary', { text: 'All of its answer' }),
          element('pre', { text: JSON.stringify(answer, null, 1) }),
        ),
      );
    },
    showProgramError(message) {
      program.replaceChildren(element('p', { class: 'error', role: 'alert', text: message }));
    },
  };
}

function copyRowButton(answer) {
  const button = copyButton('Copy as CSV row', () => answerRow(answer));
  button.title = `Columns: ${CSV_COLUMNS.join(',')}`;
  button.id = 'copy-row';
  return button;
}

function facts({ pose, ground, quantities, island, islandKnown, kind, contacts }) {
  const lines = [];
  if (kind === 'layer') lines.push(['Ground', withUnit(ground, 'm')]);
  for (const { name, unit, value } of quantities)
    if (value !== null) lines.push([`${name[0].toUpperCase()}${name.slice(1)}`, withUnit(value, unit)]);
  if (contacts.length > 0) lines.push(['Contacts', contacts.length]);
  if (islandKnown) lines.push(['Island', island ?? 'none']);
  lines.push([
    'Position',
    pose
      .slice(0, 3)
      .map((value) => withUnit(value, ''))
      .join(', ') + ' m',
  ]);
  lines.push(['Heading', withUnit(pose[5], 'rad')]);
  return element(
    'dl',
    { class: 'facts' },
    ...lines.flatMap(([name, value]) => [
      element('dt', { text: name, title: TERMS[name] ?? '' }),
      element('dd', { text: value }),
    ]),
  );
}

function details({ pose, source, fields }) {
  const names = ['x', 'y', 'z', 'roll', 'pitch', 'yaw'];
  const lines = pose.map((value, at) => [names[at], `${value}${at < 3 ? ' m' : ' rad'}`]);
  const table = (rows) =>
    element(
      'dl',
      { class: 'facts' },
      ...rows.flatMap(([name, value]) => [element('dt', { text: name }), element('dd', { text: value })]),
    );
  return element(
    'details',
    {},
    element('summary', { text: 'All numbers' }),
    table(lines),
    fields && element('h3', { text: `Fields of ${source}` }),
    fields && table(fields),
    !fields && element('p', { class: 'quiet', text: source }),
  );
}
