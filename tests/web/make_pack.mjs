// Packs for tests: a small world with known verdicts, and a large one. `node make_pack.mjs small|big FILE` writes the
// built page with such a pack.
import { readFileSync, writeFileSync } from 'node:fs';
import { createPack } from './encode.mjs';

const VERDICTS = [
  ['valid', '#009e73', 'The robot can stand here'],
  ['outside', '#999999', 'The place is outside of the map'],
  ['aerial', '#56b4e9', 'There is no ground close enough below the robot'],
  ['off_terrain', '#7a5c3e', 'The ground here is an obstacle'],
  ['submerged', '#0072b2', 'Water stands above the ground'],
  ['collision', '#d55e00', 'The robot touches something'],
  ['steep', '#e69f00', 'The ground is too steep'],
  ['unstable', '#cc79a7', 'The robot would tip over or slide'],
  ['obstructed', '#f0e442', 'Something is in the way above the robot'],
  ['unreachable', '#000000', 'The place is on none of the islands that were asked for'],
].map(([name, color, words]) => ({ name, color, words }));
export const verdictIndex = (name) => VERDICTS.findIndex((verdict) => verdict.name === name);
export const ORIGIN = [500000, 4600000, 100]; // far from zero, as UTM coordinates are

const NONE = -2147483648;
const STEP = 0.5;
const SIZE = 20;
const COLUMNS = 41;

/** Returns {positions, indices} of a box. */
function box([x0, y0, z0], [x1, y1, z1]) {
  const positions = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0]);
  const faces = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
  ];
  return { positions, indices: faces.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]) };
}

/** Returns {positions, indices} of heights over a grid of `cells` by `cells` squares. */
function heightfield(size, cells, height) {
  const positions = [];
  const indices = [];
  for (let r = 0; r <= cells; ++r)
    for (let c = 0; c <= cells; ++c) {
      const [x, y] = [-size / 2 + (size * c) / cells, -size / 2 + (size * r) / cells];
      positions.push(x, y, height(x, y));
    }
  for (let r = 0; r < cells; ++r)
    for (let c = 0; c < cells; ++c) {
      const a = r * (cells + 1) + c;
      indices.push(a, a + 1, a + cells + 2, a, a + cells + 2, a + cells + 1);
    }
  return { positions, indices };
}

/** Returns a mesh of the pack's world: `solids` is an array of [part, {positions, indices}]. */
function labelMesh(pack, label, solids, least, span) {
  const scale = span / 65535;
  const vertices = solids.reduce((sum, [, solid]) => sum + solid.positions.length / 3, 0);
  const positions = new Uint16Array(4 * vertices);
  const indices = new Uint32Array(solids.reduce((sum, [, solid]) => sum + solid.indices.length, 0));
  const parts = [];
  let [vertex, index] = [0, 0];
  for (const [part, solid] of solids) {
    parts.push([part, index / 3]);
    for (const corner of solid.indices) indices[index++] = vertex + corner;
    for (let at = 0; at < solid.positions.length; at += 3, ++vertex)
      for (let axis = 0; axis < 3; ++axis)
        positions[4 * vertex + axis] = Math.round((solid.positions[at + axis] - least[axis]) / scale);
  }
  return {
    label,
    positions: pack.array(positions, 'vertex', 4),
    offset: least,
    scale,
    indices: pack.array(indices, 'index'),
    parts,
  };
}

function robot(pack) {
  const solids = [
    box([-0.45, -0.3, 0.12], [0.45, 0.3, 0.35]),
    box([0.1, -0.12, 0.35], [0.34, 0.12, 0.5]),
    ...[
      [-0.3, -0.36],
      [-0.3, 0.28],
      [0.3, -0.36],
      [0.3, 0.28],
    ].map(([x, y]) => box([x - 0.16, y, 0], [x + 0.16, y + 0.08, 0.3])),
  ];
  const positions = new Float32Array(solids.flatMap((solid) => solid.positions));
  const indices = new Uint32Array(solids.flatMap((solid, at) => solid.indices.map((index) => index + 8 * at)));
  return {
    name: 'rover',
    bounds: { min: [-0.46, -0.36, 0], max: [0.46, 0.36, 0.5] },
    positions: pack.array(positions, 'plain', 3),
    indices: pack.array(indices, 'plain'),
  };
}

