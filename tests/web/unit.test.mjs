// Parts of the page that need no browser.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { createPack } from './encode.mjs';
import { esbuild } from './libraries.mjs';
import { smallPack, verdictIndex } from './make_pack.mjs';

let parts;
before(async () => {
  const names = [
    'pack',
    'layer_data',
    'csv',
    'numbers',
    'marks',
    'measure',
    'regions',
    'spawn_list',
    'selection',
    'live',
    'palette',
    'floors',
  ];
  const {
    outputFiles: [script],
  } = await esbuild.build({
    stdin: {
      contents: names.map((name) => `export * from './src/${name}.js';`).join('\n'),
      resolveDir: new URL('../../web', import.meta.url).pathname,
    },
    bundle: true,
    write: false,
    format: 'esm',
    logLevel: 'warning',
  });
  parts = await import(`data:text/javascript;base64,${Buffer.from(script.contents).toString('base64')}`);
});

const throwsPackErrorOnly = async (read) => {
  try {
    await read();
  } catch (error) {
    if (!(error instanceof parts.PackError)) throw error;
  }
};

async function readAll(bytes) {
  const pack = await parts.readPack(bytes);
  const { layers, world, robot } = pack.json;
  for (const { positions, indices } of [...world.meshes, robot]) {
    pack.array(positions);
    pack.array(indices);
  }
  for (const layer of layers)
    for (const value of Object.values(layer)) if (value?.coding && value.type !== 'text') pack.array(value);
  return pack;
}

test('arrays of all types and codings are read back', async () => {
  const made = createPack();
  const values = [
    new Uint8Array([0, 255, 3, 3, 128]),
    new Uint16Array([65535, 0, 40000, 1]),
    new Uint32Array([4294967295, 0, 2147483648, 7]),
    new Int16Array([-32768, 32767, 0, -1]),
    new Int32Array([-2147483648, 2147483647, 0, -5]),
  ];
  const described = values.map((array) => made.array(array));
  const floats = new Float32Array([1.5, -2.25, 1e30]);
  const plain = made.array(floats, 'plain', 3);
  const triangles = made.array(new Uint32Array([0, 1, 2, 2, 1, 3, 3, 1, 4]), 'index');
  const vertices = made.array(
    new Uint16Array(4 * 50).map((_, at) => at * 37),
    'vertex',
    4,
  );
  const text = made.text('Müller\n\u0001');
  const pack = await parts.readPack(made.bytes({ format: 'spawnfield-review/1' }));
  values.forEach((array, at) => assert.deepEqual(pack.array(described[at]), array));
  assert.deepEqual(pack.array(plain), floats);
  assert.equal(pack.array(triangles).length, 9);
  assert.deepEqual(
    pack.array(vertices),
    new Uint16Array(4 * 50).map((_, at) => at * 37),
  );
  assert.equal(pack.text(text), 'Müller\n\u0001');
});

test('each prefix of a pack is refused with a message', async () => {
  const whole = smallPack();
  for (let end = 0; end < whole.length; end += end < 64 ? 1 : 997)
    await assert.rejects(readAll(whole.subarray(0, end)), parts.PackError, `prefix of ${end} bytes`);
});

test('changed bytes in blocks are noticed, or do no harm', async () => {
  const whole = smallPack();
  const blocks = 12 + whole.readUInt32LE(8);
  for (let at = blocks; at < whole.length; at += 331) {
    const changed = Buffer.from(whole);
    changed[at] ^= 0x5a;
    await throwsPackErrorOnly(() => readAll(changed));
  }
});

test('an array that claims to be huge is refused', async () => {
  const pack = await parts.readPack(createPack().bytes({}));
  for (const coding of ['plain', 'delta', 'vertex', 'index'])
    assert.throws(() => pack.array({ type: 'u32', count: 1e12, width: 1, coding, at: 0, bytes: 8 }), parts.PackError);
});

