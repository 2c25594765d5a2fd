// The page: reads the pack, draws it, and connects the panels with the map.
import { Color } from 'three';
import licences from 'licences';
import { byId, element, notice, visibleText } from './dom.js';
import { bytesFromBase64, PackError, readPack } from './pack.js';
import { nearestPose, readLayer } from './layer_data.js';
import { sharedUniforms, MOST_VERDICTS } from './shaders.js';
import { createWorld, partBounds } from './world_mesh.js';
import { createVerdictLayer } from './verdict_layer.js';
import { createMarkers, createRobots, MARKER, robotGeometry } from './robot_shapes.js';
import { createLines, discard } from './lines.js';
import { createView } from './scene.js';
import { createCameraViews } from './camera_views.js';
import { createPicking } from './picking.js';
import { createOverlay } from './overlay.js';
import { createLegend } from './legend.js';
import { createFloors, cutAbove } from './floors.js';
import { layerAnswer, spawnAnswer, answerRow } from './answers.js';
import { createAnswerPanel } from './answer_panel.js';
import { createSpawnList, pairList } from './spawn_list.js';
import { createMarks, marksCsv } from './marks.js';
import { createMeasure } from './measure.js';
import { createRegions } from './regions.js';
import { createLive } from './live.js';
import { createSelection } from './selection.js';
import { listenToKeys } from './keys.js';
import { createTabs, createToolbar, setUpSheet, setUpTheme } from './frame.js';
import { grouped, percent, withUnit } from './numbers.js';

const UNCUT = 1e30;
const CLICK_PIXELS = 6;
const MANY_THINGS = 600000; // triangles and poses

/** Starts the page. `window.spawnfield` is for tests and for the console; docs: web/README.md. */
export function startPage(scriptText) {
  const pickLoaded = deferred();
  window.spawnfield = { ready: pickLoaded.promise };
  pickLoaded.promise.catch(() => {}); // the page itself shows the failure
  requestAnimationFrame(() =>
    setTimeout(async () => {
      try {
        await openPage(scriptText, window.spawnfield);
        pickLoaded.resolve();
      } catch (error) {
        showFailure(error);
        pickLoaded.reject(error);
      }
    }),
  );
}

function deferred() {
  const made = {};
  made.promise = new Promise((resolve, reject) => Object.assign(made, { resolve, reject }));
  return made;
}

function showFailure(error) {
  const known = error instanceof PackError;
  const text = known
    ? error.message
    : `The page cannot be shown: ${error.message}. If the file was changed on its way, ` +
      'write it again with "spawnfield review".';
  document.body.classList.add('failed');
  document
    .querySelector('main')
    .replaceWith(
      element(
        'div',
        { class: 'failure', role: 'alert', id: 'failure' },
        element('h2', { text: 'This review cannot be shown' }),
        element('p', { text }),
      ),
    );
  byId('sheet-tabs').hidden = true;
  byId('hint').textContent = '';
}

function packBytes() {
  const script = byId('spawnfield-data');
  if (!script)
    throw new PackError(
      'This page has no data. "spawnfield review MAP --robot R -o review.html" writes a page with data.',
    );
  const bytes = bytesFromBase64(script.textContent);
  script.remove();
  return bytes;
}

function needWebGl2() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl)
    throw new PackError(
      'This browser has no WebGL 2. Allow graphics (WebGL) in its settings, or open the page ' +
        'in a current Firefox or Chromium.',
    );
  gl.getExtension('WEBGL_lose_context')?.loseContext();
}

