// Sizes and times with 1,000,000 triangles and 1,000,000 poses. Times depend on the machine, which draws without
// graphics hardware here, so only sizes have limits; times are printed.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { startBrowser } from './browser.mjs';
import { bigPack, pageWith } from './make_pack.mjs';

test('a million triangles and poses are small, and few draw calls', async (context) => {
  const html = pageWith(bigPack());
  assert.ok(html.length <= 15e6, `${html.length} bytes`);
  const browser = await startBrowser();
  try {
    const page = await browser.open(html);
    const { drawCalls, triangles, bytesUploaded, loadMilliseconds, decodeMilliseconds, frameMilliseconds } =
      await page.evaluate(() => window.spawnfield.statistics());
    context.diagnostic(
      `file ${html.length} bytes; page ready after ${Math.round(loadMilliseconds)} ms, of which ` +
        `${Math.round(decodeMilliseconds)} ms before the first picture; ${drawCalls} draw calls; ${triangles} triangles; ` +
        `${bytesUploaded} bytes uploaded; ${Math.round(frameMilliseconds)} ms for a picture, drawn without graphics hardware`,
    );
    assert.ok(drawCalls <= 10, `${drawCalls} draw calls`);
    assert.ok(bytesUploaded <= 40e6, `${bytesUploaded} bytes`);
    const answer = await page.evaluate(() => window.spawnfield.pick(320, 380));
    assert.ok(answer.verdictName);
    assert.deepEqual(
      page.faults.filter((fault) => !/GPU stall|ReadPixels/.test(fault)),
      [],
    );
  } finally {
    await browser.close();
  }
});
