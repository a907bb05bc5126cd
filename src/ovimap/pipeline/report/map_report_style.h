// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace ovimap {

/// The style sheet of map_report_html: light and dark, phone and desk, screen and paper.
inline constexpr std::string_view kMapReportStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f4f5f7; --card: #fff; --text: #1a1e24; --muted: #565f6b; --line: #d9dde3;
  --well: #eceef2; --link: #0b57b8; --bar: #c9dcf6; --dim: 1;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #0e1116; --card: #171b22; --text: #e7eaef; --muted: #9ba5b3; --line: #2b323c;
    --well: #0e1116; --link: #7db4ff; --bar: #24446e; --dim: .86;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body {
  margin: 0; background: var(--page); color: var(--text);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif;
}
header, main, footer { max-width: 80rem; margin: 0 auto; padding: 0 clamp(1rem, 4vw, 2.5rem); }
header { padding-top: clamp(1.25rem, 4vw, 2.5rem); }
h1, h2, h3 { line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h1 { font-size: clamp(1.6rem, 1.2rem + 2vw, 2.4rem); letter-spacing: -.015em; }
h2 { font-size: 1.35rem; margin: 2.5rem 0 .75rem; }
h3 { font-size: 1.05rem; }
p { margin: .5rem 0; max-width: 46rem; }
a { color: var(--link); }
a:focus-visible, summary:focus-visible, [tabindex]:focus-visible {
  outline: 3px solid var(--link); outline-offset: 2px;
}
.muted, figcaption, dt, footer { color: var(--muted); }
nav { display: flex; flex-wrap: wrap; gap: .25rem 1.25rem; margin-top: 1rem; }
nav a { padding: .35rem 0; }
dl { margin: 0; }
dd { margin: 0; }
.tiles { display: flex; flex-wrap: wrap; gap: .5rem 2.5rem; margin: 1.1rem 0 .75rem; }
.tiles div { display: flex; flex-direction: column-reverse; }
.tiles dd { font-size: 1.7rem; font-weight: 650; line-height: 1.15; }
.tiles dt { font-size: .875rem; }
.facts { display: grid; grid-template-columns: max-content 1fr; gap: .2rem 1rem; font-size: .9375rem; }
.facts div { display: contents; }
.facts dd { overflow-wrap: anywhere; min-width: 0; }
.views { display: grid; gap: 1.25rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); }
figure { margin: 0; }
.views img {
  display: block; width: 100%; height: auto; border-radius: .6rem; border: 1px solid var(--line);
  filter: brightness(var(--dim));
}
figcaption { font-size: .9375rem; margin-top: .4rem; }
.cards {
  display: grid; gap: 1rem; align-items: start; margin-top: 1rem;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 17.5rem), 1fr));
}
.card {
  background: var(--card); border: 1px solid var(--line); border-radius: .6rem; padding: .9rem 1rem 1rem;
  border-top: .4rem solid var(--color); break-inside: avoid; scroll-margin-top: 1rem;
}
.card:target { outline: 3px solid var(--link); outline-offset: 2px; }
.card h3 { display: flex; align-items: center; gap: .55rem; }
.swatch {
  flex: none; width: 1.1rem; height: 1.1rem; border-radius: .3rem; background: var(--color);
  box-shadow: inset 0 0 0 1px rgb(128 128 128 / .6);
}
.id { margin-left: auto; font-weight: 400; font-size: .9375rem; color: var(--muted); }
.crops { display: grid; grid-template-columns: repeat(3, 1fr); gap: .35rem; margin: .75rem 0; }
.crops img {
  display: block; width: 100%; aspect-ratio: 1; object-fit: contain; background: var(--well);
  border-radius: .35rem; filter: brightness(var(--dim));
}
.crops img:first-child { grid-column: 1 / -1; aspect-ratio: 4 / 3; }
.none {
  display: grid; place-items: center; aspect-ratio: 4 / 3; margin: .75rem 0; padding: 1rem;
  border-radius: .35rem; background: var(--well); color: var(--muted); font-size: .9375rem;
  text-align: center;
}
.guesses { list-style: none; margin: .5rem 0; padding: 0; }
.guesses li { display: flex; justify-content: space-between; gap: 1rem; }
.guesses li:first-child { font-weight: 650; }
.score, td { font-variant-numeric: tabular-nums; }
.score { color: var(--muted); font-weight: 400; }
.card .facts {
  font-size: .875rem; border-top: 1px solid var(--line); padding-top: .6rem; margin-top: .75rem;
  font-variant-numeric: tabular-nums;
}
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; }
table { border-collapse: collapse; width: 100%; font-size: .9375rem; }
th, td { padding: .4rem .9rem; text-align: right; white-space: nowrap; }
th:first-child { text-align: left; }
caption { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
thead th { color: var(--muted); font-weight: 600; border-bottom: 1px solid var(--line); }
tbody th { font-weight: 500; }
tbody tr + tr > * { border-top: 1px solid var(--line); }
.bar { width: 40%; min-width: 6rem; }
.bar span { display: block; height: .7rem; border-radius: .2rem; background: var(--bar); }
details {
  background: var(--card); border: 1px solid var(--line); border-radius: .6rem; margin-top: .75rem;
}
summary { cursor: pointer; padding: .7rem 1rem; font-weight: 600; }
pre {
  margin: 0; padding: .25rem 1rem 1rem; overflow-x: auto;
  font: .8125rem/1.55 ui-monospace, SFMono-Regular, Menlo, Consolas, monospace;
}
footer { margin-top: 3rem; padding-bottom: 2rem; font-size: .875rem; }
@media print {
  body { background: none; }
  nav { display: none; }
  .views { grid-template-columns: 1fr 1fr; }
}
)css";

}  // namespace ovimap
