// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// How well places are known, and where to look next.
import AxeBuilder from '@axe-core/playwright';
import { expect } from '@playwright/test';
import { test, wholePicture } from './running-map';

const PICTURES = process.env.OVIMAP_E2E_PICTURES ?? 'test-results/pictures';

test('colours what is known, marks gaps, lists them and flies to one', async ({ page, map }) => {
  test.setTimeout(120_000);
  await page.goto(map.address);
  await wholePicture(page);
  const view = page.locator('canvas');
  const colours = await view.screenshot();
  await page.keyboard.press('5');
  await expect(page.getByRole('region', { name: 'Legend' })).toContainText('1 mm');
  await page.waitForTimeout(500);
  const known = await view.screenshot();
  expect(known.equals(colours)).toBe(false);
  await page.keyboard.press('l');
  await expect(page.locator('#list-title')).toHaveText('Where to look next');
  const rows = page.locator('.row[data-gap]');
  await expect(rows.first()).toContainText(/\d m²/);
  await page.waitForTimeout(500);
  const marked = await view.screenshot();
  expect(marked.equals(known)).toBe(false);
  await page.screenshot({ path: `${PICTURES}/gaps.png` });
  await rows.first().click();
  await page.waitForTimeout(1000);
  expect((await view.screenshot()).equals(marked)).toBe(false);
  const { violations } = await new AxeBuilder({ page }).analyze();
  expect(violations.map(({ id }) => id)).toEqual([]);
  await page.keyboard.press('l');
  await expect(page.locator('#list-title')).toHaveText('All objects');
});
