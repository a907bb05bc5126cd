// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { App } from './app';
import { applyTheme, initialTheme } from './ui/theme';

applyTheme(initialTheme());
const root = document.getElementById('app');
if (root) void new App(root).start();
