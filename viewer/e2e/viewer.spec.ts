// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from 'node:fs';
import AxeBuilder from '@axe-core/playwright';
import { chromium, expect, type Page } from '@playwright/test';
import { RunningMap, test, wholePicture } from './running-map';

const PICTURES = process.env.OVIMAP_E2E_PICTURES ?? 'test-results/pictures';

async function open(page: Page, address: string): Promise<void> {
  await page.goto(address);
  await wholePicture(page);
}

/** Clicks places of the 3D view, some of which may be empty, until something is shown. */
async function clickUntil(page: Page, shown: string): Promise<void> {
  for (const [x, y] of [
    [800, 420],
    [760, 500],
    [880, 380],
    [700, 380],
    [940, 480],
    [820, 300],
    [780, 260],
  ] as const) {
    await page.mouse.click(x, y);
    if (await page.locator(shown).isVisible()) return;
  }
  throw new Error(`no click showed ${shown}`);
}

async function ask(page: Page, text: string): Promise<void> {
  await page.getByRole('combobox').fill(text);
  await page.keyboard.press('Enter');
  await expect(page.locator('.verdict')).toHaveText(/^(Found|Not in the map)/);
}

test('shows the map and lists its objects', async ({ page, map }) => {
  await open(page, map.address);
  await expect(page).toHaveTitle('tiny room – ovimap');
  expect(await page.locator('.row').count()).toBeGreaterThan(5);
  const picture = await page.screenshot({ path: `${PICTURES}/color.png` });
  expect(picture.byteLength).toBeGreaterThan(60_000); // an empty view has a fifth of that
  for (const [key, name] of [
    ['2', 'Objects'],
    ['3', 'Classes'],
    ['4', 'Heat'],
    ['1', 'Colour'],
  ] as const) {
    await page.keyboard.press(key);
    await expect(page.getByRole('button', { name, exact: true })).toHaveAttribute(
      'aria-pressed',
      'true',
    );
  }
});

test('answers queries, and says what is not there', async ({ page, map }) => {
  await open(page, map.address);
  await ask(page, 'sofa');
  expect(await page.locator('.row').count()).toBeGreaterThan(0);
  await expect(page.getByRole('button', { name: 'Heat' })).toHaveAttribute('aria-pressed', 'true');
  await expect(page.locator('.legend')).toContainText('sofa');
  await page.screenshot({ path: `${PICTURES}/heat.png` });
  await ask(page, 'largest object');
  await expect(page.locator('.verdict')).toContainText('Found');
  await expect(page.locator('.verdict')).toContainText('read as largest [object]');
  await ask(page, 'how many sofas');
  await expect(page.locator('.verdict')).toContainText(
    /\d found, [\d.]+ ± [\d.]+ by their chances/,
  );
  await ask(page, 'dinosaur skeleton');
  await expect(page.locator('.verdict')).toContainText('Not in the map');
  await expect(page.locator('#list-title')).toHaveText('What comes nearest');
  await page.getByRole('button', { name: 'Clear the query' }).click();
  await expect(page.locator('#list-title')).toHaveText('All objects');
  await expect(page.getByRole('button', { name: 'Colour' })).toHaveAttribute(
    'aria-pressed',
    'true',
  );
});

test('says what is wrong with a query', async ({ page, map }) => {
  await open(page, map.address);
  await page.route('**/api/query', (route) =>
    route.fulfill({ status: 429, json: { error: 'too many queries' } }),
  );
  await page.getByRole('combobox').fill('sofa');
  await page.keyboard.press('Enter');
  await expect(page.locator('.verdict')).toHaveText('too many queries');
});

test('selects in both directions', async ({ page, map }) => {
  await open(page, map.address);
  await page.keyboard.press('2');
  await clickUntil(page, '.card');
  const id = (await page.locator('.card h2 small').textContent())!.slice(1);
  await expect(page.locator(`.row[data-id="${id}"]`)).toHaveAttribute('aria-current', 'true');
  await expect(page.locator('.facts-table')).toContainText('Height');
  await page.screenshot({ path: `${PICTURES}/selected.png` });
  const other = page.locator(`.row:not([data-id="${id}"])`).first();
  await other.click();
  await expect(page.locator('.card h2 small')).toHaveText(
    `#${await other.getAttribute('data-id')}`,
  );
  await page.keyboard.press('Escape');
  await expect(page.locator('.card')).toBeHidden();
});

