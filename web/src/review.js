// The review: what is loaded and selected, and the panels that show and change it. `page` has all of it.
import licences from 'licences';
import { byId, element, notice } from './dom.js';
import { nearestPose, readLayer } from './layer_data.js';
import { farFromClick, layerAnswer, spawnAnswer, spawnName } from './answers.js';
import { createOverlay } from './overlay.js';
import { createLegend } from './legend.js';
import { createFloors } from './floors.js';
import { createAnswerPanel } from './answer_panel.js';
import { createSpawnList, pairList } from './spawn_list.js';
import { createMarks } from './marks.js';
import { createMeasure } from './measure.js';
import { createRegions } from './regions.js';
import { createLive } from './live.js';
import { listenToKeys } from './keys.js';
import { listenToPointer, showUnderPointer } from './pointer.js';
import { createTabs, createToolbar, setUpSheet, setUpTheme } from './frame.js';
import { grouped, percent } from './numbers.js';
import {
  changed,
  changeRobot,
  drawMarkers,
  drawSpawns,
  flyToPose,
  placeAt,
  showAnswer,
  showPair,
  showPart,
  spawnAt,
  UNCUT,
} from './map_objects.js';

const MANY_SPAWNS = 5000; // the pointer does not look for one of so many at each move

/** Returns the page of a pack with all of its panels; `map` is that of map_objects.js. */
export function createReview(pack, map) {
  const { json } = pack;
  const page = {
    json,
    map,
    layers: (json.layers ?? []).map((layer) => readLayer(pack, layer)),
    layerIndex: 0,
    spawns: json.spawns ?? [],
    pairs: json.pairs ?? [],
    answer: null,
  };
  createSettings(page);
  createTools(page);
  createLists(page);
  listen(page);
  page.sheet = setUpSheet(map.view);
  page.toolbar.fill(json, licences);
  const overlay = createOverlay(map.view);
  map.view.onRender(overlay);
  map.view.onRender(page.measure.update);
  setUpTheme((dark, background) => {
    map.shared.dark.value = dark ? 1 : 0;
    map.view.setBackground(background);
  });
  map.view.resize();
  showLayer(page, 0);
  showSpawns(page, 0);
  map.cameraViews.isometric();
  map.cameraViews.finish();
  return page;
}

export const layerNow = (page) => page.layers[page.layerIndex] ?? null;

// The panel "Colours and views".
function createSettings(page) {
  const { json, map } = page;
  const islands = () => json.islands ?? [];
  page.legend = createLegend({
    verdicts: json.verdicts,
    islands,
    heights: map.heights,
    labels: json.world.meshes.map(({ label }) => label),
    layers: () => page.layers,
    colors: json.colors ?? 'verdict',
    actions: legendActions(page),
  });
  page.floors = createFloors({
    floors: json.floors ?? [],
    islands: islands(),
    heights: map.heights,
    robotHeight: () => map.robotBounds.max[2] - map.robotBounds.min[2],
    actions: floorActions(page),
  });
  byId('settings').append(page.legend.node, page.floors.node);
}

function legendActions(page) {
  const { map } = page;
  return {
    toggleVerdict: (index, on) => changed(map, ({ shared }) => (shared.palette.value[index].w = on ? 1 : 0)),
    colorBy: (how) => changed(map, ({ verdictLayer }) => verdictLayer.colorBy(how)),
    setOpacity: (share) => changed(map, ({ verdictLayer }) => verdictLayer.setOpacity(share)),
    setLayer: (index) => showLayer(page, index),
    setPatterns(on) {
      changed(map, ({ shared }) => (shared.patterns.value = on ? 1 : 0));
      page.spawnList.refresh();
    },
    show(label, on) {
      const meshes = map.world.meshes.filter((mesh) => mesh.userData.label === label);
      changed(map, () => meshes.forEach((mesh) => (mesh.visible = on)));
    },
  };
}

