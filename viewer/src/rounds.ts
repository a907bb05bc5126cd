// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0

/** Does work again and again as it is asked for, never twice at once, and not more often than a pause allows. */
export class Rounds {
  private current: Promise<void> = Promise.resolve();
  private next: Promise<void> | null = null; // asked for, not begun
  private ended = -Infinity; // when the latest round was done

  constructor(
    private readonly work: () => Promise<void>,
    private readonly pauseMs: () => number,
  ) {}

  /** Resolves when a round that began after this call is done; requests meanwhile share it. */
  request(): Promise<void> {
    this.next ??= this.round(this.current);
    return this.next;
  }

  private async round(before: Promise<void>): Promise<void> {
    await before.catch(() => undefined); // who asked for it was told
    const pause = this.ended + this.pauseMs() - performance.now();
    if (pause > 0) await new Promise((resolve) => setTimeout(resolve, pause));
    this.current = this.next ?? Promise.resolve();
    this.next = null;
    try {
      await this.work();
    } finally {
      this.ended = performance.now();
    }
  }
}
