// The page in a real browser, with the small world of make_pack.mjs.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { clickAt, colorAt, startBrowser, until } from './browser.mjs';
import { ORIGIN, pageWith, smallPack } from './make_pack.mjs';

const at = (x, y, z) => [ORIGIN[0] + x, ORIGIN[1] + y, ORIGIN[2] + z];
const SCREENSHOTS = new URL('../../build/web/screenshots/', import.meta.url).pathname;
const different = (a, b) => a.some((value, channel) => Math.abs(value - b[channel]) > 12);

let browser;
let page;
before(async () => {
  browser = await startBrowser();
  page = await browser.open(pageWith(smallPack()));
});
after(() => browser.close());

test('the page loads from a file without errors and without the network', async () => {
  assert.deepEqual(page.faults, []);
  assert.deepEqual(
    page.requests.filter((url) => !/^(file|data|blob):/.test(url)),
    [],
  );
  assert.equal(await page.textContent('#title'), 'training arena, rover');
  assert.equal(await page.textContent('#simplified'), 'World simplified to 12 %; verdicts are exact');
});

test('the first sight names refused spawns with their reasons', async () => {
  assert.equal(await page.textContent('#refused-fact'), '4 of 18 spawns are not valid');
  const rows = await page.locator('#spawn-rows li').allInnerTexts();
  assert.match(rows[0], /lake[\s\S]*submerged[\s\S]*water stands 0.6 m above the ground/);
  assert.match(rows[4], /charger[\s\S]*valid/);
  for (const id of ['#hint', '#legend', '#refused-fact', '#spawn-rows li:first-child'])
    assert.ok(await page.locator(id).isVisible(), id);
});

test('the legend counts each verdict', async () => {
  const layer = await page.locator('#legend label').allInnerTexts();
  const counts = Object.fromEntries(
    layer.map((line) => line.split('\n')).map(([name, count]) => [name, Number(count.replace(/\D/g, ''))]),
  );
  assert.equal(
    Object.values(counts).reduce((sum, count) => sum + count, 0),
    41 * 41 + 65,
  );
  assert.ok(counts.collision > 0 && counts.valid > 1000);
});

test('a click beside the wall answers collision, and names the wall', async () => {
  const answer = await clickAt(page, at(-0.5, 3, 0));
  assert.equal(answer.verdictName, 'collision');
  assert.equal(answer.hit.name, 'wall');
  assert.deepEqual(answer.pose.slice(0, 2), [ORIGIN[0] - 0.5, ORIGIN[1] + 3]);
  assert.equal(await page.textContent('#answer-verdict'), 'collision');
  assert.match(await page.textContent('#answer-hit'), /Hits wall \(obstacle\)/);
});

test('the part that was hit is highlighted, and shown by its button', async () => {
  const top = at(0, 8, 2);
  await page.keyboard.press('Escape');
  const plain = await colorAt(page, top);
  await clickAt(page, at(-0.5, 3, 0));
  const marked = await colorAt(page, top);
  assert.ok(different(plain, marked) && marked[0] > 150 && marked[2] < 100, `${plain} ${marked}`);
  await page.click('#answer-hit button');
  const target = await page.evaluate(() => window.spawnfield.target());
  assert.ok(Math.hypot(target[0] - ORIGIN[0], target[1] - (ORIGIN[1] + 5)) < 0.1, String(target));
  await page.locator('#canvas').focus();
  await page.keyboard.press('i');
});

test('the name of a part is shown under the pointer', async () => {
  const { x, y } = await page.evaluate((where) => window.spawnfield.project(where), at(0, 8, 1.9));
  const box = await page.locator('#canvas').boundingBox();
  await page.mouse.move(box.x + x, box.y + y + 4);
  await until(page, () => !document.getElementById('tooltip').hidden);
  assert.equal(await page.textContent('#tooltip'), 'wall (obstacle)');
});