function floorActions(page) {
  const { json, map } = page;
  const { cameraViews, view } = map;
  return {
    setCut: (z) => changed(map, ({ shared }) => (shared.cut.value = z === null ? UNCUT : z - map.origin[2])),
    flyToFloor(index) {
      const height = json.floors[index].height - map.origin[2];
      cameraViews.flyTo([view.center.x, view.center.y, height], view.radius * 0.8);
    },
    flyToIsland(index) {
      const { center, area } = json.islands[index];
      page.legend.colorBy(layerNow(page)?.hasIslands ? 'island' : 'verdict');
      cameraViews.flyTo(map.local(center), Math.max(Math.sqrt(area), 1));
    },
  };
}

// What works on the map itself: views, measuring, regions.
function createTools(page) {
  const { map } = page;
  const setCrossing = (on, hint) => {
    byId('map').classList.toggle('crossing', on);
    if (on) notice(hint);
  };
  page.measure = createMeasure(map.view, map.origin, (on) => {
    page.toolbar.setMeasuring(on);
    setCrossing(on, 'Click two places. Esc ends measuring.');
  });
  page.regions = createRegions(map.view, map.origin, (on) =>
    setCrossing(on, 'Click the corners of the region. Enter or a double click ends it, Esc gives up.'),
  );
  page.toolbar = createToolbar({
    top: () => map.cameraViews.top(),
    isometric: () => map.cameraViews.isometric(),
    measure: () => page.measure.toggle(),
  });
}

// The panel with the answer and the lists.
function createLists(page) {
  const { json, map } = page;
  const { swatch } = page.legend;
  page.answerPanel = createAnswerPanel({
    swatch,
    showPart: (part) => showPart(map, part) || notice('This part has no triangles in the simplified world.'),
    fly: ({ pose }) => flyToPose(map, pose),
    close: () => select(page, null),
    markOf: ({ pose }) => page.marks.of(pose),
    mark({ pose, name }, mark, note) {
      if (mark) page.marks.add({ pose, name, mark, note });
      else page.marks.remove(pose);
      notice(mark ? `Marked as ${mark}. The tab Marks has all marks.` : 'The mark is taken away.');
    },
  });
  page.spawnList = createSpawnList(json.verdicts, {
    swatch,
    pick(list, index) {
      selectSpawn(page, list, index);
      flyToPose(map, page.answer.pose);
    },
  });
  page.marks = createMarks({
    changed(marks) {
      map.marks = marks;
      drawMarkers(map);
      byId('tab-marks').textContent = marks.length > 0 ? `Marks (${marks.length})` : 'Marks';
    },
    fly: ({ pose }) => flyToPose(map, pose),
    fileName: () => 'marks.csv',
  });
  const pairs = pairList(page.pairs, {
    swatch: ({ verdict }) => swatch(json.verdicts.findIndex(({ name }) => name === verdict)),
    pick: (list, index) => selectPair(page, page.pairs[list].pairs[index], index),
  });
  page.live = json.live ? createLive(json.live, json.command, liveActions(page)) : null;
  page.tabs = createTabs(
    [
      page.live && ['Live', page.live.node],
      ['Spawns', page.spawnList.node],
      page.pairs.length > 0 && ['Pairs', pairs],
      ['Marks', page.marks.node],
    ].filter(Boolean),
  );
  byId('answers').append(page.answerPanel.node, page.tabs.node);
}

