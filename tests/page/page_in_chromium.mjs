// page_in_chromium.mjs CHROMIUM REPORT.html FOLDER: the page of an experiment in a browser, from file://. Pictures of it
// stay in FOLDER. Of a FOLDER/figure_SUBJECT.png, the neutral face as 'mimik figure' draws it, the page's is compared.

import assert from 'node:assert/strict';
import {existsSync, readFileSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {Chromium} from './chromium.mjs';
import {likeness} from './likeness.mjs';

const [program, file, folder] = process.argv.slice(2);
const url = pathToFileURL(resolve(file)).href;
const drawn = `document.querySelector('#face-panel canvas')?.dataset.firstPictureMs !== undefined`;
const largest = `Number(document.querySelector('#face-panel [role=status]').textContent.match(/shown: ([0-9.]+) mm/)[1])`;
const settle = () => new Promise(done => setTimeout(done, 400));
const claim = text => console.log(`ok: ${text}`);
const keep = async (page, name, whole) => writeFileSync(join(folder, name), await page.picture(whole));

const browser = new Chromium(program);
try {
  // Time that the page's own thread works: what else the machine does is no fault of the page.
  const page = await browser.page();
  await page.send('Performance.enable', {timeDomain: 'threadTicks'});
  await page.open(url, {width: 1280, height: 900});
  await page.until(drawn, 60);
  const {metrics} = await page.send('Performance.getMetrics');
  const worked = metrics.find(metric => metric.name === 'TaskDuration').value;
  const waited = await page.value(`Number(document.querySelector('#face-panel canvas').dataset.firstPictureMs)`);
  assert.ok(worked <= 2, `the page worked ${worked} s for its first picture`);
  claim(`the page works below 2 s for its first picture (${worked.toFixed(2)} s; it was there after ${waited} ms)`);

  await page.until(`document.querySelectorAll('#interval-plots svg').length > 0`);
  assert.deepEqual(page.requests.filter(request => request !== url && !/^(data|blob):/.test(request)), []);
  claim('nothing but the file itself is asked for');

  const column = k => page.value(`[...document.querySelectorAll('#methods-table tbody tr')].map(row => row.children[${k}].textContent)`);
  const press = async k => page.value(`document.querySelectorAll('#methods-table thead button')[${k}].click()`);
  await press(2);
  const falling = (await column(2)).map(Number);
  assert.deepEqual(falling, [...falling].sort((a, b) => b - a));
  assert.equal(await page.value(`document.querySelectorAll('#methods-table thead th')[2].getAttribute('aria-sort')`), 'descending');
  await press(2);
  assert.deepEqual((await column(2)).map(Number), [...falling].reverse());
  assert.ok(falling.length > 1);
  claim('a table sorts by a column, down and up, and says so');

  await page.until(`/shown: [0-9.]+ mm/.test(document.querySelector('#face-panel [role=status]').textContent)`);
  await page.value(`[...document.querySelectorAll('#face-panel button')].find(b => b.textContent === 'Neutral').click()`);
  await page.until(`${largest} === 0`);
  await settle();
  const box = await page.value(`(() => { const c = document.querySelector('#face-panel canvas'); c.scrollIntoView({behavior: 'instant'}); const {x, y, width, height} = c.getBoundingClientRect(); return {x: x + window.scrollX + 12, y: y + window.scrollY + 40, width: width - 24, height: height - 52, scale: 1}; })()`);
  const neutral = Buffer.from((await page.send('Page.captureScreenshot', {format: 'png', clip: box})).data, 'base64');
  writeFileSync(join(folder, 'neutral.png'), neutral);
  const figure = join(folder, `figure_${await page.value(`document.querySelector('#face-panel select').value`)}.png`);
  if (existsSync(figure)) {
    // Perspective and a turn of a few degrees part the two; another face, or one upside down, overlaps less.
    const {overlap, light, shape} = await likeness(page, neutral, readFileSync(figure));
    assert.ok(overlap > 0.9 && light > 0.6 && Math.abs(shape - 1) < 0.08, `overlap ${overlap}, light ${light}, shape ${shape}`);
    claim(`the page shows the face that a figure shows (overlap ${overlap.toFixed(2)}, lightness ${light.toFixed(2)})`);
  }
  await page.value(`document.querySelector('#face-panel .slider.chosen input[type=range]').focus()`);
  await page.key('End');
  await page.until(`${largest} > 1`);
  await keep(page, 'moved.png');
  const far = await page.value(largest);
  for (let k = 0; k < 15; ++k) await page.key('ArrowLeft');  // from 1.5 to 0.75: half as far
  await page.until(`Math.abs(${largest} - ${far / 2}) < 0.11`);
  claim('a slider moves the vertices by keys, in proportion to its value');

  await page.value(`document.querySelector('#face-panel canvas').scrollIntoView({behavior: 'instant'})`);
  await page.value(`document.querySelector('#face-panel canvas').focus()`);
  await settle();
  const front = await page.picture();
  await page.key('ArrowRight');
  await settle();
  assert.notDeepEqual(await page.picture(), front);
  await page.key('Home');
  claim('the face turns by keys');

  await page.value(`(() => { const list = [...document.querySelectorAll('#face-panel select')][2]; list.value = 'distance'; list.dispatchEvent(new Event('change')); })()`);
  await page.value(`[...document.querySelectorAll('#face-panel button')].find(b => b.textContent === 'Chosen alone at 1').click()`);
  await page.until(`/ mm/.test(document.querySelector('#face-panel .bar').textContent)`);
  await page.value(`[...document.querySelectorAll('#face-panel input[type=checkbox]')][1].click()`);
  await settle();
  await page.value(`document.getElementById('faces').scrollIntoView({behavior: 'instant'})`);
  await keep(page, 'heat.png');
  await page.value(`[...document.querySelectorAll('#face-panel button')].find(b => b.textContent === 'Real scan').click()`);
  await page.until(`/ scan of /.test(document.querySelector('#face-panel .what').textContent)`);
  await settle();
  await keep(page, 'real.png');
  await page.value(`[...document.querySelectorAll('#face-panel button')].find(b => b.textContent === 'Real scan').click()`);
  claim('the heat map has a scale with its unit, and the real scan can be seen');

  const other = await page.value(`(() => {
    const there = new Set([...document.querySelectorAll('#face-panel select')[0].options].map(o => o.value));
    const button = [...document.querySelectorAll('#targets-table tbody button')].reverse().find(b => there.has(b.textContent));
    button.focus(); return button.textContent; })()`);
  await page.key('Enter');
  await page.until(`document.querySelectorAll('#face-panel select')[0].value === ${JSON.stringify(other)}`);
  assert.equal(await page.value(`document.activeElement.tagName`), 'CANVAS');
  claim('a key on a row of a table leads to that face');

  const names = await page.value(`[...document.querySelectorAll('button, select, input, canvas')].filter(e => !(e.getAttribute('aria-label') || e.textContent.trim() || e.closest('label')?.textContent.trim())).length`);
  assert.equal(names, 0, 'controls without a name');
  claim('every control has a name');
  await page.value(`window.scrollTo({top: 0, behavior: 'instant'})`);
  await keep(page, 'wide.png', true);

  const narrow = await browser.page();
  await narrow.open(url, {width: 400, height: 800});
  await narrow.until(drawn);
  await narrow.until(`document.querySelectorAll('#interval-plots svg').length > 0`);
  const overflow = await narrow.value(`document.documentElement.scrollWidth`);
  assert.ok(overflow <= 400, `the page is ${overflow} px wide on a screen of 400`);
  await keep(narrow, 'narrow.png', true);
  claim('400 px are wide enough');

  const dark = await browser.page();
  await dark.open(url, {width: 1280, height: 900, dark: true});
  await dark.until(drawn);
  await keep(dark, 'dark.png', true);
  assert.deepEqual([...page.faults, ...narrow.faults, ...dark.faults], []);
  claim('the console has no error');
} finally {
  await browser.close();
}