async function openPage(scriptText, api) {
  const pack = await readPack(packBytes());
  const { json } = pack;
  if (json.verdicts.length > MOST_VERDICTS)
    throw new PackError(`The data has ${json.verdicts.length} verdicts; the page shows ${MOST_VERDICTS}.`);
  needWebGl2();
  const { origin } = json;
  const local = (place) => place.map((value, axis) => value - origin[axis]);
  const robotHeight = json.robot.bounds.max[2] - json.robot.bounds.min[2];

  document.title = `${visibleText(json.title ?? 'review')} – spawnfield`;
  byId('title').textContent = visibleText(json.title ?? 'spawnfield review');

  // The map
  const shared = sharedUniforms(json.verdicts);
  const bounds = worldBounds(json);
  const heights = [bounds.min[2] + origin[2], bounds.max[2] + origin[2]];
  const view = createView(byId('canvas'), bounds, shared, drawnThings(json) > MANY_THINGS);
  const world = createWorld(pack, shared, [bounds.min[2], bounds.max[2]]);
  const verdictLayer = createVerdictLayer(shared, origin);
  view.scene.add(world.group, verdictLayer.object);
  let robot = robotGeometry(pack);
  const robotRadius = Math.max(robot.boundingSphere.radius, 0.1);
  const cameraViews = createCameraViews(view);
  const picking = createPicking(world, json.robot.bounds, origin, scriptText);
  const showSelection = createSelection(view, () => robot, shared, origin);
  const overlay = createOverlay(view);

  const state = {
    layers: (json.layers ?? []).map((layer) => readLayer(pack, layer)),
    layerIndex: 0,
    spawns: json.spawns ?? [],
    pairs: json.pairs ?? [],
    answer: null,
  };
  const layerNow = () => state.layers[state.layerIndex] ?? null;

  // Panels
  const actions = {
    toggleVerdict(index, on) {
      shared.palette.value[index].w = on ? 1 : 0;
      view.requestRender();
    },
    colorBy(how) {
      verdictLayer.colorBy(how);
      view.requestRender();
    },
    setPatterns(on) {
      shared.patterns.value = on ? 1 : 0;
      spawnList.refresh();
      view.requestRender();
    },
    setOpacity(share) {
      verdictLayer.setOpacity(share);
      view.requestRender();
    },
    setLayer: showLayer,
    show(label, on) {
      world.meshes
        .filter((mesh) => mesh.userData.label === label)
        .forEach((mesh) => {
          mesh.visible = on;
        });
      view.requestRender();
    },
    setCut(z) {
      shared.cut.value = z === null ? UNCUT : z - origin[2];
      view.requestRender();
    },
    flyToFloor(index) {
      const [low, high] = json.floors[index].z;
      cameraViews.flyTo([view.center.x, view.center.y, (low + high) / 2 - origin[2]], view.radius * 0.8);
    },
    flyToIsland(index) {
      const island = json.islands[index];
      const { min, max } = island.bounds ?? { min: island.center, max: island.center };
      const radius = Math.max(Math.hypot(max[0] - min[0], max[1] - min[1]) / 2, 1);
      legend.colorBy(layerNow()?.hasIslands ? 'island' : 'verdict');
      cameraViews.flyTo(local(island.center), radius);
    },
  };
  const legend = createLegend({
    verdicts: json.verdicts,
    islands: () => json.islands ?? [],
    heights,
    actions,
    labels: json.world.meshes.map(({ label }) => label),
    layers: () => state.layers,
  });
  const floors = createFloors({
    floors: json.floors ?? [],
    islands: json.islands ?? [],
    heights,
    robotHeight,
    actions,
  });
  byId('settings').append(legend.node, floors.node);

  const answerPanel = createAnswerPanel({
    swatch: legend.swatch,
    showPart(part) {
      world.highlight(part);
      const bounds = partBounds(world.meshes, part);
      if (bounds) cameraViews.flyTo(bounds.center, Math.max(bounds.radius * 1.3, robotRadius * 3));
      else notice('This part has no triangles in the simplified world.');
      view.requestRender();
    },
    fly: (answer) => cameraViews.flyTo(local(answer.pose.slice(0, 3)), robotRadius * 4),
    mark: ({ pose, name }, mark, note) => {
      marks.add({ pose, name, mark, note });
      notice(`Marked as ${mark}. The tab Marks has all marks.`);
    },
    close: () => select(null),
  });
  const spawnList = createSpawnList(json.verdicts, {
    swatch: legend.swatch,
    pick: (list, index) => {
      select(spawnAnswer(json, state.spawns[list], index), { list, index });
      cameraViews.flyTo(local(state.answer.pose.slice(0, 3)), robotRadius * 4);
    },
  });
  const marks = createMarks({
    changed: drawMarkers,
    fly: ({ pose }) => cameraViews.flyTo(local(pose.slice(0, 3)), robotRadius * 4),
    fileName: () => 'marks.csv',
  });
  const pairsPanel = pairList(state.pairs, {
    swatch: ({ verdict }) => legend.swatch(json.verdicts.findIndex(({ name }) => name === verdict)),
    pick: showPair,
  });
  const measure = createMeasure(view, origin, (on) => {
    toolbar.setMeasuring(on);
    setCrossing(on);
    if (on) notice('Click two places. Esc ends measuring.');
  });
  const regions = createRegions(view, origin, (on) => {
    setCrossing(on);
    if (on) notice('Click the corners of the region. Enter or a double click ends it, Esc gives up.');
  });
  const live = json.live
    ? createLive(json.live, json.command, {
        regionHeight: heights[1],
        drawRegion: regions.begin,
        showRegions: regions.show,
        showLayers(answer) {
          state.layers.forEach(verdictLayer.forget);
          state.layers = answer.json.layers.map((layer) => readLayer(answer, layer));
          if (answer.json.robot) changeRobot(answer);
          if (answer.json.islands) {
            json.islands = answer.json.islands;
            floors.setIslands(json.islands);
          }
          showLayer(Math.min(state.layerIndex, state.layers.length - 1));
        },
        showSpawns(answer) {
          for (const list of answer.json.spawns) {
            const before = state.spawns.findIndex(({ file }) => file === list.file);
            if (before >= 0) state.spawns[before] = list;
            else state.spawns.push(list);
          }
          showSpawns(state.spawns.findIndex(({ file }) => file === answer.json.spawns[0]?.file));
          tabs.open('Spawns');
        },
        draw: view.renderNow,
        countsOf: (kind, answer) => verdictCounts(json.verdicts, kind, answer.json),
      })
    : null;
  const tabs = createTabs(
    [
      live && ['Live', live.node],
      ['Spawns', spawnList.node],
      state.pairs.length > 0 && ['Pairs', pairsPanel],
      ['Marks', marks.node],
    ].filter(Boolean),
  );
  byId('answers').append(answerPanel.node, tabs.node);
  const toolbar = createToolbar({
    top: () => cameraViews.top(),
    isometric: () => cameraViews.isometric(),
    measure: () => measure.toggle(),
  });

  function setCrossing(on) {
    byId('map').classList.toggle('crossing', on);
  }

  // Layers, spawns, pairs, marks on the map
  function showLayer(index) {
    state.layerIndex = Math.max(index, 0);
    verdictLayer.show(layerNow());
    legend.showLayer(layerNow(), state.layerIndex);
    if (state.answer?.kind === 'layer') answerAgain(state.answer);
    view.requestRender();
  }

  // The same place in another layer: another heading, or other settings in live mode.
  function answerAgain({ pose: [x, y], drawnHeight }) {
    const layer = layerNow();
    const pose = layer ? nearestPose(layer, x, y, drawnHeight) : -1;
    select(pose < 0 ? null : layerAnswer(json, layer, pose));
  }

  function changeRobot(answer) {
    robot = robotGeometry(answer);
    picking.setRobot(answer.json.robot.bounds);
    drawSpawns();
  }

  let spawnRobots = null;
  let spawnRefs = [];
  function drawSpawns() {
    discard(spawnRobots);
    spawnRobots = createRobots(robot, spawnRefs, shared, origin);
    view.scene.add(spawnRobots);
  }

  function showSpawns(index) {
    spawnRefs = state.spawns.flatMap((list, l) =>
      list.poses.map((pose, i) => ({ pose, verdict: list.verdicts[i], list: l, index: i })),
    );
    drawSpawns();
    spawnList.show(state.spawns, Math.max(index, 0));
    drawMarkers();
    showFacts();
  }

  let markers = null;
  function drawMarkers() {
    discard(markers);
    const above = json.robot.bounds.max[2] + 0.3 * robotRadius;
    const valid = json.verdicts.findIndex(({ name }) => name === 'valid');
    const lifted = ([x, y, z]) => [x, y, z + above];
    markers = createMarkers(
      [
        ...spawnRefs.map(({ pose, verdict }) => ({
          place: lifted(pose),
          verdict,
          shape: verdict === valid ? MARKER.disc : MARKER.crossed,
        })),
        ...marks.marks.map(({ pose, mark }) => ({
          place: lifted(lifted(pose)),
          verdict: 0,
          shape: mark === 'good' ? MARKER.good : MARKER.bad,
        })),
      ],
      shared,
      origin,
    );
    view.scene.add(markers);
    view.requestRender();
  }

  const pairLines = createLines(
    state.pairs.flatMap(({ pairs }) =>
      pairs
        .filter(({ path }) => path?.length > 1)
        .map((pair) => ({ places: pair.path.map(lift), color: verdictColor(json, pair.verdict) })),
    ),
    origin,
    { width: 3 },
  );
  view.scene.add(pairLines);
  let shownPair = [];
  function showPair(l, index) {
    const pair = state.pairs[l].pairs[index];
    select(null);
    shownPair.forEach(discard);
    const verdict = Math.max(
      json.verdicts.findIndex(({ name }) => name === pair.verdict),
      0,
    );
    const path = pair.path?.length > 1 ? pair.path : [pair.start.slice(0, 3), pair.goal.slice(0, 3)];
    shownPair = [
      createLines([{ places: path.map(lift), color: '#d81b60' }], origin, { width: 5, onTop: true }),
      createRobots(
        robot,
        [
          { pose: pair.start, verdict },
          { pose: pair.goal, verdict },
        ],
        shared,
        origin,
      ),
    ];
    view.scene.add(...shownPair);
    const [low, high] = [Math.min, Math.max].map((pick) =>
      [0, 1, 2].map((axis) => pick(...path.map((place) => place[axis]))),
    );
    cameraViews.flyTo(
      local(low.map((value, axis) => (value + high[axis]) / 2)),
      Math.max(Math.hypot(...high.map((value, axis) => value - low[axis])) * 0.6, robotRadius * 4),
    );
    answerPanel.clear(`${pair.name || `Pair ${index + 1}`}: ${pair.verdict.replace(/_/g, ' ')}. ${pair.reason ?? ''}`);
  }

  // Answers
  function select(answer, spawn = null) {
    state.answer = answer;
    shownPair.forEach(discard);
    shownPair = [];
    const marked = answer?.hit?.part ?? null;
    world.highlight(marked !== null && answer.hit.label !== 'terrain' ? marked : null);
    showSelection(answer, answer?.kind === 'layer');
    spawnList.select(spawn?.list ?? -1, spawn?.index ?? -1);
    if (!answer) {
      answerPanel.clear();
      return;
    }
    answerPanel.show(answer);
    byId('answers').scrollTop = 0;
    byId('sheet-tabs').querySelector('[data-panel=answers]').click();
    if (live) live.askPose(answer.pose, answerPanel.showProgram, answerPanel.showProgramError);
  }

  const cutNow = () => shared.cut.value;

  /** Answers for a pixel of the canvas. Returns the answer, or null. */
  async function pick(x, y) {
    await picking.ready;
    const ray = view.rayAt(x, y);
    const place = picking.place(ray, cutNow());
    const spawn = picking.robot(ray, spawnRefs, cutNow());
    if (spawn && (!place || spawn.distance < place.distance + robotRadius)) {
      const { list, index } = spawnRefs[spawn.index];
      select(spawnAnswer(json, state.spawns[list], index), { list, index });
      return state.answer;
    }
    const layer = layerNow();
    if (!place || !layer) {
      select(null);
      answerPanel.clear(layer ? 'There is nothing of the world at this place.' : undefined);
      return null;
    }
    const scenePlace = place.place.map((value, axis) => value + origin[axis]);
    const pose = nearestPose(layer, ...scenePlace, cutNow() === UNCUT ? Infinity : cutNow() + origin[2]);
    if (pose < 0) {
      select(null);
      answerPanel.clear('No pose was judged near this place. The raster of this page does not reach it.');
      return null;
    }
    select(layerAnswer(json, layer, pose));
    return state.answer;
  }

  function placeAt(x, y) {
    const found = picking.place(view.rayAt(x, y), cutNow());
    return found && { ...found, place: found.place.map((value, axis) => value + origin[axis]) };
  }

  async function click(x, y) {
    await picking.ready;
    if (!measure.active && !regions.active) {
      pick(x, y);
      return;
    }
    const found = placeAt(x, y);
    if (!found) notice('There is nothing of the world at this place.');
    else if (measure.active) measure.click(found.place);
    else regions.click(found.place);
  }

  listenToPointer(view, {
    click,
    doubleClick: regions.finish,
    hover(x, y) {
      if (!picking.isReady()) return;
      const found = placeAt(x, y);
      showTooltip(found && json.parts[found.part]?.name, found?.label, x, y);
      byId('under-pointer').textContent = found ? found.place.map((value) => value.toFixed(2)).join(', ') : '';
    },
  });
  listenToKeys({
    cameraViews,
    floors,
    toolbar,
    measure,
    fly: () => state.answer && cameraViews.flyTo(local(state.answer.pose.slice(0, 3)), robotRadius * 4),
    enter: () => (regions.active ? regions.finish() : click(view.canvas.clientWidth / 2, view.canvas.clientHeight / 2)),
    escape() {
      if (measure.active) measure.toggle(false);
      else if (regions.active) regions.cancel();
      else select(null);
    },
    help: toolbar.openHelp,
  });

  function showFacts() {
    const facts = byId('facts');
    facts.replaceChildren();
    const refused = spawnRefs.filter(({ verdict }) => json.verdicts[verdict]?.name !== 'valid').length;
    if (refused > 0)
      facts.append(
        element(
          'li',
          {},
          element('button', {
            type: 'button',
            id: 'refused-fact',
            text: `${grouped(refused)} of ${grouped(spawnRefs.length)} spawns are not valid`,
            on: {
              click: () => {
                tabs.open('Spawns');
                byId('sheet-tabs').querySelector('[data-panel=answers]').click();
                byId('spawn-rows').querySelector('button')?.click();
              },
            },
          }),
        ),
      );
    else if (spawnRefs.length > 0)
      facts.append(element('li', { text: `all ${grouped(spawnRefs.length)} spawns are valid` }));
    if (json.world.share < 1)
      facts.append(
        element('li', {
          id: 'simplified',
          title: 'Verdicts, reasons and heights of poses are those of ' + 'the whole world.',
          text: `World simplified to ${percent(json.world.share)}; verdicts are exact`,
        }),
      );
  }

  // First picture
  setUpTheme((dark) => {
    shared.dark.value = dark ? 1 : 0;
    view.renderer.setClearColor(new Color(getComputedStyle(document.documentElement).getPropertyValue('--map').trim()));
    view.requestRender();
  });
  setUpSheet(view);
  view.canvas.addEventListener('webglcontextlost', () =>
    notice('The browser has stopped the graphics of this page. Load the page again.'),
  );
  toolbar.fill(json, licences);
  view.beforeRender(() => verdictLayer.aim(view));
  view.onRender(overlay);
  view.onRender(measure.update);
  view.resize();
  showLayer(0);
  showSpawns(0);
  startView(cameraViews, view);
  const decodeMilliseconds = performance.now();
  view.renderNow();
  readOnePixel(view);
  byId('loading').remove();
  const loadMilliseconds = performance.now();

  Object.assign(api, {
    pickingReady: picking.ready,
    pick,
    placeAt,
    answerAt(layer, pose) {
      return layerAnswer(json, state.layers[layer], pose);
    },
    select(list, index) {
      select(spawnAnswer(json, state.spawns[list], index), { list, index });
    },
    project: (place) => view.project(local(place)),
    answer: () => state.answer,
    answerCsv: () => answerRow(state.answer),
    marksCsv: () => marksCsv(marks.marks),
    cut: floors.cutAt,
    top: cameraViews.top,
    isFlying: cameraViews.isFlying,
    target: () => view.controls.target.toArray().map((value, axis) => value + origin[axis]),
    statistics: () => ({
      drawCalls: view.renderer.info.render.calls,
      triangles: view.renderer.info.render.triangles,
      bytesUploaded: view.uploads.bytes,
      loadMilliseconds,
      decodeMilliseconds,
      frameMilliseconds: api.turn(5),
    }),
    /** Turns the view by some pictures and returns the mean milliseconds of one. */
    turn(pictures) {
      const began = performance.now();
      for (let i = 0; i < pictures; ++i) {
        cameraViews.turn(0.02, 0);
        view.renderNow();
        readOnePixel(view);
      }
      return (performance.now() - began) / pictures;
    },
    /** Draws, and returns [red, green, blue] of a CSS pixel of the canvas. */
    pixelAt(x, y) {
      view.renderNow();
      const gl = view.renderer.getContext();
      const color = new Uint8Array(4);
      const ratio = shared.pixelRatio.value;
      gl.readPixels(
        Math.round(x * ratio),
        Math.round((view.canvas.clientHeight - y) * ratio),
        1,
        1,
        gl.RGBA,
        gl.UNSIGNED_BYTE,
        color,
      );
      return [...color.subarray(0, 3)];
    },
    runs: () => live?.runs ?? [],
  });
}

