// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0

export type Theme = 'dark' | 'light';
const KEY = 'ovimap-theme';

/** As chosen before, else as the system has it. */
export function initialTheme(): Theme {
  const stored = localStorage.getItem(KEY);
  if (stored === 'dark' || stored === 'light') return stored;
  return window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

export function applyTheme(theme: Theme): void {
  document.documentElement.dataset.theme = theme;
  localStorage.setItem(KEY, theme);
}

/** What the 3D view is drawn on. */
export function backgroundOf(theme: Theme): string {
  return theme === 'dark' ? '#15181d' : '#e9ecf1';
}