// The small world, relative to ORIGIN: a floor with a pool and a hill, a wall, a bridge, crates.
const POOL = { x: [3, 8], y: [3, 8] };
const inside = ([low, high], value, margin = 0) => value > low - margin && value < high + margin;
const WALL = { part: 1, x: [-0.2, 0.2], y: [1, 9], z: [-0.2, 2] };
const DECK = { x: [-8, -2], y: [-3, -1], z: [2.8, 3] };
const CRATES = [
  [-6, 5],
  [-4, 7],
  [6, -2],
  [2, -6],
  [-2, -8],
];
function floorHeight(x, y) {
  const pool = inside(POOL.x, x) && inside(POOL.y, y) ? -0.5 : 0;
  const hill = 2.2 * Math.exp(-((x - 6) ** 2 + (y + 7) ** 2) / 4);
  return pool + hill;
}

export const PARTS = [
  { name: 'floor', label: 'terrain', kind: 'mesh' },
  { name: 'wall', label: 'obstacle', kind: 'box' },
  { name: 'bridge deck', label: 'terrain', kind: 'box' },
  { name: 'pillar', label: 'obstacle', kind: 'box' },
  { name: 'pool', label: 'water', kind: 'plane' },
  { name: 'crates', label: 'obstacle', kind: 'mesh' },
];

function judge(x, y, level, turned) {
  const reach = turned ? 0.9 : 0.46;
  if (level === 1) {
    const edge = Math.min(x - DECK.x[0], DECK.x[1] - x, y - DECK.y[0], DECK.y[1] - y);
    return edge < 0.3 ? ['unstable', 0, 1, ['-0.12']] : ['valid', 0, 0, []];
  }
  if (Math.hypot(x, y) > 13) return ['outside', 0, 0, []];
  if (inside(POOL.x, x) && inside(POOL.y, y)) return ['submerged', 0, 2, ['0.6']];
  if (inside(WALL.x, x, reach) && inside(WALL.y, y, 0.4)) return ['collision', 2, 3, []];
  if (inside(POOL.x, x, reach) && inside(POOL.y, y, reach)) return ['unstable', 0, 1, ['-0.05']];
  if (CRATES.some(([cx, cy]) => Math.abs(cx - x) < 0.5 + reach && Math.abs(cy - y) < 0.9))
    return ['collision', 6, 4, []];
  if (DECK.x.some((end) => Math.hypot(x - end, y + 2) < 0.8)) return ['collision', 4, 5, []];
  const slope =
    Math.hypot(floorHeight(x + 0.1, y) - floorHeight(x - 0.1, y), floorHeight(x, y + 0.1) - floorHeight(x, y - 0.1)) /
    0.2;
  if (slope > 0.45) return ['steep', 0, 6, [`${Math.round((Math.atan(slope) * 180) / Math.PI)}`, '25']];
  return ['valid', 0, 0, []];
}

const REASONS = [
  '',
  'the margin is \u0001 m, the limit is 0.002 m (--min-stability)',
  'water stands \u0001 m above the ground, the limit is 0 m (--max-water-depth)',
  'collision with wall',
  'collision with crates',
  'collision with pillar',
  'the robot tilts by \u0001 degrees, the limit is \u0001 degrees (--max-slope)',
];

