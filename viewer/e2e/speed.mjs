// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Measures the viewer on a map, on loopback and with software rendering: when the first picture is drawn, and how long a query takes until
// its answer is drawn. Usage, in viewer/: node e2e/speed.mjs PROGRAM MAP [runs]
import { launch, serve } from './served-map.mjs';

const [program, map, runs = '7'] = process.argv.slice(2);
if (!program || !map) {
  console.error('usage: node e2e/speed.mjs PROGRAM MAP [runs]');
  process.exit(2);
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const row = (what, values) =>
  console.log(`| ${what} | ${median(values).toFixed(0)} | ${Math.max(...values).toFixed(0)} |`);

/** Whether the map can be searched. */
async function searchReady(address) {
  const state = async () => (await (await fetch(`${address}api/map`)).json()).search.state;
  while ((await state()) === 'preparing') await new Promise((resolve) => setTimeout(resolve, 100));
  await new Promise((resolve) => setTimeout(resolve, 3000)); // names are guessed right after
  return (await state()) === 'ready';
}

/** How long a turn of the view takes from frame to frame, while it is dragged. */
async function turn(page) {
  await page.mouse.move(800, 400);
  await page.mouse.down();
  const times = [];
  for (let step = 1; step <= 12; ++step) {
    const start = performance.now();
    await page.mouse.move(800 + 12 * step, 400);
    await page.evaluate(
      () => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))),
    );
    times.push(performance.now() - start);
  }
  await page.mouse.up();
  return median(times.slice(4)); // the first ones find out that this machine is slow
}

const markOf = (page, name) =>
  page.evaluate((wanted) => performance.getEntriesByName(wanted).at(-1)?.startTime ?? 0, name);
const drawn = (page, name) =>
  page.waitForFunction((wanted) => performance.getEntriesByName(wanted).length > 0, name);

/** Until the detailed frame that follows each change is drawn, which in software takes most of a second. */
const atRest = (page) => page.waitForTimeout(2000);

async function ask(page, text) {
  await page.evaluate(() => performance.clearMarks('answer-drawn'));
  await page.fill('#query', text);
  const start = await page.evaluate(() => {
    const now = performance.now();
    document.querySelector('form[role=search]').requestSubmit();
    return now;
  });
  await drawn(page, 'answer-drawn');
  return (await markOf(page, 'answer-drawn')) - start;
}

async function answerTime(address, text) {
  const start = performance.now();
  const reply = await fetch(`${address}api/query`, {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ text, heat: true }),
  });
  await reply.json();
  return performance.now() - start;
}

const { server, address } = await serve(program, map);
const words = await searchReady(address);
const times = { first: [], whole: [], turned: [], still: [], words: [], bare: [], encoded: [] };
for (let run = 0; run < Number(runs); ++run) {
  const browser = await launch();
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.goto(address);
  await drawn(page, 'whole-picture');
  times.first.push(await markOf(page, 'first-picture'));
  times.whole.push(await markOf(page, 'whole-picture'));
  await page.waitForTimeout(500);
  times.turned.push(await turn(page));
  if (!words) {
    await browser.close();
    continue;
  }
  await atRest(page);
  times.still.push(await ask(page, 'largest object'));
  await atRest(page);
  times.words.push(await ask(page, 'chair'));
  times.bare.push(await answerTime(address, 'largest object'));
  times.encoded.push(await answerTime(address, 'chair'));
  await browser.close();
}
server.kill('SIGINT');

console.log('| 1280 x 800, software rendering | median, ms | slowest, ms |\n| --- | --- | --- |');
row('first picture after opening the page', times.first);
row('whole surface', times.whole);
row('from frame to frame while the view is turned', times.turned);
if (!words) process.exit();
row('query without words ("largest object"), answered and drawn', times.still);
row('query in words ("chair"), answered and drawn', times.words);
row('of which the answer without words, on the server', times.bare);
row('of which the answer in words, text encoding included', times.encoded);