test('a click on the deck answers for the deck, and one below it for the floor', async () => {
  const deck = await clickAt(page, at(-5, -2.5, 3));
  assert.equal(deck.island, 1);
  assert.equal(deck.ground, ORIGIN[2] + 3);
  const pool = await clickAt(page, at(6, 5, -0.5));
  assert.equal(pool.verdictName, 'submerged');
  assert.equal(pool.reason, 'water stands 0.6 m above the ground, the limit is 0 m (--max-water-depth)');
});

test('numbers of a reason belong to its pose', async () => {
  const answer = await clickAt(page, at(6, -5.5, 2.2 * Math.exp(-2.25 / 4)));
  assert.equal(answer.verdictName, 'steep');
  assert.match(answer.reason, /^the robot tilts by (2[5-9]|[345]\d) degrees, the limit is 25 degrees \(--max-slope\)$/);
});

test('the CSV row of an answer has the numbers of the pose', async () => {
  await clickAt(page, at(-0.5, 3, 0));
  const row = await page.evaluate(() => window.spawnfield.answerCsv());
  assert.match(row, /^499999\.5,4600003,100\.02,0,0,0,collision,100,wall$/);
});

test('the switch of each verdict changes the map where poses have it', async () => {
  await page.keyboard.press('Escape');
  await page.evaluate(() => window.spawnfield.top());
  const places = {
    valid: at(-4, -6.5, 0),
    submerged: at(5, 7, 0.1),
    collision: at(-0.5, 3, 0),
    steep: at(6, -6, 1.8),
    unstable: at(-3, -1, 3),
    outside: at(9.5, 9.5, 0),
  };
  for (const [verdict, place] of Object.entries(places)) {
    const on = await colorAt(page, place);
    await page.uncheck(`[data-verdict=${verdict}]`);
    const off = await colorAt(page, place);
    await page.check(`[data-verdict=${verdict}]`);
    const again = await colorAt(page, place);
    assert.ok(different(on, off), `${verdict}: ${on} ${off}`);
    assert.ok(!different(on, again), `${verdict}: ${on} ${again}`);
  }
});

test('patterns are drawn on the map and in the legend, and differ in greyscale', async () => {
  const swatches = () =>
    page.locator('#legend canvas').evaluateAll((all) =>
      all.map((canvas) => {
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
        const grey = (i) => 0.299 * data[i] + 0.587 * data[i + 1] + 0.114 * data[i + 2];
        const first = Array.from({ length: data.length / 4 }, (_, i) => grey(4 * i));
        const middle = (Math.min(...first) + Math.max(...first)) / 2;
        return Math.max(...first) - Math.min(...first) < 5
          ? 'plain'
          : first.map((value) => Number(value > middle)).join('');
      }),
    );
  assert.deepEqual([...new Set(await swatches())], ['plain']);
  const before = await page.locator('#map').screenshot();
  await page.check('#patterns');
  const made = await swatches();
  assert.equal(new Set(made).size, made.length);
  await page.waitForTimeout(100);
  assert.notDeepEqual(await page.locator('#map').screenshot(), before);
  await page.uncheck('#patterns');
});

test('the slider of headings changes the layer', async () => {
  const before = await page.locator('#legend').innerText();
  await page.fill('#heading', '1');
  assert.notEqual(await page.locator('#legend').innerText(), before);
  const answer = await page.evaluate(() => window.spawnfield.answerAt(1, 0));
  assert.equal(answer.pose[5], Math.PI / 2);
  await page.fill('#heading', '0');
  await page.evaluate(() => window.spawnfield.top());
  await clickAt(page, at(-1, 4, 0));
  assert.equal(await page.textContent('#answer-verdict'), 'valid');
  await page.fill('#heading', '1');
  assert.equal(await page.textContent('#answer-verdict'), 'collision');
  await page.fill('#heading', '0');
  assert.equal(await page.locator('#legend').innerText(), before);
});

