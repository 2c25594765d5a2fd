// The panel of live mode: the options of the query, its runs, and the command line that gives the same result.
import { copyButton, element, saveFile } from './dom.js';
import { csv } from './csv.js';
import { grouped } from './numbers.js';
import { readPack } from './pack.js';
import { regionsFromText, regionsText } from './regions.js';

const QUIET_MILLISECONDS = 150;

/**
 * Returns ask(kind, body): one request at a time. A request that waits is replaced by a later one of the same kind.
 * `send(kind, body)` returns a promise and does not throw.
 */
export function createQueue(send) {
  const waiting = new Map();
  let busy = false;
  async function work() {
    busy = true;
    while (waiting.size > 0) {
      const [kind, body] = waiting.entries().next().value;
      waiting.delete(kind);
      await send(kind, body);
    }
    busy = false;
  }
  return (kind, body) => {
    waiting.set(kind, body);
    if (!busy) work();
  };
}

/** Sends a JSON body. Returns the answer's bytes, or throws an Error with the program's message. */
export async function post(address, body) {
  let response;
  try {
    response = await fetch(address, {
      method: 'POST',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify(body),
    });
  } catch {
    throw new Error('The program does not answer. Is "spawnfield review --serve" still running?');
  }
  const bytes = new Uint8Array(await response.arrayBuffer());
  if (response.ok) return bytes;
  let message = '';
  try {
    message = JSON.parse(new TextDecoder().decode(bytes)).message;
  } catch {
    /* not JSON: the status says enough */
  }
  throw new Error(message || `The program answered with status ${response.status}.`);
}

/** Returns the options that differ between two runs, as a text. */
export function changesText(before, after, controls) {
  const names = new Map(controls.map(({ option, name }) => [option, name]));
  const short = (value) => (value === undefined || value === '' ? 'none' : String(value).slice(0, 40));
  return Object.keys({ ...before, ...after })
    .filter((option) => before[option] !== after[option])
    .map((option) => `${names.get(option) ?? option}: ${short(after[option])}`)
    .join(', ');
}

/**
 * Returns {node, askPose(pose, show, fail)}. `live` is that of the pack. `actions`: showLayers(pack), showSpawns(pack),
 * draw(), drawRegion(done), showRegions(polygons), countsOf(kind, pack) → [[verdict, count], …].
 */
