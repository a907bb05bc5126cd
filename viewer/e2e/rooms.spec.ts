// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Rooms on the floor, with names and doors.
import AxeBuilder from '@axe-core/playwright';
import { expect } from '@playwright/test';
import { test, wholePicture } from './running-map';

const PICTURES = process.env.OVIMAP_E2E_PICTURES ?? 'test-results/pictures';

test('draws rooms, lists them and flies to one', async ({ page, map }) => {
  test.setTimeout(120_000);
  await page.goto(map.address);
  await wholePicture(page);
  const view = page.locator('canvas');
  const without = await view.screenshot();
  await page.keyboard.press('r');
  await expect(page.locator('#list-title')).toHaveText('Rooms', { timeout: 60_000 });
  const rows = page.locator('.row[data-room]');
  await expect(rows.first()).toContainText(/\d m², \d+ objects?/);
  await page.waitForTimeout(500);
  const drawn = await view.screenshot();
  expect(drawn.equals(without)).toBe(false);
  await page.screenshot({ path: `${PICTURES}/rooms.png` });
  await rows.first().click();
  await page.waitForTimeout(1000);
  expect((await view.screenshot()).equals(drawn)).toBe(false);
  await page.screenshot({ path: `${PICTURES}/room.png` });
  const { violations } = await new AxeBuilder({ page }).analyze();
  expect(violations.map(({ id }) => id)).toEqual([]);
  await page.keyboard.press('r');
  await expect(page.locator('#list-title')).toHaveText('All objects');
});
