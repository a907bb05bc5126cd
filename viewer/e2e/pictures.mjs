// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Takes the documentation's pictures of a map that is being made, and of an object of it afterwards.
// Usage, in viewer/: node e2e/pictures.mjs PROGRAM RECORDING OUT [options of ovimap serve --live]
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium } from '@playwright/test';

const [program, recording, out, ...options] = process.argv.slice(2);
if (!program || !recording || !out) {
  console.error('usage: node e2e/pictures.mjs PROGRAM RECORDING OUT [options]');
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'ovimap-pictures-'));
const map = join(folder, 'room.ovimap');
const server = spawn(
  program,
  ['serve', recording, '--live', '-o', map, '--port', '0', '--json', '--no-limits', ...options],
  { stdio: ['ignore', 'pipe', 'inherit'] },
);
const lines = [];
server.stdout.setEncoding('utf8').on('data', (text) => lines.push(...text.split('\n')));
const line = async (key) => {
  for (;;) {
    const found = lines.find((each) => each.startsWith('{') && JSON.parse(each)[key]);
    if (found) return JSON.parse(found);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
};

const { address } = await line('address');
const browser = await chromium.launch({
  executablePath: process.env.OVIMAP_CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--enable-unsafe-swiftshader'],
});
const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, colorScheme: 'dark' });
await page.goto(address);
const frames = (least) =>
  page.waitForFunction(
    (wanted) =>
      Number(
        /from ([\d,]+) frame/.exec(document.querySelector('.facts')?.textContent ?? '')?.[1],
      ) >= wanted,
    least,
    { timeout: 300_000 },
  );
await frames(Number(process.env.OVIMAP_PICTURE_AT ?? 150));
await page.waitForTimeout(1500); // the view glides to where all is seen
await page.screenshot({ path: join(out, 'viewer_live.jpg'), type: 'jpeg', quality: 85 });

await line('saved');
await page.waitForFunction(() => !document.querySelector('.facts.live'), null, { timeout: 60_000 });
await page.keyboard.press('c');
await page.keyboard.press('t');
await page.keyboard.press('2');
await page.waitForTimeout(4000); // names are guessed
await page
  .locator('.row')
  .nth(Number(process.env.OVIMAP_PICTURE_OF ?? 5))
  .click();
await page.waitForTimeout(4000);
await page.screenshot({ path: join(out, 'viewer_object.jpg'), type: 'jpeg', quality: 85 });
await browser.close();
server.kill('SIGINT');
await new Promise((resolve) => server.once('exit', resolve));
rmSync(folder, { recursive: true, force: true });