function smallLayer(pack, turned, every = 1) {
  const poses = [];
  for (let r = 0; r < COLUMNS; ++r)
    for (let c = 0; c < COLUMNS; ++c) {
      const [x, y] = [-SIZE / 2 + c * STEP, -SIZE / 2 + r * STEP];
      poses.push([r * COLUMNS + c, floorHeight(x, y), x, y, 0]);
      if (inside(DECK.x, x, 1e-9) && inside(DECK.y, y, 1e-9)) poses.push([r * COLUMNS + c, DECK.z[1], x, y, 1]);
    }
  const judged = poses.map(([, , x, y, level]) => judge(x, y, level, turned));
  const kept = judged.map(([name]) => (every > 1 && name === 'valid' ? 'steep' : name));
  const verdicts = kept.map(verdictIndex);
  const micro = (metres) => Math.round(metres * 1e6);
  const clearance = poses.map(([, , x, y, level], at) =>
    judged[at][0] !== 'valid'
      ? 65535
      : level === 1
        ? 900
        : Math.min(3000, Math.round(1000 * Math.max(0, Math.abs(x) - 0.6))),
  );
  const counts = VERDICTS.map((_, index) => verdicts.filter((verdict) => verdict === index).length);
  return {
    name: turned ? 'yaw 90' : 'yaw 0',
    stance: 'settled',
    yaw: turned ? Math.PI / 2 : 0,
    grid: { x0: ORIGIN[0] - SIZE / 2, y0: ORIGIN[1] - SIZE / 2, step: STEP, cols: COLUMNS, rows: COLUMNS },
    z0: ORIGIN[2],
    z_unit: 1e-6,
    count: poses.length,
    counts,
    cell: pack.array(new Uint32Array(poses.map(([cell]) => cell))),
    z: pack.array(new Int32Array(poses.map(([, height]) => micro(height + 0.02)))),
    ground: pack.array(
      new Int32Array(poses.map(([, height], at) => (judged[at][0] === 'outside' ? NONE : micro(height)))),
    ),
    verdict: pack.array(new Uint8Array(verdicts)),
    hit: pack.array(new Uint32Array(judged.map(([, hit]) => hit))),
    reason: pack.array(new Uint16Array(judged.map(([, , reason]) => reason))),
    reasons: REASONS,
    reason_numbers: pack.text(judged.flatMap(([, , , numbers]) => numbers.map((number) => `${number}\n`)).join('')),
    roll: pack.array(new Int16Array(poses.length)),
    pitch: pack.array(
      new Int16Array(
        poses.map(([, , x, y, level]) =>
          level === 1
            ? 0
            : Math.round((-Math.atan((floorHeight(x + 0.1, y) - floorHeight(x - 0.1, y)) / 0.2) / Math.PI) * 32767),
        ),
      ),
    ),
    island: pack.array(
      new Uint16Array(poses.map(([, , , , level], at) => (judged[at][0] !== 'valid' ? 0 : level + 1))),
    ),
    quantities: [
      { name: 'clearance', unit: 'm', scale: 0.001, offset: 0, values: pack.array(new Uint16Array(clearance)) },
    ],
  };
}

function spawns(pack, names) {
  const list = [
    ['gate', -0.3, 5, 0.02, 0.4, 'collision', 2, 'collision with wall', null, null],
    ['charger', -5, 3, 0.02, 0, 'valid', 0, '', 0.8, 0],
    [
      'lake',
      5,
      5,
      -0.48,
      1,
      'submerged',
      0,
      'water stands 0.6 m above the ground, the limit is 0 m (--max-water-depth)',
      null,
      null,
    ],
    ['deck', -5, -2, 3.02, 0, 'valid', 0, '', 0.5, 0],
    [
      'edge',
      -5,
      -1.1,
      3.02,
      0,
      'unstable',
      0,
      'the margin is -0.12 m, the limit is 0.002 m (--min-stability): the robot tips over',
      null,
      0.1,
    ],
    [
      'hill',
      7.5,
      -6,
      1.0,
      2,
      'steep',
      0,
      'the robot tilts by 33 degrees, the limit is 25 degrees (--max-slope)',
      null,
      0.57,
    ],
    ...Array.from({ length: 12 }, (_, at) => [
      `start ${at + 1}`,
      -9 + (at % 6) * 1.3,
      at < 6 ? -5 : -9,
      0.02,
      at * 0.5,
      'valid',
      0,
      '',
      0.3 + at * 0.1,
      0,
    ]),
  ].map((row, at) => (names?.[at] !== undefined ? [names[at], ...row.slice(1)] : row));
  const place = (x, y, z) => [ORIGIN[0] + x, ORIGIN[1] + y, ORIGIN[2] + z];
  return {
    file: 'starts.csv',
    columns: ['x', 'y', 'yaw', 'name'],
    rows: list.map(([name, x, y, , yaw]) => [`${ORIGIN[0] + x}`, `${ORIGIN[1] + y}`, `${yaw}`, name]),
    poses: list.map(([, x, y, z, yaw]) => [...place(x, y, z), 0, 0, yaw]),
    verdicts: list.map(([, , , , , verdict]) => verdictIndex(verdict)),
    hits: list.map(([, , , , , , hit]) => hit),
    reasons: list.map((row) => row[7]),
    tilt: list.map((row) => row[9]),
    margin: list.map((row) => (row[5] === 'valid' ? 0.25 : row[5] === 'unstable' ? -0.12 : null)),
    clearance: list.map((row) => row[8]),
    contacts: list.map(([, x, y, z, yaw, verdict]) =>
      verdict !== 'valid'
        ? []
        : [
            [-0.3, -0.3],
            [0.3, -0.3],
            [0.3, 0.3],
            [-0.3, 0.3],
          ].map(([a, b]) =>
            place(x + a * Math.cos(yaw) - b * Math.sin(yaw), y + a * Math.sin(yaw) + b * Math.cos(yaw), z - 0.02),
          ),
    ),
  };
}

