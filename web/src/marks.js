// Marks: poses that somebody called good or bad, with a note, saved as CSV for `check` and `sample --avoid`.
import { element, saveFile } from './dom.js';
import { csv } from './csv.js';

export const MARK_COLUMNS = ['x', 'y', 'z', 'roll', 'pitch', 'yaw', 'name', 'mark', 'note'];

/** Returns marks as the text of a CSV file. A mark is {pose, name, mark, note}. */
export function marksCsv(marks) {
  return csv(
    MARK_COLUMNS,
    marks.map(({ pose, name, mark, note }) => [...pose, name, mark, note]),
  );
}

/** Returns {node, marks, of(pose), add(mark), remove(pose)}. `actions`: changed(marks), fly(mark), fileName(). */
export function createMarks(actions) {
  const marks = [];
  let saved = true;
  const rows = element('tbody');
  const save = element('button', {
    type: 'button',
    class: 'main',
    id: 'save-marks',
    text: 'Save as CSV',
    on: {
      click: () => {
        saveFile(actions.fileName(), marksCsv(marks), 'text/csv');
        saved = true;
      },
    },
  });
  const empty = element(
    'p',
    { class: 'empty' },
    'Click a place or a spawn, and press Good or Bad in its answer. The CSV file is input of ',
    element('code', { text: 'spawnfield check' }),
    ' and of ',
    element('code', { text: 'spawnfield sample --avoid' }),
    '.',
  );
  const table = element(
    'table',
    { id: 'mark-rows' },
    element(
      'thead',
      {},
      element('tr', {}, ...['Mark', 'Name and note', 'Actions'].map((text) => element('th', { scope: 'col', text }))),
    ),
    rows,
  );
  const node = element('div', { class: 'block' }, empty, table, element('div', { class: 'row' }, save));
  save.parentElement.style.marginTop = '10px';
  window.addEventListener('beforeunload', (event) => {
    if (!saved) event.preventDefault();
  });

  function fill() {
    empty.hidden = marks.length > 0;
    table.hidden = save.hidden = marks.length === 0;
    rows.replaceChildren(
      ...marks.map((mark) =>
        element(
          'tr',
          {},
          element('td', { text: mark.mark === 'good' ? '+ good' : '− bad' }),
          element('td', {}, element('strong', { text: mark.name }), mark.note && `: ${mark.note}`),
          element(
            'td',
            { class: 'number' },
            element('button', { type: 'button', text: 'Fly', on: { click: () => actions.fly(mark) } }),
            ' ',
            element('button', {
              type: 'button',
              text: 'Delete',
              on: { click: () => remove(mark.pose) },
            }),
          ),
        ),
      ),
    );
  }

  function changed() {
    saved = marks.length === 0;
    fill();
    actions.changed(marks);
  }

  const indexOf = (pose) => marks.findIndex((mark) => mark.pose.every((value, at) => value === pose[at]));

  function remove(pose) {
    marks.splice(indexOf(pose), 1);
    changed();
  }

  fill();
  return {
    node,
    marks,
    /** Returns the mark of a pose, or undefined. */
    of: (pose) => marks[indexOf(pose)],
    /** A pose has one mark: the last one. */
    add(mark) {
      const before = indexOf(mark.pose);
      const name = mark.name || marks[before]?.name || `mark ${marks.length + 1}`;
      marks.splice(before < 0 ? marks.length : before, before < 0 ? 0 : 1, { ...mark, name });
      changed();
    },
    remove,
  };
}