test('quantities have colours and a scale with units', async () => {
  const place = at(-8, 4, 0);
  const verdict = await colorAt(page, place);
  await page.selectOption('#color-by', { label: 'Clearance' });
  assert.ok(different(await colorAt(page, place), verdict));
  assert.match(await page.locator('.ticks').innerText(), /0 m[\s\S]*3 m/);
  assert.match(await page.locator('.ticks + .check').innerText(), /^without a value/);
  await page.selectOption('#color-by', { label: 'Island' });
  assert.ok(different(await colorAt(page, place), verdict));
  await page.selectOption('#color-by', { label: 'Height of the ground' });
  await page.selectOption('#color-by', { label: 'Verdict' });
  assert.ok(!different(await colorAt(page, place), verdict));
});

test('the cut hides the upper floor, for the eye and for clicks', async () => {
  const place = at(-5, -2.5, 3);
  const deck = await page.evaluate((where) => {
    const { x, y } = window.spawnfield.project(where);
    return window.spawnfield.pick(x, y);
  }, place);
  assert.equal(deck.ground, ORIGIN[2] + 3);
  await page.click('#settings button:has-text("floor 1")');
  const below = await page.evaluate((where) => {
    const { x, y } = window.spawnfield.project(where);
    return window.spawnfield.pick(x, y);
  }, place);
  assert.equal(below.ground, ORIGIN[2]);
  await page.click('#settings button:has-text("All")');
});

test('the cut leaves the markers of spawns on the floor', async () => {
  const marker = at(-0.3, 5, 0.02 + 0.5 + 0.3 * 0.581); // above the spawn "gate"; its cross is white
  await page.evaluate(() => window.spawnfield.top());
  for (const floor of ['All', 'floor 1']) {
    await page.click(`#settings button:has-text("${floor}")`);
    const color = await colorAt(page, marker);
    assert.ok(!different(color, [255, 255, 255]), `${floor}: ${color}`);
  }
  await page.click('#settings button:has-text("All")');
});

test('an answer says so if its ground is far from the place of the click', async () => {
  await page.locator('#canvas').focus();
  await page.keyboard.press('i');
  const answer = await clickAt(page, at(0, 8, 2)); // the top of the wall; the ground is that below it
  assert.equal(answer.ground, ORIGIN[2]);
  assert.equal(
    await page.textContent('#answer-remark'),
    'The place that you clicked is 2 m above the nearest ground, which is judged here.',
  );
  await clickAt(page, at(-1, 4, 0));
  assert.equal(await page.locator('#answer-remark').count(), 0);
});

test('keys change view and floor', async () => {
  await page.locator('#canvas').focus();
  await page.keyboard.press('i');
  assert.equal(await page.getAttribute('#toolbar button:has-text("Isometric")', 'aria-pressed'), 'true');
  await page.keyboard.press('2');
  assert.equal(await page.getAttribute('#settings button:has-text("floor 2")', 'aria-pressed'), 'true');
  await page.keyboard.press('0');
  const target = await page.evaluate(() => window.spawnfield.target());
  await page.keyboard.press('ArrowRight');
  assert.notDeepEqual(await page.evaluate(() => window.spawnfield.target()), target);
  await page.keyboard.press('?');
  assert.ok(await page.locator('#help-dialog').isVisible());
  await page.keyboard.press('Escape');
  assert.ok(!(await page.locator('#help-dialog').isVisible()));
});

test('a click in the sorted list flies to the spawn', async () => {
  await page.selectOption('#spawn-order', 'name');
  const first = page.locator('#spawn-rows button').first();
  assert.match(await first.innerText(), /charger/);
  await first.click();
  const target = await page.evaluate(() => window.spawnfield.target());
  assert.ok(Math.hypot(target[0] - (ORIGIN[0] - 5), target[1] - (ORIGIN[1] + 3)) < 0.1, String(target));
  await page.selectOption('#spawn-order', 'verdict');
  await page.check('#only-refused');
  assert.equal(await page.locator('#spawn-rows [data-spawn]').count(), 4);
  await page.uncheck('#only-refused');
});

