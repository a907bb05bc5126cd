// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { api } from './api/client';
import type { MapView } from './scene/map-view';
import { download } from './ui/dom';
import { Help } from './ui/help';
import type { Status } from './ui/status';
import { applyTheme, backgroundOf, initialTheme, type Theme } from './ui/theme';
import type { Command } from './ui/toolbar';
import { faultText } from './ui/words';

/** What the buttons at the end of the bar do. */
export class Commands {
  readonly help = new Help();
  private shown: MapView | null = null;
  private theme: Theme = initialTheme();

  constructor(
    private readonly status: Status,
    private readonly title: () => string,
    private readonly showLog: () => void,
  ) {}

  set view(view: MapView) {
    this.shown = view;
    view.setTheme(backgroundOf(this.theme));
  }

  run(command: Command): void {
    if (command === 'help') this.help.toggle();
    if (command === 'home') this.shown?.frameAll(true);
    if (command === 'theme') this.switchTheme();
    if (command === 'log') this.showLog();
    if (command === 'picture') void this.savePicture();
    if (command === 'download') void this.saveGlb();
  }

  private switchTheme(): void {
    this.theme = this.theme === 'dark' ? 'light' : 'dark';
    applyTheme(this.theme);
    this.shown?.setTheme(backgroundOf(this.theme));
  }

  private async savePicture(): Promise<void> {
    const picture = await this.shown?.picture();
    if (picture) download(picture, `${this.title()}.png`);
    else this.status.toast('There is no picture to save');
  }

  private async saveGlb(): Promise<void> {
    try {
      download(await api.glb(), `${this.title()}.glb`);
    } catch (error) {
      this.status.toast(faultText(error));
    }
  }
}