function liveActions(page) {
  const { json, map, regions } = page;
  return {
    regionHeight: map.heights[1],
    drawRegion: regions.begin,
    showRegions: regions.show,
    draw: map.view.renderNow,
    countsOf: (kind, answer) => verdictCounts(json.verdicts, kind, answer.json),
    showLayers(answer) {
      page.layers.forEach(map.verdictLayer.forget);
      page.layers = answer.json.layers.map((layer) => readLayer(answer, layer));
      if (answer.json.robot) changeRobot(map, answer);
      page.hasOldSpawns = page.spawns.some(({ isSampled }) => !isSampled);
      if (answer.json.islands) {
        json.islands = answer.json.islands;
        page.floors.setIslands(json.islands);
      }
      showLayer(page, Math.min(page.layerIndex, page.layers.length - 1));
      showFacts(page);
    },
    showSpawns(answer, isAsked) {
      for (const list of answer.json.spawns) {
        list.isSampled = true;
        const before = page.spawns.findIndex(({ file }) => file === list.file);
        if (before >= 0) page.spawns[before] = list;
        else page.spawns.push(list);
      }
      showSpawns(
        page,
        page.spawns.findIndex(({ file }) => file === answer.json.spawns[0]?.file),
      );
      if (isAsked) page.tabs.open('Spawns');
    },
  };
}

function verdictCounts(verdicts, kind, { layers, spawns }) {
  const counts = verdicts.map(() => 0);
  if (kind === 'layers') layers.forEach((layer) => layer.counts.forEach((count, at) => (counts[at] += count)));
  else spawns.forEach((list) => list.verdicts.forEach((verdict) => ++counts[verdict]));
  return verdicts.map(({ name }, at) => [name, counts[at]]).filter(([, count]) => count > 0);
}

/** Shows a layer. If an answer of a layer is selected, its place is answered again in this one. */
function showLayer(page, index) {
  const { map, answer } = page;
  page.layerIndex = Math.max(index, 0);
  const layer = layerNow(page);
  map.verdictLayer.show(layer);
  page.legend.showLayer(layer, page.layerIndex);
  if (answer?.kind === 'layer') {
    const pose = layer ? nearestPose(layer, answer.pose[0], answer.pose[1], answer.drawnHeight) : -1;
    select(page, pose < 0 ? null : layerAnswer(page.json, layer, pose));
  }
  map.view.requestRender();
}

function showSpawns(page, index) {
  drawSpawns(page.map, page.spawns);
  page.spawnList.show(page.spawns, Math.max(index, 0));
  showFacts(page);
}

// Short facts beside the title: refused spawns, and how much the world is simplified.
function showFacts(page) {
  const { json, map } = page;
  const refused = map.spawns.filter(({ verdict }) => json.verdicts[verdict]?.name !== 'valid').length;
  const all = grouped(map.spawns.length);
  const press = () => {
    page.tabs.open('Spawns');
    page.sheet.open('answers');
    byId('spawn-rows').querySelector('button')?.click();
  };
  const text = `${grouped(refused)} of ${all} spawns ${refused === 1 ? 'is' : 'are'} not valid`;
  const button = element('button', { type: 'button', id: 'refused-fact', text, on: { click: press } });
  byId('facts').replaceChildren();
  if (page.hasOldSpawns) byId('facts').append(element('li', { text: 'spawns of files have their first verdicts' }));
  if (refused > 0) byId('facts').append(element('li', {}, button));
  else if (map.spawns.length > 0) byId('facts').append(element('li', { text: `all ${all} spawns are valid` }));
  if (json.world.share < 1) byId('facts').append(simplifiedFact(json.world.share));
}

function simplifiedFact(share) {
  const text = `World simplified to ${percent(share)}; verdicts are exact`;
  const title = 'Verdicts, reasons and heights of poses are those of the whole world.';
  return element('li', { id: 'simplified', text, title });
}

/** Selects an answer, or none; `spawn` is {list, index} if it is one of a list. */
function select(page, answer, spawn = null) {
  page.answer = answer;
  showAnswer(page.map, answer);
  page.spawnList.select(spawn?.list ?? -1, spawn?.index ?? -1);
  if (!answer) {
    page.answerPanel.clear();
    return;
  }
  page.answerPanel.show(answer);
  byId('answers').scrollTop = 0;
  const { showProgram, showProgramError } = page.answerPanel;
  const ifSelected = (show) => (said) => {
    if (page.answer === answer) show(said);
  };
  page.live?.askPose(answer.pose, ifSelected(showProgram), ifSelected(showProgramError));
}

