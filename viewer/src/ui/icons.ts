// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Icons on a grid of 24, drawn for this page.

const PATHS = {
  search: 'M10.5 4a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13zM15.5 15.5 20 20',
  color: 'M12 3 3 8l9 5 9-5zM3 8v8l9 5 9-5V8M12 13v8',
  instances:
    'M4 4h7v7H4zM13 13h7v7h-7zM16.5 3.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7zM7.5 14 4 20h7z',
  classes: 'M4 12 12 4h8v8l-8 8zM16 8h.01',
  heat: 'M12 3c1 4 5 5.500 5 10.500a5 5 0 0 1-10 0c0-2 1-3.500 2-4.500 0 2 1 3 2 3 1.500-2 1-6 1-9z',
  evidence: 'M4 19h16M6 16v-4M10 16V8M14 16v-6M18 16V5',
  gaps: 'M3 12s3.500-6 9-6 9 6 9 6M12 9.500a2.500 2.500 0 1 0 2.500 2.500M15 18h6M18 15v6',
  measure: 'M3 16 16 3l5 5L8 21zM7 12l2 2M10 9l2.500 2.500M13 6l2 2',
  section: 'M4 20V8l8-4 8 4v12l-8-4zM4 8l8 4 8-4M12 12v4',
  stand: 'M12 3a2 2 0 1 0 0 4 2 2 0 0 0 0-4zM12 7v7M8 10h8M12 14l-3 7M12 14l3 7',
  path: 'M4 19c4 0 3-7 7-7s3 5 6 3M15 4h5v5M20 4l-6 6',
  rooms: 'M3 4h18v16H3zM13 4v6M13 14v6M3 14h5',
  history: 'M4 12a8 8 0 1 0 2.500-5.800M4 4v4h4M12 8v4l3 2',
  fly: 'M21 3 3 10l7 3 3 8zM10 13l5-5',
  home: 'M4 11 12 4l8 7M6 10v10h12V10',
  picture: 'M4 7h4l1.500-2h5L16 7h4v12H4zM12 10a3 3 0 1 0 0 6 3 3 0 0 0 0-6z',
  download: 'M12 4v11M7 11l5 5 5-5M4 20h16',
  theme: 'M12 4a8 8 0 1 0 8 8 6 6 0 0 1-8-8z',
  help: 'M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zM9.500 9.500a2.500 2.500 0 1 1 3.500 2.300c-.700.400-1 .900-1 1.700M12 16.500v.010',
  close: 'M6 6l12 12M18 6 6 18',
  focus: 'M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5M12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6z',
  rename: 'M4 20h4L19 9l-4-4L4 16zM13 7l4 4',
  merge: 'M6 4v4c0 4 6 4 6 8v4M18 4v4c0 4-6 4-6 8',
  split: 'M6 20v-4c0-4 6-4 6-8V4M18 20v-4c0-4-6-4-6-8',
  log: 'M5 5h14M5 10h14M5 15h8M15 18l2 2 4-4',
  hide: 'M3 12s3.500-6 9-6 9 6 9 6-3.500 6-9 6-9-6-9-6zM12 9.500a2.500 2.500 0 1 0 0 5 2.500 2.500 0 0 0 0-5zM4 20 20 4',
  lock: 'M6 11h12v9H6zM8.500 11V8a3.500 3.500 0 0 1 7 0v3',
  delete: 'M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13',
  alike: 'M8 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM16 12a4 4 0 1 0 0 8 4 4 0 0 0 0-8z',
} as const;

export type IconName = keyof typeof PATHS;

export function icon(name: IconName): SVGSVGElement {
  const ns = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(ns, 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('class', 'icon');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(ns, 'path');
  path.setAttribute('d', PATHS[name]);
  svg.append(path);
  return svg;
}