const PAIRS = [
  {
    file: 'pairs.csv',
    pairs: [
      {
        name: 'across the bridge',
        start: [-7.5, -2, 3.02, 0, 0, 0],
        goal: [-2.5, -2, 3.02, 0, 0, 0],
        verdict: 'valid',
        reason: '',
        path: [
          [-7.5, -2, 3.02],
          [-5, -1.8, 3.02],
          [-2.5, -2, 3.02],
        ],
      },
      {
        name: 'through the wall',
        start: [-3, 5, 0.02, 0, 0, 0],
        goal: [2, 5, 0.02, 0, 0, 0],
        verdict: 'unreachable',
        reason: 'no way from start to goal; the shortest gap is at the wall',
        path: [],
      },
    ].map((pair) => ({ ...pair, start: moved(pair.start), goal: moved(pair.goal), path: pair.path.map(moved) })),
  },
];
function moved([x, y, z, ...angles]) {
  return [ORIGIN[0] + x, ORIGIN[1] + y, ORIGIN[2] + z, ...angles];
}

const CONTROLS = [
  {
    option: '--robot',
    name: 'Robot',
    type: 'choice',
    choices: ['rover.yaml', 'husky.yaml'],
    value: 'rover.yaml',
    group: 'Robot',
    help: 'Shape of the robot',
  },
  {
    option: '--step',
    name: 'Step of the raster',
    type: 'number',
    value: 0.5,
    unit: 'm',
    min: 0.1,
    max: 5,
    group: 'Robot',
    help: '',
  },
  {
    option: '--max-slope',
    name: 'Steepest slope',
    type: 'number',
    value: 25,
    unit: 'degrees',
    min: 0,
    max: 90,
    group: 'Limits',
    help: 'Largest tilt',
  },
  { option: '--level', name: 'Level stance', type: 'flag', value: false, group: 'Limits', help: '' },
  { option: '--region', name: 'Regions', type: 'regions', value: '', group: 'Place', help: '' },
  {
    option: '-n',
    name: 'Number of spawns',
    type: 'integer',
    value: 10,
    min: 1,
    max: 1000,
    group: 'Spawns',
    help: '',
    for: 'spawns',
  },
  { option: '--seed', name: 'Seed', type: 'integer', value: 1, group: 'Spawns', help: '', for: 'spawns' },
];

