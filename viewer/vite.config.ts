// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vitest/config';

// OVIMAP_SERVER: where `npx vite` finds a running `ovimap serve` while working on the viewer.
const server = process.env.OVIMAP_SERVER ?? 'http://127.0.0.1:8080';

export default defineConfig({
  build: { target: 'es2022', chunkSizeWarningLimit: 1000, emptyOutDir: true },
  server: { proxy: { '/api': { target: server, changeOrigin: true } } },
  test: { include: ['tests/**/*.test.ts'] },
});