export function createLive(live, firstCommand, actions) {
  const { controls, address } = live;
  const values = Object.fromEntries(controls.map((control) => [control.option, control.value]));
  const forms = new Map();
  const runs = [];
  let lastOptions = optionsNow();
  const changedKinds = new Set(); // that the timer asks for
  let hasSpawns = false;
  let hasPressed = false; // the button that samples spawns
  let timer = 0;

  const error = element('p', { class: 'error', role: 'alert', id: 'live-error', hidden: true });
  const state = element('p', {
    class: 'quiet',
    id: 'live-state',
    role: 'status',
    text: 'Changes are sent to the program.',
  });
  const notices = element('ul', { class: 'quiet', id: 'live-notices' });
  const command = element('pre', { id: 'live-command', text: firstCommand ?? '' });
  const runRows = element('tbody', { id: 'live-runs' });

  const ask = createQueue(send);

  function optionsNow() {
    const set = controls
      .map(({ option }) => [option, values[option]])
      .filter(([, value]) => value !== null && value !== undefined && value !== '');
    return Object.fromEntries(set);
  }

  async function send(kind, request) {
    if (kind === 'pose') {
      await sendPose(request);
      return;
    }
    const isAsked = hasPressed;
    hasPressed = false;
    state.textContent = kind === 'layers' ? 'The program judges …' : 'The program samples …';
    const began = performance.now();
    try {
      const bytes = await post(`${address}${kind}`, request);
      const answered = performance.now();
      const pack = await readPack(bytes);
      if (kind === 'layers') actions.showLayers(pack);
      else actions.showSpawns(pack, isAsked);
      const decoded = performance.now();
      actions.draw();
      const done = performance.now();
      addRun({
        kind,
        options: request,
        pack,
        milliseconds: done - began,
        decodeMilliseconds: Math.round(decoded - answered),
        drawMilliseconds: Math.round(done - decoded),
      });
      error.hidden = true;
      notices.replaceChildren(...(pack.json.notices ?? []).map((text) => element('li', { text })));
      command.textContent = pack.json.command ?? '';
      state.textContent = `Done in ${Math.round(done - began)} ms.`;
    } catch (failure) {
      error.textContent = failure.message;
      error.hidden = false;
      state.textContent = 'The last run failed. The map shows the run before it.';
    }
  }

  // `show` and `fail` do nothing if another answer is selected by then.
  async function sendPose({ pose, options, show, fail }) {
    try {
      show(JSON.parse(new TextDecoder().decode(await post(`${address}pose`, { options, pose }))));
    } catch (failure) {
      fail(failure.message);
    }
  }

  function addRun({ kind, options, pack, milliseconds, ...parts }) {
    const run = {
      number: runs.length + 1,
      kind,
      options,
      changes: changesText(lastOptions, options, controls) || 'as before',
      counts: actions.countsOf(kind, pack),
      milliseconds: Math.round(milliseconds),
      ...parts,
      seconds: pack.json.seconds ?? null,
      command: pack.json.command ?? '',
    };
    lastOptions = options;
    runs.push(run);
    const counts = run.counts.map(([name, count]) => `${name.replace(/_/g, ' ')} ${grouped(count)}`).join(', ');
    runRows.prepend(
      element(
        'tr',
        {},
        element('td', { text: run.number }),
        element('td', {}, element('strong', { text: run.changes }), ` (${kind}) ${counts}`),
        element('td', { class: 'number', text: `${run.milliseconds} ms`, title: runTimes(run) }),
        element('td', {}, element('button', { type: 'button', text: 'Repeat', on: { click: () => repeat(run) } })),
      ),
    );
  }

  function repeat({ kind, options }) {
    for (const { option, type } of controls) {
      values[option] = options[option] ?? (type === 'flag' ? false : type === 'regions' ? '' : null);
      forms.get(option)?.(values[option]);
    }
    ask(kind, options);
  }

  function change(control, value) {
    values[control.option] = value;
    if (control.for !== 'spawns') changedKinds.add('layers');
    if (control.for === 'spawns' || (hasSpawns && control.for !== 'layers')) changedKinds.add('spawns');
    clearTimeout(timer);
    timer = setTimeout(() => {
      if (changedKinds.has('layers')) ask('layers', optionsNow());
      if (changedKinds.has('spawns')) askSpawns();
      changedKinds.clear();
    }, QUIET_MILLISECONDS);
  }

  function askSpawns() {
    hasSpawns = true;
    ask('spawns', optionsNow());
  }

  const groups = [...new Set(controls.map(({ group }) => group ?? 'Options'))];
  const form = element(
    'form',
    { id: 'live-form', autocomplete: 'off', on: { submit: (event) => event.preventDefault() } },
    ...groups.map((group, at) =>
      element(
        'details',
        { open: at < 3 || controls.length <= 16 },
        element('summary', { text: group }),
        ...controls
          .filter((control) => (control.group ?? 'Options') === group)
          .map((control) =>
            controlForm(
              control,
              (value) => change(control, value),
              (set) => forms.set(control.option, set),
              actions,
            ),
          ),
      ),
    ),
  );

  const node = element(
    'div',
    { class: 'block' },
    state,
    error,
    notices,
    form,
    element(
      'div',
      { class: 'row' },
      element('button', {
        type: 'button',
        class: 'main',
        id: 'live-spawns',
        text: 'Sample spawns',
        on: {
          click: () => {
            hasPressed = true;
            askSpawns();
          },
        },
      }),
      element('button', { type: 'button', text: 'Run again', on: { click: () => ask('layers', optionsNow()) } }),
    ),
    element('h3', { text: 'Command line with the same result' }),
    command,
    copyButton('Copy the command', () => command.textContent),
    element('h3', { text: 'Runs' }),
    element(
      'table',
      {},
      element(
        'thead',
        {},
        element(
          'tr',
          {},
          ...['#', 'What changed, and counts', 'Time', 'Again'].map((text) => element('th', { scope: 'col', text })),
        ),
      ),
      runRows,
    ),
    element(
      'div',
      { class: 'row' },
      element('button', {
        type: 'button',
        text: 'Save runs as CSV',
        on: { click: () => saveFile('runs.csv', runsCsv(runs), 'text/csv') },
      }),
      element('button', {
        type: 'button',
        text: 'Save runs as JSON',
        on: { click: () => saveFile('runs.json', `${JSON.stringify(runs, null, 1)}\n`, 'application/json') },
      }),
    ),
  );
  form.nextElementSibling.style.margin = '10px 0';

  return {
    node,
    runs,
    askPose(pose, show, fail) {
      ask('pose', { pose, options: optionsNow(), show, fail });
    },
  };
}

