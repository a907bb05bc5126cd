// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The page while the map is made.
import { existsSync } from 'node:fs';
import { expect } from '@playwright/test';
import { infoOf, test, wholePicture } from './running-map';

const PICTURES = process.env.OVIMAP_E2E_PICTURES ?? 'test-results/pictures';

test('shows, searches and corrects a map while it is made', async ({ page, live: map }) => {
  test.setTimeout(240_000);
  await page.goto(map.address);
  await wholePicture(page);
  await expect(page.locator('.facts.live')).toContainText('frame');
  await expect(page.locator('.row').nth(2)).toBeVisible({ timeout: 60_000 });
  await expect(page.getByRole('group', { name: 'Camera path' })).toBeVisible();
  const frames = await page.locator('.facts').textContent();
  await expect(page.locator('.facts')).not.toHaveText(frames!);

  await expect(page.locator('.facts')).toContainText(/from [12]\d frames/, { timeout: 60_000 });
  await page.screenshot({ path: `${PICTURES}/live.png` });

  await expect(page.getByRole('combobox')).toBeEnabled({ timeout: 90_000 });
  await expect(async () => {
    await page.getByRole('combobox').fill('sofa'); // until an object has been looked at in words
    await page.keyboard.press('Enter');
    await expect(page.locator('.verdict')).toHaveText(/^(Found|Not in the map)/, {
      timeout: 5_000,
    });
  }).toPass({ timeout: 90_000 });
  await page.getByRole('button', { name: 'Clear the query' }).click();

  await page.locator('.row').first().click();
  const id = (await page.locator('.card h2 small').textContent())!.slice(1);
  await page.keyboard.press('n');
  await page.getByLabel('New name').fill('reading corner');
  await page.keyboard.press('Enter');
  await expect(page.locator('.card h2')).toContainText('reading corner');
  await page.reload();
  await wholePicture(page);
  const named = page.locator('.row', { hasText: 'reading corner' });
  await expect(named).toHaveCount(1);

  await expect(page.locator('.facts.live')).toHaveCount(0, { timeout: 120_000 }); // it is saved
  // An object that turns out to be part of another goes by the older id, and is found by its own.
  const known = await page.request.get(`${map.address}api/instances/${id}`);
  await expect(named).toHaveAttribute('data-id', String((await known.json()).id));
  expect(await map.interrupt()).toBe(0);
  expect(infoOf(map.file).instances.map(({ name }) => name)).toContain('reading corner');
});

test('a camera that is lost turns red, and says where it can be found', async ({ page, map }) => {
  test.setTimeout(120_000);
  const cameras = (await (await page.request.get(`${map.address}api/cameras`)).json()) as {
    frames: { world_from_camera: number[] }[];
  };
  const pose = cameras.frames.at(-1)!.world_from_camera;
  const tracking = { state: 'lost', frames_lost: 12, loops: 0, world_from_camera: pose };
  await page.route('**/api/map', async (route) => {
    const response = await route.fetch();
    await route.fulfill({ json: { ...(await response.json()), live: true, tracking } });
  });
  await page.goto(map.address);
  await wholePicture(page);
  await expect(page.getByRole('alert')).toContainText('The camera has been lost for 12 frames');
  await page.waitForTimeout(1000);
  await page.screenshot({ path: `${PICTURES}/lost.png` });
});

test('Ctrl-C saves what was mapped', async ({ page, live: map }) => {
  test.setTimeout(120_000);
  await page.goto(map.address);
  await wholePicture(page);
  await expect(page.locator('.facts')).toContainText(/from ([4-9]|1\d) frames/);
  expect(await map.interrupt()).toBe(0);
  expect(existsSync(map.file)).toBe(true);
  expect(infoOf(map.file).frames).toBeGreaterThan(3);
  await expect(page.getByRole('alert')).toContainText('connection to the server is lost');
});
