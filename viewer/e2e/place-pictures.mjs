// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Takes the documentation's pictures of rooms, and of where to stand to see what a query finds.
// Usage, in viewer/: node e2e/place-pictures.mjs PROGRAM MAP OUT QUERY
import { join } from 'node:path';
import { launch, serve } from './served-map.mjs';

const [program, map, out, query] = process.argv.slice(2);
if (!program || !map || !out || !query) {
  console.error('usage: node e2e/place-pictures.mjs PROGRAM MAP OUT QUERY');
  process.exit(2);
}
const { server, address } = await serve(program, map);
const browser = await launch();
const page = await browser.newPage({
  viewport: { width: 1280, height: 800 },
  colorScheme: 'light',
});
const picture = async (name) => {
  await page.waitForTimeout(3000); // the view glides there
  await page.screenshot({ path: join(out, name), type: 'jpeg', quality: 85 });
};
await page.goto(address);
await page.waitForFunction(() => performance.getEntriesByName('whole-picture').length > 0, null, {
  timeout: 120_000,
});
await page.keyboard.press('r');
await page.waitForSelector('.row[data-room]', { timeout: 120_000 });
await picture('viewer_rooms.jpg');

await page.keyboard.press('r');
await page.waitForTimeout(5000); // names are guessed
await page.keyboard.press('/');
await page.keyboard.type(query);
await page.keyboard.press('Enter');
await page.waitForSelector('.row .bar', { timeout: 60_000 });
await page.locator('.row').first().click();
await page.waitForTimeout(2000);
await page.locator('[data-action="stand"]').click();
await page.keyboard.press('1');
await page.mouse.move(640, 360);
for (let i = 0; i < 8; ++i) await page.mouse.wheel(0, 240); // far enough to see the way
await page.mouse.down();
await page.mouse.move(640, 560, { steps: 10 }); // from above
await page.mouse.up();
await picture('viewer_approach.jpg');
await browser.close();
server.kill('SIGINT');
