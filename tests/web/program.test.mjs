// The page that the program itself writes and serves. SPAWNFIELD_PROGRAM is the program; without it these are skipped.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { clickAt, startBrowser, until } from './browser.mjs';

const program = process.env.SPAWNFIELD_PROGRAM;
const source = new URL('../../', import.meta.url).pathname;
const husky = join(source, 'maps/robots/husky.yaml');
const options = { skip: !program && 'SPAWNFIELD_PROGRAM is not set' };
let folder;
let browser;
let page;

/** Runs the program in the folder. Returns its standard output. */
function run(...words) {
  return execFileSync(program, [...words, '--quiet'], { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 26 });
}

/** Returns the rows of a CSV text as objects. No field of these files has quotes. */
function rows(text) {
  const [head, ...lines] = text.trim().split('\n').map((line) => line.split(','));
  return lines.map((fields) => Object.fromEntries(head.map((name, i) => [name, fields[i]])));
}

before(async () => {
  if (!program) return;
  folder = mkdtempSync(join(tmpdir(), 'spawnfield-review-'));
  run('bake', join(source, 'maps/training/scene.yaml'), '-o', 'map', '--resolution', '0.2');
  run('sample', 'map', '--robot', husky, '-n', '10', '--seed', '1', '-o', 'sampled.csv');
  const [head, ...lines] = readFileSync(join(folder, 'sampled.csv'), 'utf8').trim().split('\n');
  const columns = head.split(',').length;
  const refused = ['1.67', '-3.01', '0.5', ...Array(columns - 3).fill('0')].join(',');
  writeFileSync(join(folder, 'spawns.csv'), [head, ...lines, refused, ''].join('\n'));
  run('sample', 'map', '--robot', husky, '--pairs', '2', '--reach-step', '0.3', '-o', 'pairs.csv');
  run('review', 'map', '--robot', husky, '--spawns', 'spawns.csv', '--pairs', 'pairs.csv', '--reach-step', '0.3', '--raster',
      '0.1', '--headings', '2', '-o', 'review.html');
  browser = await startBrowser();
  page = await browser.open(readFileSync(join(folder, 'review.html'), 'utf8'));
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

test('a page of the program loads without errors and without the network', options, async () => {
  assert.deepEqual(page.faults, []);
  assert.deepEqual(page.requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
  assert.equal(await page.textContent('#title'), 'training, husky');
});

test('1,000 random places have the verdict, the reason and the part of check', options, async () => {
  let seed = 12345;
  const random = () => {
    seed = (seed * 1103515245 + 12345) % 2147483648;
    return seed / 2147483648;
  };
  const counts = await page.evaluate(() => [0, 1].map((layer) => {
    let low = 0;
    let high = 1 << 26;
    const exists = (pose) => {
      try {
        return Number.isFinite(window.spawnfield.answerAt(layer, pose).pose[0]);
      } catch {
        return false;
      }
    };
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (exists(middle)) low = middle;
      else high = middle;
    }
    return high;
  }));
  assert.ok(counts.every((count) => count > 30000), String(counts));
  const places = Array.from({ length: 1000 }, (_, i) => [i % 2, Math.floor(random() * counts[i % 2])]);
  const answers = await page.evaluate((all) => all.map(([layer, pose]) => window.spawnfield.answerAt(layer, pose)), places);
  writeFileSync(join(folder, 'places.csv'), ['x,y,z,yaw', ...answers.map(({ pose: [x, y, z, , , yaw] }) =>
    [x, y, z, yaw].join(',')), ''].join('\n'));
  const verdicts = JSON.parse(run('check', 'map', '--robot', husky, '--settle', '--poses', 'places.csv', '--format', 'json'));
  const seen = new Set();
  verdicts.poses.forEach((wanted, i) => {
    const shown = answers[i];
    seen.add(wanted.verdict);
    assert.equal(shown.verdictName, wanted.verdict, `place ${i}: ${shown.pose}`);
    assert.equal(shown.reason, wanted.reason ?? '', `place ${i}: ${shown.pose}`);
    assert.equal(shown.hit?.name ?? null, wanted.hit, `place ${i}: ${shown.pose}`);
    if (wanted.ground !== null) assert.ok(Math.abs(shown.ground - wanted.ground) <= 1e-6);
  });
  assert.ok(seen.size >= 5, [...seen].join(' '));
});

test('a click beside the thin wall names it, and one on open ground is valid', options, async () => {
  await page.evaluate(() => window.spawnfield.top());
  await until(page, () => !window.spawnfield.isFlying());
  const wanted = rows(run('check', 'map', '--robot', husky, '--settle', '--poses', 'places.csv'));
  const known = ({ x, y, ground }) => [Number(x), Number(y), Number(ground)];
  const blocked = wanted.find(({ hit }) => hit === 'wall_south');
  const answer = await clickAt(page, known(blocked));
  assert.equal(answer.hit.name, 'wall_south');
  assert.match(await page.textContent('#answer-reason'), /wall_south/);
  const open = wanted.find(({ verdict, x, y }) => verdict === 'valid' && Math.abs(x) < 3 && Math.abs(y) < 3);
  assert.equal((await clickAt(page, known(open))).verdictName, 'valid');
});

test('the refused spawn is the first of the list, with its reason', options, async () => {
  const first = await page.locator('#spawn-rows li').first().innerText();
  assert.match(first, /off terrain[\s\S]*the ground is large_ball/);
  assert.equal(await page.textContent('#refused-fact'), '1 of 11 spawns is not valid');
});

test('saved marks are read back by check and sample', options, async () => {
  const answer = await page.evaluate(() => {
    window.spawnfield.select(0, 0);
    return window.spawnfield.answer();
  });
  await page.fill('#note', 'too near, "really"');
  await page.click('[data-mark=bad]');
  await page.click('#tab-marks');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save-marks')]);
  await download.saveAs(join(folder, 'marks.csv'));
  const checked = run('check', 'map', '--robot', husky, '--settle', '--poses', 'marks.csv');
  assert.match(checked, /^x,y,z,roll,pitch,yaw,name,mark,note,verdict/);
  assert.match(checked, /bad,"too near, ""really""",valid/);
  run('sample', 'map', '--robot', husky, '-n', '5', '--avoid', 'marks.csv', '--avoid-distance', '3', '-o', 'apart.csv');
  for (const { x, y } of rows(readFileSync(join(folder, 'apart.csv'), 'utf8')))
    assert.ok(Math.hypot(x - answer.pose[0], y - answer.pose[1]) >= 2.99);
});

test('a served page shows another layer after a change, and a stranger is refused', options, async () => {
  const server = spawn(program, ['review', 'map', '--robot', husky, '--raster', '0.5', '--serve'], { cwd: folder });
  try {
    const address = await new Promise((resolve, reject) => {
      let text = '';
      server.stdout.on('data', (piece) => {
        text += piece;
        const found = text.match(/http:\S+/);
        if (found) resolve(found[0]);
      });
      server.on('exit', () => reject(new Error('the server ended')));
    });
    const live = await browser.open(address);
    assert.deepEqual(live.faults, []);
    const valid = async () => Number((await live.locator('#legend label:has([data-verdict=valid])').innerText())
      .replace(/\D/g, ''));
    const before = await valid();
    await live.evaluate(() => document.querySelectorAll('details').forEach((group) => { group.open = true; }));
    await live.fill('[data-option="--max-slope"]', '2');
    await until(live, () => window.spawnfield.runs().length === 1);
    assert.ok(await valid() < before);
    assert.match(await live.textContent('#live-command'), /^spawnfield review map --robot .*--max-slope 2/);
    await live.fill('[data-option="--max-slope"]', '89');
    await until(live, () => window.spawnfield.runs().length === 2);
    await live.fill('[data-option="--robot"]', 'nonsense');
    await until(live, () => !document.querySelector('#live-error').hidden);
    assert.match(await live.textContent('#live-error'), /needs box:LX,LY,LZ/);
    await live.fill('[data-option="--robot"]', 'box:0.3,0.3,0.3');
    await until(live, () => window.spawnfield.runs().length === 3);
    await live.click('#live-spawns');
    await until(live, () => window.spawnfield.runs().length === 4);
    assert.match(await live.textContent('#live-command'), /^spawnfield sample map .*-o spawns.csv$/);
    const stranger = await fetch(new URL('/', address));
    assert.equal(stranger.status, 403);
    const posted = await fetch(new URL('/layers', address), { method: 'POST', body: '{}' });
    assert.equal(posted.status, 403);
    assert.deepEqual(live.faults.filter((text) => !/400/.test(text)), []);
  } finally {
    server.kill('SIGTERM');
  }
});

test('heatmap --html shows the layer that was asked for, and the spawns', options, async () => {
  run('heatmap', 'map', '--robot', husky, '--quantity', 'clearance', '--spawns', 'spawns.csv', '--step', '0.5', '--html',
      '-o', 'heatmap.html');
  const shown = await browser.open(readFileSync(join(folder, 'heatmap.html'), 'utf8'));
  assert.equal(await shown.$eval('#color-by', (choice) => choice.selectedOptions[0].textContent), 'Clearance');
  assert.ok((await shown.locator('.row').count()) > 1);
  assert.deepEqual(shown.faults, []);
  await shown.done();
});

test('the report of an audit shows the page of each robot when it is opened, and runs no other script', options, async () => {
  run('audit', join(source, 'maps/training/scene.yaml'), '--resolution', '0.2', '--robot', husky, '--robot',
  'box:0.5,0.4,0.3', '--step', '0.5', '--html', '-o', 'audit.html');
  const text = readFileSync(join(folder, 'audit.html'), 'utf8');
  const report = await browser.open(text.replace('<body>', '<body><script>document.title = "run"</script>'), {
    failing: true,
  });
  assert.notEqual(await report.title(), 'run');
  assert.equal(report.faults.length, 1, report.faults.join('\n')); // the script above was refused
  assert.match(report.faults[0], /Content Security Policy/);
  assert.equal(await report.locator('iframe').count(), 2);
  await report.locator('summary').nth(1).click();
  const frame = report.frameLocator('iframe').nth(1);
  await frame.locator('#loading').waitFor({ state: 'detached' });
  assert.equal(await frame.locator('#title').textContent(), 'training, box:0.5,0.4,0.3');
  assert.equal(await frame.locator('#failure').count(), 0);
  const others = report.faults.slice(1).filter((fault) => !fault.includes('GL Driver Message'));
  assert.deepEqual(others, []);
  await report.done();
});
