// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// What the scripts beside this one begin with: a map that is served, and a browser.
import { spawn } from 'node:child_process';
import { chromium } from '@playwright/test';

export async function serve(program, map) {
  const server = spawn(program, ['serve', map, '--port', '0', '--json', '--no-limits'], {
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  const { address } = await new Promise((resolve, reject) => {
    server.stdout.once('data', (line) => resolve(JSON.parse(line)));
    server.once('exit', (code) => reject(new Error(`ovimap serve ended with code ${code}`)));
  });
  return { server, address };
}

export const launch = () =>
  chromium.launch({
    executablePath: process.env.OVIMAP_CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--enable-unsafe-swiftshader'],
  });
