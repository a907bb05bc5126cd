// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// A map of two visits: what changed, and what was where.
import AxeBuilder from '@axe-core/playwright';
import { expect, type Page } from '@playwright/test';
import { test, wholePicture } from './running-map';

const PICTURES = process.env.OVIMAP_E2E_PICTURES ?? 'test-results/pictures';

async function shown(page: Page): Promise<Buffer> {
  await page.waitForTimeout(700); // the view glides, then draws in detail
  return page.locator('canvas').screenshot({ timeout: 60_000 });
}

test('lists changes, flies to them, and shows the map as it was', async ({ page, home: map }) => {
  test.setTimeout(180_000);
  await page.goto(map.address);
  await wholePicture(page);
  const now = await shown(page);
  await page.keyboard.press('v');
  const panel = page.getByRole('group', { name: 'Visits' });
  await expect(panel).toContainText('visit 2 of 2, 16 Mar 2026', { timeout: 60_000 });
  await expect(page.locator('#list-title')).toHaveText('Changes, the latest first');
  const rows = page.locator('.row[data-event]');
  await expect(rows.first()).toContainText('visit 2, 16 Mar 2026');
  expect((await rows.allTextContents()).join()).toMatch(/moved \d|gone|new/);

  await panel.getByLabel('As of').fill('1');
  await expect(panel).toContainText('visit 1 of 2, 14 Mar 2026');
  const then = await shown(page);
  expect(then.equals(now)).toBe(false);
  await page.screenshot({ path: `${PICTURES}/visit1.png` });

  await panel.getByLabel('As of').fill('2');
  await panel.getByLabel('Show what is gone').check();
  const faint = await shown(page);
  expect(faint.equals(now)).toBe(false);
  expect(faint.equals(then)).toBe(false);
  await page.screenshot({ path: `${PICTURES}/gone.png` });

  await rows
    .filter({ hasText: /gone|moved/ })
    .first()
    .click();
  const near = await shown(page);
  expect(near.equals(faint)).toBe(false);
  await page.screenshot({ path: `${PICTURES}/change.png` });
  const { violations } = await new AxeBuilder({ page }).analyze();
  expect(violations.map(({ id }) => id)).toEqual([]);

  await page.keyboard.press('Escape'); // ends the tool
  await expect(panel).toBeHidden();
  await expect(page.locator('#list-title')).toHaveText('All objects');
});

test('answers what moved and where it was', async ({ page, home: map }) => {
  test.setTimeout(180_000);
  await page.goto(map.address);
  await wholePicture(page);
  await page.getByRole('combobox').fill('what changed since visit 1');
  await page.keyboard.press('Enter');
  await expect(page.locator('.verdict')).toContainText('Found', { timeout: 60_000 });
  await expect(page.locator('.verdict')).toContainText('read as [anything] that changed');
  await expect(page.locator('.row').first()).toContainText(/visit 2/);
  await page.screenshot({ path: `${PICTURES}/changed.png` });
  await page.getByRole('combobox').fill('what is gone');
  await page.keyboard.press('Enter');
  await expect(page.locator('.row[data-event]')).toHaveCount(1, { timeout: 60_000 });
  await page.locator('.row[data-event]').click();
  await page.waitForTimeout(1000);
  await page.screenshot({ path: `${PICTURES}/was.png` });
  await page.getByRole('combobox').fill('mug on 2020-01-01');
  await page.keyboard.press('Enter');
  await expect(page.locator('.verdict')).toContainText('the map begins on', { timeout: 60_000 });
});
