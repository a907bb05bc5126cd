// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { type ChildProcess, execFileSync, spawn } from 'node:child_process';
import { copyFileSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { type Page, test as base } from '@playwright/test';

const PROGRAM = process.env.OVIMAP_PROGRAM ?? '../build/release/bin/ovimap';
const MAP = process.env.OVIMAP_MAP ?? '';
const HOME = process.env.OVIMAP_HOME ?? ''; // a map of two visits
const ROOM = process.env.OVIMAP_ROOM ?? ''; // the recording that the map was made from

function place(): { folder: string; file: string } {
  if (MAP === '') throw new Error('OVIMAP_MAP names no map; run these tests through ctest');
  const folder = mkdtempSync(join(tmpdir(), 'ovimap-e2e-'));
  return { folder, file: join(folder, 'tiny room.ovimap') };
}

/** What the program says of a map file. */
export function infoOf(file: string): { frames: number; instances: { name?: string }[] } {
  return JSON.parse(execFileSync(PROGRAM, ['info', file, '--json'], { encoding: 'utf8' }));
}

/** `ovimap serve` on a copy of the map, so that tests may correct it. */
export class RunningMap {
  private constructor(
    readonly address: string,
    private readonly program: ChildProcess,
    readonly folder: string,
    readonly file: string,
  ) {}

  static async start(): Promise<RunningMap> {
    const { folder, file } = place();
    copyFileSync(MAP, file);
    return RunningMap.run([file], folder, file);
  }

  /** A map of two visits. */
  static async home(): Promise<RunningMap> {
    const { folder, file } = place();
    copyFileSync(HOME, file);
    return RunningMap.run([file], folder, file);
  }

  /** The map while it is made from its recording, with a camera of one frame a second. */
  static async live(): Promise<RunningMap> {
    const { folder, file } = place();
    const options = [
      '--live',
      '--fps',
      '1',
      '--masks',
      'gt',
      '--encoder',
      'default',
      '--set',
      'map.voxel_size_m=0.02',
    ];
    return RunningMap.run([ROOM, '-o', file, ...options], folder, file);
  }

  private static async run(args: string[], folder: string, file: string): Promise<RunningMap> {
    const program = spawn(PROGRAM, ['serve', ...args, '--port', '0', '--json', '--no-limits'], {
      stdio: ['ignore', 'pipe', 'inherit'],
    });
    const line = await new Promise<string>((resolve, reject) => {
      program.stdout!.once('data', (data: Buffer) => resolve(data.toString()));
      program.once('exit', (code) => reject(new Error(`ovimap serve ended with code ${code}`)));
    });
    const { address } = JSON.parse(line) as { address: string };
    return new RunningMap(address, program, folder, file);
  }

  /** Ends the program as Ctrl-C does. Returns its exit code. */
  async interrupt(): Promise<number | null> {
    const ended = new Promise<number | null>((resolve) => this.program.once('exit', resolve));
    this.program.kill('SIGINT');
    return ended;
  }

  async stop(): Promise<void> {
    if (this.program.exitCode === null) await this.interrupt();
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export async function wholePicture(page: Page): Promise<void> {
  await page.waitForFunction(() => performance.getEntriesByName('whole-picture').length > 0, null, {
    timeout: 90_000,
  });
}

/** Tests share a server, as people do, and fail when the page reports a fault. */
export const test = base.extend<
  { faults: void; live: RunningMap; home: RunningMap },
  { map: RunningMap }
>({
  map: [
    async ({}, use) => {
      const map = await RunningMap.start();
      await use(map);
      await map.stop();
    },
    { scope: 'worker', timeout: 60_000 },
  ],
  /** A map while it is made, for one test alone; ended however the test ends. */
  live: async ({}, use) => {
    const live = await RunningMap.live();
    await use(live);
    await live.stop();
  },
  home: async ({}, use) => {
    const home = await RunningMap.home();
    await use(home);
    await home.stop();
  },
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