test('lists the parts of an object beside its neighbours, and outlines them', async ({
  page,
  map,
}) => {
  const box = { min: [0, 0, 0], max: [0.4, 0.3, 0.2] };
  await page.route(/api\/instances\/\d+$/, async (route) => {
    const response = await route.fetch();
    const parts = [1, 2].map((number) => ({ number, box, centroid: [0.2, 0.1, 0.1], points: 50 }));
    await route.fulfill({ json: { ...(await response.json()), parts } });
  });
  await open(page, map.address);
  await page.locator('.row').first().click();
  await expect(page.locator('.card .parts button')).toHaveCount(2);
  await expect(page.locator('.card .neighbors')).toContainText('Neighbours');
  const before = await page.locator('canvas').screenshot();
  await page.locator('.card .parts button').first().click();
  await page.waitForTimeout(1000);
  expect((await page.locator('canvas').screenshot()).equals(before)).toBe(false);
});

test('keeps a name through a reload', async ({ page, map }) => {
  await open(page, map.address);
  await page.locator('.row').first().click();
  await page.keyboard.press('n');
  await page.getByLabel('New name').fill('reading corner');
  await page.keyboard.press('Enter');
  await expect(page.locator('.card h2')).toContainText('reading corner');
  await page.reload();
  await wholePicture(page);
  await expect(page.locator('.row', { hasText: 'reading corner' })).toHaveCount(1);
  await page.getByRole('combobox').fill('read');
  await expect(page.getByRole('option', { name: 'reading corner' })).toBeVisible();
});

test('hears what happens while it loads', async ({ page, map }) => {
  await page.route('**/api/cameras', async (route) => {
    const { instances } = await (await page.request.get(`${map.address}api/instances`)).json();
    const correction = { kind: 'rename', instance: instances[1].id, name: 'said meanwhile' };
    const reply = await page.request.post(`${map.address}api/corrections`, { data: correction });
    expect(reply.status()).toBe(200);
    await route.continue();
  });
  await open(page, map.address);
  await expect(page.locator('.row', { hasText: 'said meanwhile' })).toHaveCount(1);
});

test('measures, cuts, follows the camera', async ({ page, map }) => {
  await open(page, map.address);
  await page.keyboard.press('m');
  await clickUntil(page, '.measure-label');
  await expect(page.locator('.measure-label')).toHaveText(/\d (cm|m)$/);
  await page.keyboard.press('m');
  await expect(page.locator('.measure-label')).toBeHidden();
  const whole = await page.screenshot();
  await page.keyboard.press('x');
  await page.locator('#section-share').fill('0.3');
  expect((await page.screenshot()).equals(whole)).toBe(false);
  await page.keyboard.press('x');
  await page.keyboard.press('c');
  await expect(page.getByRole('group', { name: 'Camera path' })).toContainText('1 / ');
  await page.getByRole('button', { name: 'Look from here' }).click();
});

const ids = (page: Page): Promise<string[]> =>
  page.locator('.row').evaluateAll((rows) => rows.map((row) => row.getAttribute('data-id')!));

test('hides, locks, deletes and undoes, through a reload', async ({ page, map }) => {
  await open(page, map.address);
  const before = await ids(page);
  const act = (name: string) => page.getByRole('button', { name, exact: true }).click();
  await page.locator('.row').nth(1).click();
  await page.keyboard.press('h');
  await expect(page.locator('.row')).toHaveCount(before.length - 1);
  await page.reload();
  await wholePicture(page);
  expect(await ids(page)).not.toContain(before[1]);
  await page.keyboard.press('u');
  await expect(page.locator('.row')).toHaveCount(before.length);

  await page.locator('.row').nth(1).click();
  await act('Lock');
  await expect(page.getByRole('button', { name: 'Delete', exact: true })).toBeDisabled();
  await act('Unlock');
  await act('Delete');
  await expect(page.locator('.row')).toHaveCount(before.length - 1);
  await act('Corrections');
  const log = page.getByRole('dialog', { name: 'Corrections' });
  await expect(log.locator('li').first()).toContainText('deleted');
  await page.screenshot({ path: `${PICTURES}/log.png` });
  await log.getByRole('button', { name: 'Undo' }).first().click();
  await expect(log.locator('li').first()).toContainText('undone');
  await log.getByRole('button', { name: 'Close' }).click();
  await expect(page.locator('.row')).toHaveCount(before.length);
  expect((await ids(page)).sort()).toEqual(before.sort());
});