function runTimes({ seconds, decodeMilliseconds, drawMilliseconds }) {
  const program = seconds === null ? '' : `program ${Math.round(1000 * seconds)} ms, `;
  return `${program}decoding ${decodeMilliseconds} ms, drawing ${drawMilliseconds} ms`;
}

/** Returns runs as the text of a CSV file. */
export function runsCsv(runs) {
  const verdicts = [...new Set(runs.flatMap(({ counts }) => counts.map(([name]) => name)))];
  return csv(
    [
      'run',
      'kind',
      'changes',
      'milliseconds',
      'program_seconds',
      'decode_milliseconds',
      'draw_milliseconds',
      ...verdicts,
      'command',
    ],
    runs.map((run) => [
      run.number,
      run.kind,
      run.changes,
      run.milliseconds,
      run.seconds,
      run.decodeMilliseconds,
      run.drawMilliseconds,
      ...verdicts.map((verdict) => new Map(run.counts).get(verdict) ?? 0),
      run.command,
    ]),
  );
}

function controlForm(control, change, setter, actions) {
  const { name, type, value, unit, help, option } = control;
  const head = element(
    'span',
    { title: help ?? '' },
    element('span', { text: name }),
    element('output', { text: unit ?? '' }),
  );
  if (type === 'flag') return flagForm(control, change, setter);
  if (type === 'regions') return regionsForm(control, change, setter, actions);
  if (type === 'choice') {
    const select = element(
      'select',
      { 'data-option': option },
      ...(control.choices ?? []).map((choice) => element('option', { value: choice, text: choice })),
    );
    select.value = value ?? '';
    select.addEventListener('change', () => change(select.value));
    setter((next) => {
      select.value = next ?? '';
    });
    return element('label', { class: 'control', title: help ?? '' }, head, select);
  }
  const isNumber = type === 'number' || type === 'integer';
  const box = element('input', {
    type: isNumber ? 'number' : 'text',
    'data-option': option,
    min: control.min,
    max: control.max,
    step: type === 'integer' ? 1 : 'any',
    value: value ?? '',
  });
  box.addEventListener('input', () => {
    if (isNumber && !box.checkValidity()) return; // also of a number that is typed in part
    change(!isNumber ? box.value : box.value === '' ? null : Number(box.value));
  });
  const label = element('label', { class: 'control', title: help ?? '' }, head, box);
  setter((next) => {
    box.value = next ?? '';
  });
  if (!(isNumber && Number.isFinite(control.min) && Number.isFinite(control.max))) return label;
  const slider = element('input', {
    type: 'range',
    min: control.min,
    max: control.max,
    'aria-label': name,
    value: value ?? control.min,
    step: type === 'integer' ? 1 : 10 ** Math.floor(Math.log10((control.max - control.min) / 100)),
  });
  slider.addEventListener('input', () => {
    box.value = slider.value;
    change(Number(slider.value));
  });
  box.addEventListener('input', () => {
    slider.value = box.value;
  });
  setter((next) => {
    box.value = next ?? '';
    slider.value = next ?? control.min;
  });
  label.append(slider);
  return label;
}

function flagForm({ name, option, value, help }, change, setter) {
  const box = element('input', { type: 'checkbox', 'data-option': option });
  box.checked = Boolean(value);
  box.addEventListener('change', () => change(box.checked));
  setter((next) => {
    box.checked = Boolean(next);
  });
  return element('label', { class: 'check', title: help ?? '' }, box, element('span', { class: 'words', text: name }));
}

function regionsForm({ name, option, value, help }, change, setter, actions) {
  let polygons = [];
  const state = element('span', { class: 'quiet' });
  // A region of the command line that the page cannot draw stays as it is until another one is drawn.
  const show = (next) => {
    polygons = next ?? [];
    state.textContent = next === null ? 'a region' : polygons.length === 1 ? '1 region' : `${polygons.length} regions`;
    actions.showRegions(option, polygons);
  };
  const set = (next) => {
    show(next);
    change(regionsText(next));
  };
  const showText = (text) => show(regionsFromText(text, actions.regionHeight));
  setter(showText);
  showText(value);
  return element(
    'div',
    { class: 'control', title: help ?? '', role: 'group', 'aria-label': name },
    element('span', {}, element('span', { text: name }), state),
    element(
      'div',
      { class: 'row' },
      element('button', {
        type: 'button',
        'data-option': option,
        text: 'Draw a region',
        on: { click: () => actions.drawRegion((places) => set([...polygons, places])) },
      }),
      element('button', { type: 'button', text: 'Clear', on: { click: () => set([]) } }),
    ),
  );
}