test('a click on a robot selects its spawn', async () => {
  await page.evaluate(() => window.spawnfield.top());
  const answer = await clickAt(page, at(-5, 3, 0.3));
  assert.equal(answer.name, 'charger');
  assert.equal(answer.contacts.length, 4);
});

test('pairs are listed, and a click shows one', async () => {
  await page.click('#tab-pairs');
  await page.click('[data-pair="1"]');
  assert.match(await page.textContent('#answer'), /through the wall: unreachable. no way from start to goal/);
  await page.click('#tab-spawns');
});

test('distances are measured', async () => {
  await page.evaluate(() => window.spawnfield.top());
  await page.click('#toolbar button:has-text("Measure")');
  const box = await page.locator('#canvas').boundingBox();
  for (const place of [at(-4, -5, 0), at(0, -5, 0)]) {
    const { x, y } = await page.evaluate((where) => window.spawnfield.project(where), place);
    await page.mouse.click(box.x + x, box.y + y);
    await page.waitForTimeout(150);
  }
  const [metres] = (await page.textContent('#measure-label')).match(/[\d.]+/);
  assert.ok(Math.abs(Number(metres) - 4) < 0.1, metres);
  await page.keyboard.press('Escape');
  assert.ok(!(await page.locator('#measure-label').isVisible()));
});

test('marks are saved as CSV that spawnfield reads', async () => {
  await page.click('[data-spawn="4"]');
  await page.fill('#note', 'too near, "really"');
  await page.click('[data-mark=bad]');
  await page.evaluate(() => window.spawnfield.top());
  await clickAt(page, at(-0.5, 3, 0));
  await page.click('[data-mark=good]');
  await page.click('#tab-marks');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save-marks')]);
  assert.equal(download.suggestedFilename(), 'marks.csv');
  assert.equal(
    readFileSync(await download.path(), 'utf8'),
    'x,y,z,roll,pitch,yaw,name,mark,note\n499995,4599998.9,103.02,0,0,0,edge,bad,"too near, ""really"""\n' +
      '499999.5,4600003,100.02,0,0,0,mark 2,good,\n',
  );
  await page.click('#tab-spawns');
});

test('a pose has one mark, which its answer shows; the same button takes it away', async () => {
  await page.click('[data-spawn="4"]');
  assert.equal(await page.getAttribute('[data-mark=bad]', 'aria-pressed'), 'true');
  assert.equal(await page.inputValue('#note'), 'too near, "really"');
  assert.equal(await page.textContent('#tab-marks'), 'Marks (2)');
  await page.click('[data-mark=good]');
  assert.equal(await page.getAttribute('[data-mark=bad]', 'aria-pressed'), 'false');
  assert.equal(await page.textContent('#tab-marks'), 'Marks (2)');
  await page.click('[data-mark=good]');
  assert.equal(await page.getAttribute('[data-mark=good]', 'aria-pressed'), 'false');
  assert.equal(await page.textContent('#tab-marks'), 'Marks (1)');
});

test('light and dark are switched, on the map, too', async () => {
  const corner = () => page.evaluate(() => window.spawnfield.pixelAt(3, 300));
  await page.keyboard.press('Escape');
  await page.locator('#canvas').focus();
  await page.keyboard.press('i');
  const light = await corner();
  await page.click('#theme');
  const dark = await corner();
  assert.ok(light[0] > 200 && dark[0] < 40, `${light} ${dark}`);
  await page.click('#theme');
});

