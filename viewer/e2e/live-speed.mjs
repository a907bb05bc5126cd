// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Measures what serving costs the mapping, and what a client of a map that is being made is sent. Nothing is dropped in the first part, so
// that the time to map all frames tells how fast the mapping is; three ways take turns. Usage, in viewer/: node e2e/live-speed.mjs PROGRAM RECORDING [rounds]
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { get } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [program, recording, rounds = '5'] = process.argv.slice(2);
if (!program || !recording) {
  console.error('usage: node e2e/live-speed.mjs PROGRAM RECORDING [rounds]');
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'ovimap-live-'));
const map = join(folder, 'map.ovimap');
const ALL_FRAMES = ['--fps', '1000', '--set', 'live.queue=100000', '--set', 'checkpoint.seconds=0'];
const networks = ['--masks', 'none', '--encoder', 'none'];
const options = (args) => [recording, '-o', map, '--live', '--json', ...networks, ...args];
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** A client that does what the page does, but draws nothing. Counts bytes as they come over the wire. */
class Client {
  bytes = 0;
  patches = 0;
  seen = 0;
  busy = false;
  again = false;
  agent = { 'Accept-Encoding': 'zstd, gzip' };

  constructor(address) {
    this.address = address;
  }
  fetch(path, headers = this.agent) {
    return new Promise((resolve) => {
      get(this.address + path, { headers }, (reply) => {
        const parts = [];
        reply.on('data', (part) => parts.push(part));
        reply.on('end', () => resolve(Buffer.concat(parts)));
        reply.on('error', () => resolve(Buffer.alloc(0)));
      }).on('error', () => resolve(Buffer.alloc(0)));
    });
  }
  listen() {
    get(`${this.address}api/events`, (reply) => {
      reply.setEncoding('utf8');
      reply.on('data', (text) => {
        this.bytes += text.length;
        if (text.includes('event: mesh')) void this.follow();
        if (text.includes('event: map')) void this.objects();
      });
      reply.on('error', () => undefined);
    }).on('error', () => undefined);
  }
  async objects() {
    for (const path of ['api/map', 'api/instances', 'api/labels'])
      this.bytes += (await this.fetch(path)).length;
  }
  async follow() {
    this.again = true;
    if (this.busy) return;
    this.busy = true;
    while (this.again) {
      this.again = false;
      const text = await this.fetch(`api/mesh?level=0&since=${this.seen}`, {});
      if (text.length === 0) break;
      this.bytes += text.length;
      const { version, chunks } = JSON.parse(text);
      for (const { x, y, z } of chunks) {
        const path = `api/mesh/0/${x}/${y}/${z}?since=${this.seen}`;
        const size = (await this.fetch(path)).length;
        this.bytes += size;
        this.patches += size;
      }
      this.seen = version;
    }
    this.busy = false;
  }
}

function run(args) {
  return new Promise((resolve) => {
    const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'inherit'] });
    let text = '';
    child.stdout.on('data', (data) => (text += data));
    child.on('exit', () => resolve(JSON.parse(text)));
  });
}

/** Maps and serves. Returns what the program says of the run, and what the client was sent while it lasted. */
function serve(args, withClient) {
  return new Promise((resolve) => {
    const child = spawn(program, ['serve', ...args, '--port', '0', '--no-limits'], {
      stdio: ['ignore', 'pipe', 'inherit'],
    });
    let client = null;
    let start = 0;
    let result = null;
    let text = '';
    child.stdout.on('data', (data) => {
      text += data;
      const lines = text.split('\n');
      text = lines.pop();
      for (const line of lines.map((each) => JSON.parse(each))) {
        if (line.address && withClient) {
          client = new Client(line.address);
          client.listen();
          start = performance.now();
        }
        if (!line.saved) continue;
        const seconds = (performance.now() - start) / 1000;
        result = { ...line.saved, sent: client && { ...client, seconds } };
        child.kill('SIGINT');
      }
    });
    child.on('exit', () => resolve(result));
  });
}

const ways = {
  '`ovimap run --live`': () => run(['run', ...options(ALL_FRAMES)]),
  '`ovimap serve --live`, nobody looks': () => serve(options(ALL_FRAMES), false),
  '`ovimap serve --live`, a client follows': () => serve(options(ALL_FRAMES), true),
};
const done = Object.fromEntries(Object.keys(ways).map((way) => [way, []]));
for (let round = 0; round < Number(rounds); ++round)
  for (const [way, map] of Object.entries(ways)) done[way].push(await map());
const at30 = await serve(options(['--fps', '30']), true);
rmSync(folder, { recursive: true, force: true });

const of = (way, key) => median(done[way].map((result) => result[key]));
const [base] = Object.keys(ways);
const more = (way, key) => `${((of(way, key) / of(base, key) - 1) * 100).toFixed(1)} %`;
console.log('| all frames mapped, medians | seconds | more | CPU seconds | more |');
console.log('| --- | --- | --- | --- | --- |');
for (const way of Object.keys(ways)) {
  const [seconds, cpu] = ['seconds', 'cpu_seconds'].map((key) => of(way, key).toFixed(2));
  console.log(
    `| ${way} | ${seconds} | ${more(way, 'seconds')} | ${cpu} | ${more(way, 'cpu_seconds')} |`,
  );
}
const { sent, live } = at30;
console.log(
  `\nAt 30 frames a second: ${live.frames_fused} frames fused, ${live.frames_dropped} dropped; ` +
    `sent ${(sent.bytes / sent.seconds / 1e6).toFixed(2)} MB/s in ${sent.seconds.toFixed(1)} s, ${(sent.patches / sent.seconds / 1e6).toFixed(2)} MB/s of it patches.`,
);
