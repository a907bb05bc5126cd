// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0

/** Does work again and again as it is asked for, never twice at once, and not more often than a pause allows. */
export class Rounds {
  private wanted = false;
  private running: Promise<void> | null = null;

  constructor(
    private readonly work: () => Promise<void>,
    private readonly pauseMs: () => number,
  ) {}

  /** Resolves when work that began after this call is done; requests meanwhile share it. */
  request(): Promise<void> {
    this.wanted = true;
    this.running ??= this.run();
    return this.running;
  }

  private async run(): Promise<void> {
    try {
      while (this.wanted) {
        this.wanted = false;
        await this.work();
        if (this.wanted) await new Promise((resolve) => setTimeout(resolve, this.pauseMs()));
      }
    } finally {
      this.running = null;
    }
  }
}
