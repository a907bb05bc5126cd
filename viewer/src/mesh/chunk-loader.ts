// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from '../api/client';
import type { ChunkListing } from '../api/types';
import { type Chunk, decodeChunk } from './chunk-format';

export type ChunkConsumer = (chunk: Chunk, listing: ChunkListing) => void;
export type ProgressListener = (done: number, total: number) => void;

const AT_ONCE = 6; // what browsers allow for one server

export function chunkKey(at: { x: number; y: number; z: number }): string {
  return `${at.x},${at.y},${at.z}`;
}

/** Runs `work` on all items, a few at once. The first failure ends it. */
export async function forEachAtOnce<T>(
  items: readonly T[],
  atOnce: number,
  work: (item: T) => Promise<void>,
): Promise<void> {
  let next = 0;
  const runner = async (): Promise<void> => {
    while (next < items.length) {
      const item = items[next++]!;
      await work(item);
    }
  };
  await Promise.all(Array.from({ length: Math.min(atOnce, items.length) }, runner));
}

/** Fetches what of the chunks is newer than version `since`, in the given order, and hands each over as it arrives. */
export async function loadChunks(
  level: number,
  wanted: readonly ChunkListing[],
  since: number,
  consume: ChunkConsumer,
  onProgress: ProgressListener,
): Promise<void> {
  const weight = (chunk: ChunkListing): number => chunk.triangles + 1;
  const total = wanted.reduce((sum, chunk) => sum + weight(chunk), 0);
  let done = 0;
  onProgress(0, total);
  await forEachAtOnce(wanted, AT_ONCE, async (listing) => {
    const buffer = await api.chunk(level, listing, since);
    consume(decodeChunk(buffer), listing);
    done += weight(listing);
    onProgress(done, total);
  });
}