// Relative to the origin. A map without bounds in some direction has those of its meshes.
function worldBounds({ map, world, origin }) {
  const bound = (side, pick, ofMesh) =>
    [0, 1, 2].map((axis) => {
      const value = map.bounds[side][axis];
      return Number.isFinite(value) ? value - origin[axis] : pick(...world.meshes.map((mesh) => ofMesh(mesh, axis)));
    });
  return {
    min: bound('min', Math.min, ({ offset }, axis) => offset[axis]),
    max: bound('max', Math.max, ({ offset, scale }, axis) => offset[axis] + 65535 * scale),
  };
}

function drawnThings(json) {
  return json.world.meshes.reduce((sum, { indices }) => sum + indices.count / 3, 0) + (json.layers?.[0]?.count ?? 0);
}

const lift = ([x, y, z]) => [x, y, z + 0.05];

function verdictColor(json, name) {
  return json.verdicts.find((verdict) => verdict.name === name)?.color ?? '#808080';
}

function verdictCounts(verdicts, kind, json) {
  const counts = verdicts.map(() => 0);
  if (kind === 'layers')
    json.layers.forEach((layer) =>
      layer.counts.forEach((count, verdict) => {
        counts[verdict] += count;
      }),
    );
  else
    json.spawns.forEach((list) =>
      list.verdicts.forEach((verdict) => {
        ++counts[verdict];
      }),
    );
  return verdicts.map(({ name }, verdict) => [name, counts[verdict]]).filter(([, count]) => count > 0);
}