/** Returns the bytes of the small pack. `names` replace those of the first spawns; `live` adds live mode. */
export function smallPack({ names, partName, live } = {}) {
  const pack = createPack();
  const parts = PARTS.map((part, at) => (at === 1 && partName ? { ...part, name: partName } : part));
  const least = [-10, -10, -0.5];
  const obstacles = [
    [1, box([WALL.x[0], WALL.y[0], WALL.z[0]], [WALL.x[1], WALL.y[1], WALL.z[1]])],
    ...DECK.x.map((end) => [
      3,
      box([end - 0.3 * Math.sign(end + 5) - 0.2, -2.2, -0.2], [end - 0.3 * Math.sign(end + 5) + 0.2, -1.8, 2.8]),
    ]),
    ...CRATES.map(([x, y]) => [5, box([x - 0.5, y - 0.5, -0.2], [x + 0.5, y + 0.5, 0.8])]),
  ];
  const world = {
    triangles: 12000,
    share: 0.12,
    meshes: [
      labelMesh(
        pack,
        'terrain',
        [
          [0, heightfield(SIZE, 80, floorHeight)],
          [2, box([DECK.x[0], DECK.y[0], DECK.z[0]], [DECK.x[1], DECK.y[1], DECK.z[1]])],
        ],
        least,
        20,
      ),
      labelMesh(pack, 'obstacle', obstacles, least, 20),
      labelMesh(
        pack,
        'water',
        [[4, heightfield(5, 1, () => 0.1)]].map(([part, solid]) => [
          part,
          { ...solid, positions: solid.positions.map((value, at) => value + (at % 3 < 2 ? 5.5 : 0)) },
        ]),
        least,
        20,
      ),
    ],
  };
  return pack.bytes({
    format: 'spawnfield-review/1',
    program: 'spawnfield 0.3.0',
    title: 'training arena, rover',
    command: 'spawnfield review training --robot rover.yaml --spawns starts.csv --raster 0.5 -o review.html',
    map: {
      name: 'training',
      hash: '5d1c90e7a1b2c3d4',
      resolution: 0.05,
      bounds: {
        min: [ORIGIN[0] - 10, ORIGIN[1] - 10, ORIGIN[2] - 0.5],
        max: [ORIGIN[0] + 10, ORIGIN[1] + 10, ORIGIN[2] + 3],
      },
    },
    settings: { max_slope: 0.436, min_stability: 0.002, friction: 0.8, lift: 0.02 },
    origin: ORIGIN,
    verdicts: VERDICTS,
    parts,
    world,
    robot: robot(pack),
    floors: [
      { name: 'floor 1', height: ORIGIN[2], z: [null, ORIGIN[2] + 1.5] },
      { name: 'floor 2', height: ORIGIN[2] + 3, z: [ORIGIN[2] + 1.5, null] },
    ],
    islands: [
      { number: 0, area: 268.4, center: [ORIGIN[0], ORIGIN[1], ORIGIN[2]], z: [ORIGIN[2], ORIGIN[2] + 1] },
      { number: 1, area: 7.6, center: [ORIGIN[0] - 5, ORIGIN[1] - 2, ORIGIN[2] + 3], z: [ORIGIN[2] + 3, ORIGIN[2] + 3] },
    ],
    layers: [smallLayer(pack, false), smallLayer(pack, true)],
    spawns: [spawns(pack, names)],
    pairs: PAIRS,
    ...(live ? { live: { controls: CONTROLS, address: live } } : {}),
  });
}

/** Returns the bytes of an answer to POST layers: with a low limit of slope, no place is valid. */
export function layersAnswer(options) {
  const pack = createPack();
  const layer = smallLayer(pack, false, options['--max-slope'] < 10 ? 2 : 1);
  return pack.bytes({
    layers: [layer],
    robot: robot(pack),
    command: `spawnfield raster training --max-slope ${options['--max-slope']}`,
    seconds: 0.012,
  });
}

export function spawnsAnswer() {
  const pack = createPack();
  return pack.bytes({
    spawns: [{ ...spawns(pack), file: 'sample' }],
    command: 'spawnfield sample training -n 10 --seed 1',
    seconds: 0.004,
  });
}