test('poses, reasons and quantities of a layer are those that were stored', async () => {
  const pack = await parts.readPack(smallPack());
  const layer = parts.readLayer(pack, pack.json.layers[0]);
  const steep = layer.verdict.lastIndexOf(verdictIndex('steep'));
  assert.match(layer.reasonOf(steep), /^the robot tilts by \d+ degrees, the limit is 25 degrees/);
  const { x, y, z } = parts.poseNumbers(layer, 0);
  assert.deepEqual([x, y, z], [499990, 4599990, 100.02]);
  const deck = parts.nearestPose(layer, 499995, 4599998, 102);
  assert.equal(parts.drawnHeight(layer, deck), 103);
  const floor = parts.nearestPose(layer, 499995, 4599998, 101);
  assert.equal(parts.drawnHeight(layer, floor), 100);
  assert.equal(parts.nearestPose(layer, 499995, 4599998, 103, 101), floor);
  assert.equal(parts.nearestPose(layer, 400000, 4599998, 103), -1);
  assert.ok(parts.nearestPose(layer, 499990 - 1.2, 4599998, 100) >= 0, 'a place beside the raster has a pose near it');
});

test('fields of CSV are quoted where spawnfield needs it', () => {
  assert.equal(
    parts.row([0.1 + 0.2, 'a,b', 'say "x"', null, ' edge', 'two\nlines']),
    '0.30000000000000004,"a,b","say ""x""",," edge",two lines',
  );
  assert.equal(parts.marksCsv([]), 'x,y,z,roll,pitch,yaw,name,mark,note\n');
});

test('numbers for people', () => {
  assert.equal(parts.withUnit(Math.PI / 6, 'rad'), '30°');
  assert.equal(parts.withUnit(null, 'm'), 'none');
  assert.equal(parts.percent(0.12), '12 %');
  assert.equal(parts.percent(0.0004), 'less than 1 %');
  assert.equal(parts.percent(0.999), '99 %');
  assert.equal(parts.niceBelow(0.37), 0.2);
  assert.equal(parts.distanceText([0, 0, 0], [3, 4, -12]), '13 m\nseen from above 5 m, height −12 m');
});

test('the list is sorted, and poses without a value come last', () => {
  const list = {
    columns: ['name'],
    rows: [['b'], ['a10'], ['a9']],
    poses: [0, 0, 0],
    verdicts: [0, 5, 0],
    clearance: [2, null, 1],
  };
  const isValid = (verdict) => verdict === 0;
  assert.deepEqual(parts.sortedPoses(list, 'verdict', isValid), [1, 0, 2]);
  assert.deepEqual(parts.sortedPoses(list, 'name', isValid), [2, 1, 0]);
  assert.deepEqual(parts.sortedPoses(list, 'clearance', isValid), [2, 0, 1]);
});

test('the support polygon is the convex hull', () => {
  const hull = parts.convexHull([
    [0, 0, 1],
    [2, 0, 1],
    [1, 0.5, 1],
    [2, 2, 1],
    [0, 2, 1],
    [1, 1, 1],
  ]);
  assert.deepEqual(
    hull.map(([x, y]) => [x, y]),
    [
      [0, 0],
      [2, 0],
      [2, 2],
      [0, 2],
    ],
  );
});

test('regions are GeoJSON, there and back', () => {
  const square = [
    [0, 0, 5],
    [1, 0, 5],
    [1, 1, 5],
  ];
  assert.equal(parts.regionsText([]), '');
  assert.equal(parts.regionsText([square]), '{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}');
  assert.deepEqual(parts.regionsFromText(parts.regionsText([square, square]), 5), [square, square]);
});

test('one request runs at a time, and the last one of a kind wins', async () => {
  const sent = [];
  let release;
  const ask = parts.createQueue(
    (kind, body) =>
      new Promise((done) => {
        sent.push([kind, body]);
        release = done;
      }),
  );
  ask('layers', 1);
  ask('layers', 2);
  ask('spawns', 3);
  ask('layers', 4);
  assert.deepEqual(sent, [['layers', 1]]);
  for (let i = 0; i < 3; ++i) {
    release();
    await new Promise((later) => setTimeout(later));
  }
  assert.deepEqual(sent, [
    ['layers', 1],
    ['layers', 4],
    ['spawns', 3],
  ]);
});

test('a floor is cut above its robots and below the next floor', () => {
  const floors = [
    { height: 0, z: [null, 1.5] },
    { height: 3, z: [1.5, null] },
  ];
  assert.equal(parts.cutAbove(floors, 0, 1), 1.3);
  assert.ok(parts.cutAbove(floors, 0, 5) < 3);
  assert.ok(Math.abs(parts.cutAbove(floors, 1, 1) - 4.3) < 1e-12);
});

test('patterns of ten verdicts differ', () => {
  const verdicts = Array.from({ length: 10 }, (_, at) => ({ name: at === 0 ? 'valid' : `other${at}` }));
  assert.equal(new Set(parts.verdictPatterns(verdicts).map(String)).size, 10);
});
