// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ds {

/// The report's style sheet. Six series colours of Okabe and Ito's palette for colour-blind readers
/// (black and yellow, which vanish on one of the grounds, left out), lighter ones of the same hues
/// on dark. Print is light, on white, without shadows, and breaks no figure.
inline constexpr const char* k_page_style = R"css(
:root { color-scheme: light dark;
  --ground: #fdfdfc; --panel: #ffffff; --ink: #1b1f24; --soft: #5a6472; --rule: #d9dde3; --grid: #e8ebef;
  --guide: #98a2b0; --accent: #0a62a5; --stripe: #f5f7f9;
  --s0: #0072b2; --s1: #d55e00; --s2: #009e73; --s3: #b3589a; --s4: #b97a00; --s5: #3f8fc4; }
@media (prefers-color-scheme: dark) { :root {
  --ground: #14171b; --panel: #1b1f25; --ink: #e6e9ed; --soft: #a3adba; --rule: #343b45; --grid: #2a3039;
  --guide: #6d7886; --accent: #7cbcf0; --stripe: #20252c;
  --s0: #56b4e9; --s1: #ff9a57; --s2: #3ccfa0; --s3: #e59bcb; --s4: #f0c04a; --s5: #9cc9ff; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 32px 24px 64px; }
h1 { font-size: 28px; line-height: 1.2; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 20px; margin: 44px 0 8px; padding-top: 14px; border-top: 1px solid var(--rule); }
h3 { font-size: 15px; margin: 22px 0 6px; }
p { margin: 6px 0 10px; max-width: 92ch; }
p.lead { color: var(--soft); margin-bottom: 18px; }
a { color: var(--accent); }
dl.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 10px 24px;
  margin: 18px 0; }
dl.facts dt { color: var(--soft); font-size: 12.5px; }
dl.facts dd { margin: 0; font-weight: 600; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13.5px; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 10px; text-align: right; white-space: nowrap; }
th { font-weight: 600; color: var(--soft); border-bottom: 1px solid var(--rule); vertical-align: bottom; }
th.text, td.text { text-align: left; }
tbody tr:nth-child(even) { background: var(--stripe); }
tbody td { border-bottom: 1px solid var(--grid); }
td small { color: var(--soft); font-size: 11.5px; display: block; line-height: 1.2; }
td .far { font-style: italic; }
td.why { color: var(--soft); font-size: 12.5px; white-space: normal; min-width: 21ch; }
p.note { color: var(--soft); font-size: 13px; }
figure { margin: 12px 0 22px; }
figure .plots { display: flex; flex-wrap: wrap; align-items: flex-start; gap: 10px; }
figure .plots > svg { background: var(--panel); border: 1px solid var(--rule); border-radius: 6px;
  max-width: 100%; height: auto; }
figcaption { color: var(--soft); font-size: 13px; margin-top: 6px; max-width: 90ch; }
p.legend { display: flex; flex-wrap: wrap; gap: 4px 18px; font-size: 13px; margin: 4px 0 8px; max-width: none; }
p.legend span { display: inline-flex; align-items: center; gap: 6px; }
svg text { font: 10.5px system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; fill: var(--ink); }
svg text.title { font-size: 12px; font-weight: 600; }
svg text.tick, svg text.none, svg text.guide-text { fill: var(--soft); font-size: 10px; }
svg text.label { fill: var(--soft); }
.grid { stroke: var(--grid); } .grid.faint { stroke-opacity: 0.55; } .axis { stroke: var(--guide); }
.guide { stroke: var(--guide); stroke-dasharray: 4 3; }
.range { stroke: var(--ink); stroke-width: 1.2; }
.less { fill: var(--s0); fill-opacity: 0.6; } .more { fill: var(--s1); fill-opacity: 0.6; }
.line { fill: none; stroke-width: 1.6; } .bar { stroke-width: 1.1; stroke-opacity: 0.75; }
.mark { stroke: var(--panel); stroke-width: 0.8; fill-rule: evenodd; }
.line.s0, .bar.s0 { stroke: var(--s0); } .mark.s0 { fill: var(--s0); }
.line.s1, .bar.s1 { stroke: var(--s1); } .mark.s1 { fill: var(--s1); }
.line.s2, .bar.s2 { stroke: var(--s2); } .mark.s2 { fill: var(--s2); }
.line.s3, .bar.s3 { stroke: var(--s3); } .mark.s3 { fill: var(--s3); }
.line.s4, .bar.s4 { stroke: var(--s4); } .mark.s4 { fill: var(--s4); }
.line.s5, .bar.s5 { stroke: var(--s5); } .mark.s5 { fill: var(--s5); }
@page { size: A4; margin: 14mm; }
@media print {
  :root { color-scheme: light; --ground: #fff; --panel: #fff; --ink: #000; --soft: #444; --rule: #bbb; --grid: #ddd;
    --guide: #777; --accent: #000; --stripe: #fff;
    --s0: #0072b2; --s1: #d55e00; --s2: #009e73; --s3: #b3589a; --s4: #b97a00; --s5: #3f8fc4; }
  body { font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  table { font-size: 8pt; } th, td { padding: 2px 5px; }
  figure .plots { gap: 6px; }
  figure .plots > svg { width: calc(50% - 3px); break-inside: avoid; }
  figure.choices .plots > svg { width: 100%; max-width: 150mm; }
  h2, h3, p.legend { break-after: avoid; }
  tr, figcaption { break-inside: avoid; }
  .scroll { overflow: visible; }
  a[download] { display: none; }
}
)css";

}  // namespace ds