test('on a phone, the sheet with the colours stays while the heading is moved', async () => {
  const phone = await browser.open(pageWith(smallPack()), { width: 390, height: 844, touch: true });
  const { x, y } = await phone.evaluate((where) => window.spawnfield.project(where), at(-1, 4, 0));
  const box = await phone.locator('#canvas').boundingBox();
  await phone.touchscreen.tap(box.x + x, box.y + y);
  await until(phone, () => window.spawnfield.answer() !== null);
  await phone.click('#sheet-tabs [data-panel=settings]');
  await phone.fill('#heading', '1');
  assert.ok(await phone.locator('#heading').isVisible());
  assert.equal(await phone.evaluate(() => window.spawnfield.answer().pose[5]), Math.PI / 2);
  assert.deepEqual(phone.faults, []);
  await phone.done();
});

test('nothing of all this wrote an error', () => assert.deepEqual(page.faults, []));

test('hostile names remain text', async () => {
  const names = [
    '<img src=x onerror=alert(1)>',
    `long ${'x'.repeat(5000)}`,
    'bell\u0007 and \u202eturned',
    '</script><script>alert(1)</script>',
  ];
  const hostile = await browser.open(pageWith(smallPack({ names, partName: '<b onmouseover=alert(1)>wall</b>' })));
  hostile.on('dialog', () => assert.fail('a script of a name ran'));
  const shown = await hostile.locator('#spawn-rows .name').allInnerTexts();
  for (const name of [names[0], names[1], 'bell\ufffd and \ufffdturned', names[3]])
    assert.ok(shown.includes(name), name.slice(0, 60));
  assert.equal(await hostile.locator('#spawn-rows img, #spawn-rows script').count(), 0);
  const row = await hostile.locator('#spawn-rows li').first().boundingBox();
  assert.ok(row.width < 400 && row.height < 120);
  await clickAt(hostile, at(-0.5, 3, 0));
  assert.match(await hostile.textContent('#answer-hit'), /<b onmouseover=alert\(1\)>wall<\/b>/);
  assert.equal(await hostile.locator('#answer b').count(), 0);
  assert.deepEqual(hostile.faults, []);
  await hostile.done();
});

test('a damaged page says so', async () => {
  const whole = smallPack();
  const flipped = Buffer.from(whole);
  flipped[whole.length - 3000] ^= 0xff;
  const cases = [
    [whole.subarray(0, 5), /SPAWNRV1/],
    [whole.subarray(0, 500), /ends within its description/],
    [whole.subarray(0, whole.length - 2000), /damaged or incomplete/],
    [flipped, /damaged/],
    [Buffer.from('no pack at all'), /SPAWNRV1/],
  ];
  for (const [bytes, message] of cases) {
    const damaged = await browser.open(pageWith(bytes), { failing: true });
    await damaged.waitForSelector('#failure');
    assert.match(await damaged.textContent('#failure'), message);
    await damaged.done();
  }
  const empty = await browser.open(readFileSync(new URL('../../build/web/review.html', import.meta.url), 'utf8'), {
    failing: true,
  });
  await empty.waitForSelector('#failure');
  assert.match(await empty.textContent('#failure'), /has no data/);
  await empty.done();
});

test('screenshots of the page on screens of all sizes', async () => {
  for (const [name, options] of Object.entries({
    desktop: { width: 1920, height: 1080 },
    laptop: { width: 1280, height: 720 },
    dark: { width: 1280, height: 720, dark: true },
    phone: { width: 390, height: 844, touch: true },
    phone_dark: { width: 390, height: 844, touch: true, dark: true },
  })) {
    const shown = await browser.open(pageWith(smallPack()), options);
    if (name === 'dark') await shown.check('#patterns');
    await shown.screenshot({ path: `${SCREENSHOTS}${name}.png` });
    await shown.locator('[data-spawn="0"]').click();
    await shown.waitForTimeout(200);
    await shown.screenshot({ path: `${SCREENSHOTS}${name}_answer.png` });
    assert.ok(
      await shown.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth),
      `${name} is too wide`,
    );
    await shown.done();
  }
});