export function selectSpawn(page, list, index) {
  select(page, spawnAnswer(page.json, page.spawns[list], index), { list, index });
  page.sheet.open('answers');
}

function selectPair(page, pair, index) {
  select(page, null);
  showPair(page.map, pair);
  const name = pair.name || `Pair ${index + 1}`;
  page.answerPanel.clear(`${name}: ${pair.verdict.replace(/_/g, ' ')}. ${pair.reason ?? ''}`);
}

/** Answers for a CSS pixel of the map. Returns a promise of the answer, or of null. */
export async function pick(page, x, y) {
  const { json, map } = page;
  await map.picking.ready;
  page.sheet.open('answers');
  const spawn = spawnAt(map, x, y);
  if (spawn) {
    selectSpawn(page, spawn.list, spawn.index);
    return page.answer;
  }
  const layer = layerNow(page);
  const found = layer && placeAt(map, x, y);
  const highest = map.cut() === UNCUT ? Infinity : map.cut() + map.origin[2];
  const pose = found ? nearestPose(layer, ...found.place, highest) : -1;
  const answer = pose < 0 ? null : layerAnswer(json, layer, pose);
  if (answer) answer.remark = farFromClick(answer, found.place[2], layer.grid.step);
  select(page, answer);
  if (layer && !found) page.answerPanel.clear('There is nothing of the world at this place.');
  else if (layer && pose < 0)
    page.answerPanel.clear('No pose was judged near this place. The raster of this page does not reach it.');
  return page.answer;
}

// The name and the verdict of the spawn at a CSS pixel of the map, if there is one.
function spawnWords({ json, map, spawns }, x, y) {
  const spawn = map.spawns.length < MANY_SPAWNS ? spawnAt(map, x, y) : null;
  if (!spawn) return null;
  const list = spawns[spawn.list];
  return `${spawnName(list, spawn.index)}: ${json.verdicts[list.verdicts[spawn.index]].name.replace(/_/g, ' ')}`;
}

// A click answers, unless a tool waits for places.
async function click(page, x, y) {
  const { map, measure, regions } = page;
  await map.picking.ready;
  if (!measure.active && !regions.active) {
    pick(page, x, y);
    return;
  }
  const found = placeAt(map, x, y);
  if (!found) notice('There is nothing of the world at this place.');
  else if (measure.active) measure.click(found.place);
  else regions.click(found.place);
}

function listen(page) {
  const { json, map, measure, regions, toolbar } = page;
  const { canvas } = map.view;
  listenToPointer(canvas, {
    click: (x, y) => click(page, x, y),
    doubleClick: regions.finish,
    hover(x, y) {
      if (!map.picking.isReady()) return;
      const found = placeAt(map, x, y);
      const part = json.parts[found?.part]?.name;
      showUnderPointer(found, spawnWords(page, x, y) ?? (part && `${part} (${found.label})`), x, y);
    },
  });
  const { controls } = map.view;
  let angleBefore = 0;
  controls.addEventListener('start', () => (angleBefore = controls.getAzimuthalAngle()));
  controls.addEventListener('end', () => controls.getAzimuthalAngle() !== angleBefore && toolbar.turned());
  listenToKeys({
    cameraViews: map.cameraViews,
    floors: page.floors,
    toolbar,
    measure,
    help: toolbar.openHelp,
    fly: () => page.answer && flyToPose(map, page.answer.pose),
    enter: () => (regions.active ? regions.finish() : click(page, canvas.clientWidth / 2, canvas.clientHeight / 2)),
    escape() {
      if (measure.active) measure.toggle(false);
      else if (regions.active) regions.cancel();
      else select(page, null);
    },
  });
  canvas.addEventListener('webglcontextlost', () =>
    notice('The browser has stopped the graphics of this page. Load the page again.'),
  );
}
