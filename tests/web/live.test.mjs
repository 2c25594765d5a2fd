// Live mode, against a server that plays the program.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { after, before, test } from 'node:test';
import { clickAt, startBrowser, until } from './browser.mjs';
import { layersAnswer, ORIGIN, pageWith, smallPack, spawnsAnswer } from './make_pack.mjs';

const ADDRESS = '/token/';
const program = { asked: [], running: 0, mostRunning: 0, delay: 0, html: pageWith(smallPack({ live: ADDRESS })) };

function answer(kind, body) {
  if (kind === 'pose')
    return JSON.stringify({ verdict: 'collision', reason: 'collision with wall, said by the program' });
  const options = body;
  if (options['--max-slope'] === 77) return null;
  return kind === 'layers' ? layersAnswer(options) : spawnsAnswer();
}

const server = createServer(async (request, response) => {
  if (request.method === 'GET') {
    response.setHeader('Content-Type', 'text/html; charset=utf-8');
    response.end(program.html);
    return;
  }
  program.mostRunning = Math.max(program.mostRunning, ++program.running);
  const chunks = [];
  for await (const chunk of request) chunks.push(chunk);
  const body = JSON.parse(Buffer.concat(chunks).toString());
  const kind = request.url.slice(ADDRESS.length);
  program.asked.push({ kind, body });
  await new Promise((later) => setTimeout(later, program.delay));
  const content = answer(kind, body);
  --program.running;
  response.statusCode = content === null ? 400 : 200;
  response.end(
    content ?? JSON.stringify({ message: '--max-slope is 77, needs 0 to 60 degrees; give a smaller angle <b>' }),
  );
});

let browser;
let page;
before(async () => {
  await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
  browser = await startBrowser();
  page = await browser.open(`http://127.0.0.1:${server.address().port}${ADDRESS}`);
});
after(async () => {
  await browser.close();
  server.closeAllConnections?.();
  server.close();
});

const runs = () =>
  page.evaluate(() =>
    window.spawnfield.runs().map(({ counts, changes }) => ({ counts: Object.fromEntries(counts), changes })),
  );
const legend = () => page.locator('#legend').innerText();

test('a change of a setting runs the query and shows the new layer', async () => {
  const before = await legend();
  await page.fill('[data-option="--max-slope"]', '5');
  await until(page, () => window.spawnfield.runs().length === 1);
  assert.notEqual(await legend(), before);
  assert.doesNotMatch(await legend(), /valid/);
  const [run] = await runs();
  assert.equal(run.changes, 'Steepest slope: 5');
  assert.ok(run.counts.steep > 1000);
  assert.equal(await page.textContent('#live-command'), 'spawnfield raster training --max-slope 5');
  assert.equal(program.asked[0].body['--max-slope'], 5);
  assert.equal(program.asked[0].body['--step'], 0.5);
  await page.screenshot({ path: new URL('../../build/web/screenshots/live.png', import.meta.url).pathname });
});

test('one request runs at a time, and later changes replace waiting ones', async () => {
  program.delay = 1200;
  const before = program.asked.length;
  for (const degrees of ['30', '31', '32']) {
    await page.fill('[data-option="--max-slope"]', degrees);
    await page.waitForTimeout(220);
  }
  await until(page, () => window.spawnfield.runs().at(-1).options['--max-slope'] === 32);
  program.delay = 0;
  const asked = program.asked.slice(before).map(({ body }) => body['--max-slope']);
  assert.equal(program.mostRunning, 1);
  assert.deepEqual(asked, [30, 32]);
});

test('an error is shown in full, and the layer stays', async () => {
  const before = await legend();
  await page.fill('[data-option="--max-slope"]', '77');
  await page.waitForSelector('#live-error:not([hidden])');
  assert.equal(
    await page.textContent('#live-error'),
    '--max-slope is 77, needs 0 to 60 degrees; give a smaller angle <b>',
  );
  assert.equal(await legend(), before);
  await page.fill('[data-option="--max-slope"]', '20');
  await until(page, () => document.getElementById('live-error').hidden);
});

test('runs can be repeated and saved', async () => {
  const count = (await runs()).length;
  await page.locator('#live-runs tr').last().locator('button').click();
  await until(page, (before) => window.spawnfield.runs().length === before + 1, count);
  assert.equal(await page.inputValue('[data-option="--max-slope"]'), '5');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('text=Save runs as CSV')]);
  assert.equal(download.suggestedFilename(), 'runs.csv');
});

test('spawns are sampled with seed and number', async () => {
  await page.click('#live-spawns');
  await until(page, () => window.spawnfield.runs().at(-1).kind === 'spawns');
  assert.equal(program.asked.at(-1).body['--seed'], 1);
  await page.click('#tab-live');
  await page.fill('[data-option="--seed"]', '2');
  await until(page, () => window.spawnfield.runs().at(-1).options['--seed'] === 2);
  assert.equal(program.asked.at(-1).kind, 'spawns');
});

test('a click also asks the program', async () => {
  await page.evaluate(() => window.spawnfield.top());
  await clickAt(page, [ORIGIN[0] - 0.5, ORIGIN[1] + 3, ORIGIN[2]]);
  await page.waitForSelector('#program-answer h3');
  assert.match(await page.textContent('#program-answer'), /collision with wall, said by the program/);
  assert.deepEqual(program.asked.at(-1).body.pose.slice(0, 2), [ORIGIN[0] - 0.5, ORIGIN[1] + 3]);
});

test('a region drawn on the map is sent', async () => {
  await page.click('#tab-live');
  await page.evaluate(() => window.spawnfield.top());
  await page.click('[data-option="--region"]');
  const box = await page.locator('#canvas').boundingBox();
  for (const [x, y] of [
    [-4, -6],
    [2, -5],
    [-1, -1],
  ]) {
    const at = await page.evaluate(
      (place) => window.spawnfield.project(place),
      [ORIGIN[0] + x, ORIGIN[1] + y, ORIGIN[2]],
    );
    await page.mouse.click(box.x + at.x, box.y + at.y);
    await page.waitForTimeout(120);
  }
  await page.locator('#canvas').focus();
  await page.keyboard.press('Enter');
  await until(page, () => Boolean(window.spawnfield.runs().at(-1).options['--region']));
  const region = JSON.parse(program.asked.at(-1).body['--region'] ?? program.asked.at(-2).body['--region']);
  assert.equal(region.type, 'Polygon');
  assert.equal(region.coordinates[0].length, 4);
  assert.ok(Math.abs(region.coordinates[0][0][0] - (ORIGIN[0] - 4)) < 0.2);
});

test('nothing is asked from other servers, and nothing wrote an error', () => {
  const other = page.requests.filter(
    (url) => !url.startsWith(`http://127.0.0.1:${server.address().port}/`) && !/^(data|blob):/.test(url),
  );
  assert.deepEqual(other, []);
  assert.deepEqual(
    page.faults.filter((fault) => !/status of 400/.test(fault)),
    [],
  );
});
