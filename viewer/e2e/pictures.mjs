// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Takes the documentation's pictures of a query, of an object that it finds, and of the same on a phone.
// Usage, in viewer/: node e2e/pictures.mjs PROGRAM MAP OUT QUERY
import { join } from 'node:path';
import { launch, serve } from './served-map.mjs';

const [program, map, out, query] = process.argv.slice(2);
if (!program || !map || !out || !query) {
  console.error('usage: node e2e/pictures.mjs PROGRAM MAP OUT QUERY');
  process.exit(2);
}
const { server, address } = await serve(program, map);
const browser = await launch();

/** The page with the query's answer, once the view rests. */
async function answered(viewport, colorScheme) {
  const page = await browser.newPage({ viewport, colorScheme });
  await page.goto(address);
  await page.locator('.row').first().waitFor({ timeout: 120_000 });
  await page.getByRole('combobox').first().fill(query);
  await page.keyboard.press('Enter');
  await page.locator('.verdict.found').waitFor({ timeout: 120_000 });
  await page.waitForTimeout(4000);
  return page;
}
const picture = (page, name) =>
  page.screenshot({ path: join(out, `${name}.jpg`), type: 'jpeg', quality: 85 });

const desk = { width: 1280, height: 800 };
await picture(await answered(desk, 'dark'), 'viewer_heat');
await picture(await answered({ width: 390, height: 844 }, 'dark'), 'viewer_phone');
const page = await answered(desk, 'light');
await page.locator('.row').first().click();
await page.keyboard.press('2'); // objects in their colours
await page.waitForTimeout(4000);
await picture(page, 'viewer_object');

await browser.close();
server.kill('SIGINT');
await new Promise((resolve) => server.once('exit', resolve));
