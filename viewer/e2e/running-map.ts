// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { type ChildProcess, spawn } from 'node:child_process';
import { copyFileSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { type Page, test as base } from '@playwright/test';

const PROGRAM = process.env.OVIMAP_PROGRAM ?? '../build/release/bin/ovimap';
const MAP = process.env.OVIMAP_MAP ?? '';

/** `ovimap serve` on a copy of the map, so that tests may correct it. */
export class RunningMap {
  private constructor(
    readonly address: string,
    private readonly program: ChildProcess,
    private readonly folder: string,
  ) {}

  static async start(): Promise<RunningMap> {
    if (MAP === '') throw new Error('OVIMAP_MAP names no map; run these tests through ctest');
    const folder = mkdtempSync(join(tmpdir(), 'ovimap-e2e-'));
    const map = join(folder, 'tiny room.ovimap');
    copyFileSync(MAP, map);
    const program = spawn(PROGRAM, ['serve', map, '--port', '0', '--json', '--no-limits'], {
      stdio: ['ignore', 'pipe', 'inherit'],
    });
    const line = await new Promise<string>((resolve, reject) => {
      program.stdout!.once('data', (data: Buffer) => resolve(data.toString()));
      program.once('exit', (code) => reject(new Error(`ovimap serve ended with code ${code}`)));
    });
    return new RunningMap((JSON.parse(line) as { address: string }).address, program, folder);
  }

  /** Ends the program as Ctrl-C does. */
  async stop(): Promise<void> {
    const ended = new Promise((resolve) => this.program.once('exit', resolve));
    this.program.kill('SIGINT');
    await ended;
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export async function wholePicture(page: Page): Promise<void> {
  await page.waitForFunction(() => performance.getEntriesByName('whole-picture').length > 0, null, {
    timeout: 40_000,
  });
}

/** Tests share a server, as people do, and fail when the page reports a fault. */
export const test = base.extend<{ faults: void }, { map: RunningMap }>({
  map: [
    async ({}, use) => {
      const map = await RunningMap.start();
      await use(map);
      await map.stop();
    },
    { scope: 'worker', timeout: 60_000 },
  ],
  faults: [
    async ({ page }, use) => {
      const faults: string[] = [];
      page.on('pageerror', (error) => faults.push(error.message));
      await use();
      if (faults.length > 0) throw new Error(`the page failed: ${faults.join('; ')}`);
    },
    { auto: true },
  ],
});
