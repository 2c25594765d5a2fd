// A headless Chromium for tests: pages from file:// and from a server, with what they wrote and asked for.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium } from './libraries.mjs';

const FLAGS = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

/** Returns {open(html or address, options), close()}. */
export async function startBrowser() {
  const folder = mkdtempSync(join(tmpdir(), 'spawnfield-web-'));
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || '/usr/bin/chromium', args: FLAGS });
  let number = 0;
  return {
    /** Opens a page. Waits until it is ready unless `failing` is set. Returns it with its `faults` and `requests`. */
    async open(content, { width = 1280, height = 720, dark = false, failing = false, touch = false } = {}) {
      const context = await browser.newContext({
        viewport: { width, height },
        colorScheme: dark ? 'dark' : 'light',
        reducedMotion: 'reduce',
        hasTouch: touch,
        acceptDownloads: true,
      });
      const page = await context.newPage();
      page.setDefaultTimeout(60000);
      page.faults = [];
      page.requests = [];
      page.on('console', (message) => {
        if (message.type() !== 'log') page.faults.push(message.text());
      });
      page.on('pageerror', (error) => page.faults.push(String(error)));
      page.on('request', (request) => page.requests.push(request.url()));
      let address = content;
      if (!content.startsWith('http')) {
        const file = join(folder, `page${number++}.html`);
        writeFileSync(file, content);
        address = `file://${file}`;
      }
      await page.goto(address);
      if (!failing) await page.evaluate(() => window.spawnfield.ready.then(() => window.spawnfield.pickingReady));
      page.done = () => context.close();
      return page;
    },
    async close() {
      await browser.close();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}

/** Returns the answer of a click with the mouse at a place of the scene. */
export async function clickAt(page, place) {
  const at = await page.evaluate((where) => window.spawnfield.project(where), place);
  const box = await page.locator('#canvas').boundingBox();
  await page.evaluate(() => {
    window.answerBefore = window.spawnfield.answer();
  });
  await page.mouse.click(box.x + at.x, box.y + at.y);
  await until(page, () => window.spawnfield.answer() !== window.answerBefore);
  return page.evaluate(() => window.spawnfield.answer());
}

/** Waits until a function of the page returns true. Playwright's waitForFunction needs eval, which the page forbids. */
export async function until(page, isTrue, argument) {
  for (let tries = 0; tries < 400; ++tries) {
    if (await page.evaluate(isTrue, argument)) return;
    await page.waitForTimeout(25);
  }
  throw new Error(`not true after 10 s: ${isTrue}`);
}

/** Returns the colour of the map at a place of the scene. */
export function colorAt(page, place) {
  return page.evaluate((where) => {
    const at = window.spawnfield.project(where);
    return window.spawnfield.pixelAt(at.x, at.y);
  }, place);
}