/** Returns the bytes of a pack with about `triangles` triangles and `poses` poses. */
export function bigPack(triangles = 1e6, poses = 1e6) {
  const pack = createPack();
  const height = (x, y) =>
    12 * Math.sin(x / 61) * Math.cos(y / 47) +
    3 * Math.sin(x / 11 + y / 17) +
    0.4 * Math.sin(x / 2.3) * Math.sin(y / 1.9);
  const cells = Math.floor(Math.sqrt(triangles / 2));
  const side = Math.floor(Math.sqrt(poses));
  const step = 500 / side;
  const least = [-250, -250, -20];
  const [cell, z, ground, verdict, hit, reason, clearance, pitch, roll] = [
    Uint32Array,
    Int32Array,
    Int32Array,
    Uint8Array,
    Uint32Array,
    Uint16Array,
    Uint16Array,
    Int16Array,
    Int16Array,
  ].map((Type) => new Type(side * side));
  const numbers = [];
  for (let r = 0, pose = 0; r < side; ++r)
    for (let c = 0; c < side; ++c, ++pose) {
      const [x, y] = [-250 + c * step, -250 + r * step];
      const h = height(x, y);
      const slopeX = height(x + 0.5, y) - height(x - 0.5, y);
      const slopeY = height(x, y + 0.5) - height(x, y - 0.5);
      const slope = Math.hypot(slopeX, slopeY);
      cell[pose] = pose;
      ground[pose] = Math.round(h * 1e6);
      z[pose] = ground[pose] + 20000;
      pitch[pose] = Math.round((-Math.atan(slopeX) / Math.PI) * 32767);
      roll[pose] = Math.round((Math.atan(slopeY) / Math.PI) * 32767);
      verdict[pose] = h < -10 ? 4 : slope > 0.7 ? 6 : 0;
      reason[pose] = verdict[pose] === 6 ? 6 : verdict[pose] === 4 ? 2 : 0;
      if (verdict[pose] === 6) numbers.push(((Math.atan(slope) * 180) / Math.PI).toFixed(1), '35');
      if (verdict[pose] === 4) numbers.push((-10 - h).toFixed(3));
      clearance[pose] = verdict[pose] ? 65535 : Math.round(1000 * (1 + Math.sin(x / 30) * Math.cos(y / 30)));
    }
  return pack.bytes({
    format: 'spawnfield-review/1',
    program: 'spawnfield 0.3.0',
    title: 'large hills, rover',
    command: 'spawnfield review hills --robot rover.yaml -o review.html',
    map: { name: 'hills', hash: '0', resolution: 0.1, bounds: { min: [-250, -250, -20], max: [250, 250, 20] } },
    settings: {},
    origin: [0, 0, 0],
    verdicts: VERDICTS,
    parts: [{ name: 'hills', label: 'terrain', kind: 'mesh' }],
    world: {
      triangles: 2 * cells * cells,
      share: 1,
      meshes: [labelMesh(pack, 'terrain', [[0, heightfield(500, cells, height)]], least, 500)],
    },
    robot: robot(pack),
    floors: [],
    islands: [],
    spawns: [],
    pairs: [],
    layers: [
      {
        name: 'yaw 0',
        stance: 'settled',
        yaw: 0,
        grid: { x0: -250, y0: -250, step, cols: side, rows: side },
        z0: 0,
        z_unit: 1e-6,
        count: side * side,
        counts: VERDICTS.map((_, index) => verdict.reduce((sum, value) => sum + (value === index), 0)),
        cell: pack.array(cell),
        z: pack.array(z),
        ground: pack.array(ground),
        verdict: pack.array(verdict),
        hit: pack.array(hit),
        reason: pack.array(reason),
        reasons: REASONS,
        reason_numbers: pack.text(numbers.map((number) => `${number}\n`).join('')),
        roll: pack.array(roll),
        pitch: pack.array(pitch),
        quantities: [{ name: 'clearance', unit: 'm', scale: 0.001, offset: 0, values: pack.array(clearance) }],
      },
    ],
  });
}

/** Returns the built page with a pack (or with any bytes) in it. */
export function pageWith(bytes, shell = readFileSync(new URL('../../build/web/review.html', import.meta.url), 'utf8')) {
  return shell.replace(
    '<!--spawnfield-data-->',
    () =>
      `<script type="application/octet-stream" id="spawnfield-data">${Buffer.from(bytes).toString('base64')}</script>`,
  );
}

if (process.argv[1]?.endsWith('make_pack.mjs')) {
  const [, , kind, file] = process.argv;
  writeFileSync(file, pageWith(kind === 'big' ? bigPack() : smallPack()));
}