test('merges, and everybody sees it', async ({ page, map, context }) => {
  await open(page, map.address);
  const other = await context.newPage();
  await open(other, map.address);
  const [first, second] = await ids(page);
  const count = await page.locator('.row').count();
  await page.locator('.row').nth(1).click();
  await page.getByRole('button', { name: 'Merge', exact: true }).click();
  await expect(page.getByRole('alert')).toContainText('is a part of');
  await page.locator('.row').first().click();
  for (const shown of [page, other]) {
    await expect(shown.locator('.row')).toHaveCount(count - 1);
    expect(await ids(shown)).toContain(first);
    expect(await ids(shown)).not.toContain(second);
  }
  await other.keyboard.press('u');
  await expect(page.locator('.row')).toHaveCount(count);
});

test('can be used with the keyboard alone', async ({ page, map }) => {
  await open(page, map.address);
  await page.keyboard.press('/');
  await expect(page.getByRole('combobox')).toBeFocused();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  await expect(page.locator('.verdict')).toHaveText(/^(Found|Not in the map)/);
  await page.keyboard.press('Escape');
  await page.locator('.row').first().focus();
  await page.keyboard.press('Enter');
  await expect(page.locator('.card')).toBeVisible();
  await page.locator('canvas').focus();
  await page.keyboard.press('?');
  await expect(page.getByRole('dialog')).toBeVisible();
  await page.keyboard.press('Escape');
  await expect(page.getByRole('dialog')).toBeHidden();
});

for (const theme of ['dark', 'light'] as const)
  test(`has labels and contrast, ${theme}`, async ({ page, map }) => {
    await page.emulateMedia({ colorScheme: theme });
    await open(page, map.address);
    await page.locator('.row').first().click();
    await expect(page.locator('.facts-table')).toContainText('Height');
    const { violations } = await new AxeBuilder({ page }).analyze();
    expect(
      violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(' ')}`),
    ).toEqual([]);
  });

test('fits a phone', async ({ page, map }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open(page, map.address);
  await page.screenshot({ path: `${PICTURES}/phone.png` });
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(390);
  for (const button of await page.locator('.toolbar button').all()) {
    const box = (await button.boundingBox())!;
    expect(box.x >= 0 && box.x + box.width <= 390).toBe(true);
  }
  await page.locator('.row').first().click();
  await expect(page.locator('.card')).toBeInViewport();
});

test('hands over a picture and a GLB', async ({ page, map }) => {
  await open(page, map.address);
  const [picture] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('p')]);
  expect(picture.suggestedFilename()).toBe('tiny room.png');
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Download as GLB' }).click(),
  ]);
  expect(file.suggestedFilename()).toBe('tiny room.glb');
  expect(
    readFileSync(await file.path())
      .subarray(0, 4)
      .toString(),
  ).toBe('glTF');
});

test('says that the server is gone, and stays usable', async ({ page }) => {
  const map = await RunningMap.start();
  await open(page, map.address);
  await map.stop();
  await expect(page.getByRole('alert')).toContainText('connection to the server is lost');
  await page.locator('.row').first().click();
  await expect(page.locator('.toast').first()).toContainText('ovimap serve');
});

test('without WebGL it says so, and still searches', async ({ map }) => {
  const browser = await chromium.launch({
    executablePath: process.env.OVIMAP_CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-3d-apis'],
  });
  const page = await browser.newPage();
  await page.goto(map.address);
  await expect(page.getByRole('alert')).toContainText('WebGL 2');
  await ask(page, 'sofa');
  await page.locator('.row').first().click();
  await expect(page.locator('.facts-table')).toContainText('Height');
  await browser.close();
});