function startView(cameraViews, view) {
  cameraViews.isometric();
  cameraViews.finish();
  view.controls.update();
}

// Reading a pixel waits until the picture is drawn.
function readOnePixel(view) {
  const gl = view.renderer.getContext();
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
}

function showTooltip(name, label, x, y) {
  const tooltip = byId('tooltip');
  tooltip.hidden = !name;
  if (!name) return;
  tooltip.textContent = visibleText(`${name} (${label})`);
  const map = byId('map');
  tooltip.style.left = `${Math.min(x + 14, map.clientWidth - tooltip.offsetWidth - 6)}px`;
  tooltip.style.top = `${Math.min(y + 16, map.clientHeight - tooltip.offsetHeight - 6)}px`;
}

function listenToPointer(view, { click, doubleClick, hover }) {
  const { canvas } = view;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  let down = null;
  let asked = false;
  canvas.addEventListener('pointerdown', (event) => {
    down = event.isPrimary && event.button === 0 ? at(event) : null;
  });
  canvas.addEventListener('pointerup', (event) => {
    if (!down) return;
    const [x, y] = at(event);
    if (Math.hypot(x - down[0], y - down[1]) < CLICK_PIXELS) click(x, y);
    down = null;
  });
  canvas.addEventListener('dblclick', doubleClick);
  canvas.addEventListener('pointerleave', () => {
    byId('tooltip').hidden = true;
    byId('under-pointer').textContent = '';
  });
  canvas.addEventListener('pointermove', (event) => {
    if (asked || event.pointerType === 'touch') return;
    if (event.buttons !== 0) {
      byId('tooltip').hidden = true;
      return;
    }
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      hover(...at(event));
    });
  });
}
