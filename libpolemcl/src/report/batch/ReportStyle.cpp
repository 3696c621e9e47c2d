#include "report/batch/ReportParts.h"

namespace polemcl::report {

// Series colours: Okabe and Ito (2008), darker on paper and lighter at night, so that each keeps a
// contrast of at least 3 to 1 with its background.
const char* const reportStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #fcfbf8; --ink: #1d1f23; --muted: #5d6269; --rule: #d9d6ce; --panel: #f4f2ec;
  --link: #0b5f93; --bad: #b3261e; --bad-paper: #fbe9e7; --good: #1b7f5c; --fair: #b07d00;
  --s0: #0072b2; --s1: #c65102; --s2: #00805d; --s3: #a3447f; --s4: #7d6608; --s5: #4a5bd0;
  --pole: #c65102; --truth: #b9bdc4; --estimate: #0072b2;
  --serif: "Iowan Old Style", "Palatino Linotype", Palatino, "Book Antiqua", P052, Georgia,
    "DejaVu Serif", serif;
  --sans: system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", Arial,
    sans-serif;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #15171a; --ink: #e7e5df; --muted: #a4a8af; --rule: #363a40; --panel: #1d2024;
    --link: #7cc0ee; --bad: #ff8f85; --bad-paper: #3a201e; --good: #4fd1a5; --fair: #e5b94b;
    --s0: #5ab4ec; --s1: #ff9a52; --s2: #3fce9f; --s3: #e49ac8; --s4: #e2cb52; --s5: #a3adff;
    --pole: #ff9a52; --truth: #767d87; --estimate: #5ab4ec;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; scroll-behavior: smooth; }
body {
  margin: 0; background: var(--paper); color: var(--ink);
  font: 17px/1.55 var(--serif); font-variant-numeric: lining-nums;
}
main, header, footer { max-width: 1040px; margin: 0 auto; padding: 0 20px; }
header { padding-top: 44px; }
footer { padding-bottom: 60px; color: var(--muted); font-size: 15px; }
h1 { font-size: 34px; line-height: 1.18; font-weight: 600; margin: 0 0 6px; text-wrap: balance; }
h2 {
  font-size: 24px; line-height: 1.25; font-weight: 600; margin: 56px 0 12px; padding-top: 14px;
  border-top: 1px solid var(--rule);
}
h3 { font-size: 19px; line-height: 1.3; font-weight: 600; margin: 32px 0 8px; }
h1, h2, h3, p, li, dd, td, th, figcaption { overflow-wrap: break-word; }
p { margin: 0 0 14px; max-width: 46em; }
a { color: var(--link); text-underline-offset: 2px; }
.over { font: 600 13px/1.4 var(--sans); letter-spacing: .06em; color: var(--muted); margin: 0 0 8px; }
.meta { color: var(--muted); font-size: 16px; margin: 0 0 18px; }
nav ul {
  list-style: none; display: flex; flex-wrap: wrap; gap: 4px 18px; margin: 18px 0 0; padding: 0;
  font: 15px/1.6 var(--sans);
}
nav a { text-decoration: none; display: inline-block; padding: 3px 0; }
nav a:hover { text-decoration: underline; }
.lead p { font-size: 19px; line-height: 1.5; }
.alarm { border-left: 4px solid var(--bad); background: var(--bad-paper); padding: 10px 14px; }
.note { color: var(--muted); font-size: 15.5px; }
ul.note { padding-left: 18px; margin: 0 0 14px; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(270px, 1fr)); gap: 16px; margin: 26px 0; }
.card { border: 1px solid var(--rule); border-top: 4px solid var(--c); border-radius: 3px; padding: 12px 18px 14px; min-width: 0; max-width: 512px; }
.card h2 { margin: 0; padding: 0; border: 0; font-size: 17px; }
.card .big { font-size: 40px; line-height: 1.2; margin: 4px 0 0; font-variant-numeric: lining-nums tabular-nums; }
.card .big span { font-size: 18px; color: var(--muted); }
.card .what { font: 13.5px/1.4 var(--sans); color: var(--muted); margin: 0 0 10px; }
dl.facts { display: grid; grid-template-columns: auto 1fr; gap: 2px 16px; margin: 0; font: 14.5px/1.5 var(--sans); }
dl.facts dt { color: var(--muted); }
dl.facts dd { margin: 0; font-variant-numeric: tabular-nums; min-width: 0; }
dl.terms dt { font-weight: 600; margin-top: 10px; }
dl.terms dd { margin: 0; max-width: 46em; }
.scroll { overflow-x: auto; max-width: 100%; }
.scroll:focus-visible { outline: 2px solid var(--link); outline-offset: 2px; }
table {
  border-collapse: collapse; font: 14.5px/1.35 var(--sans); font-variant-numeric: tabular-nums;
  border-top: 2px solid var(--ink); border-bottom: 2px solid var(--ink); margin: 8px 0 20px;
}
caption { caption-side: top; text-align: left; color: var(--muted); font: 15.5px/1.4 var(--serif); padding: 6px 0 8px; }
caption span { display: inline-block; position: sticky; left: 0; max-width: min(46em, 100vw - 40px); }
th, td { padding: 5px 10px; text-align: right; white-space: nowrap; font-weight: 400; }
thead th { font-weight: 600; vertical-align: bottom; }
thead tr:last-child > * { border-bottom: 1px solid var(--ink); }
thead th[scope="colgroup"] { text-align: center; border-bottom: 1px solid var(--rule); }
tbody tr + tr > * { border-top: 1px solid var(--rule); }
tfoot tr:first-child > * { border-top: 1px solid var(--ink); }
tfoot th, tfoot td { font-weight: 600; }
th:first-child, td:first-child { text-align: left; padding-left: 2px; }
tbody th, tfoot th, thead tr > :first-child { position: sticky; left: 0; background: var(--paper); max-width: 15em; overflow: hidden; text-overflow: ellipsis; }
table.dense th, table.dense td { padding: 4px 3px; font-size: 12.3px; letter-spacing: -.01em; }
table.dense tfoot th, table.dense td:last-child { white-space: normal; }
table.words td, table.words thead th { text-align: left; }
table.words td { white-space: normal; min-width: 8em; }
table.words tbody th { white-space: normal; min-width: 11em; }
table.remark tr > :last-child { text-align: left; white-space: normal; min-width: 14em; }
tr.bad td:last-child, span.bad { color: var(--bad); }
tr.ours > * { font-weight: 600; }
.sd { color: var(--muted); }
sub { line-height: 0; }
.bar { display: inline-flex; vertical-align: middle; width: 130px; height: 10px; background: var(--rule); }
.bar i { display: block; height: 100%; }
.bar .ok { background: var(--good); } .bar .degraded { background: var(--fair); } .bar .lost { background: var(--bad); }
figure { margin: 18px 0 24px; min-width: 0; }
figcaption { color: var(--muted); font-size: 15.5px; line-height: 1.45; margin-top: 4px; max-width: 46em; }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 330px), 1fr)); gap: 0 28px; align-items: start; }
svg.plot { display: block; width: 100%; height: auto; }
svg.wide { min-width: 780px; }
.two figure { max-width: 640px; }
svg.key { width: 34px; height: 14px; flex: none; }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: 2px 20px; margin: 4px 0; padding: 0; font: 14px/1.5 var(--sans); }
.legend li { display: flex; align-items: center; gap: 7px; min-width: 0; overflow-wrap: anywhere; }
.label { font: 13px var(--sans); fill: var(--muted); font-variant-numeric: tabular-nums; }
.label.title { fill: var(--ink); }
.panel { fill: var(--panel); }
.grid { stroke: var(--rule); stroke-width: 1; fill: none; }
.c0 { --c: var(--s0); } .c1 { --c: var(--s1); } .c2 { --c: var(--s2); }
.c3 { --c: var(--s3); } .c4 { --c: var(--s4); } .c5 { --c: var(--s5); }
.line { stroke: var(--c); stroke-width: 2; fill: none; stroke-linejoin: round; }
.line.c1 { stroke-dasharray: 7 3; } .line.c2 { stroke-dasharray: 2 3; }
.line.c3 { stroke-dasharray: 9 3 2 3; } .line.c4 { stroke-dasharray: 12 4; } .line.c5 { stroke-dasharray: 4 2; }
.line.thin { stroke-width: 1.4; opacity: .75; }
.line.fine { stroke-width: 1.3; stroke-dasharray: none; }
.key .line.fine { stroke-width: 2.4; }
.spread { stroke: var(--c); stroke-width: 2; opacity: .5; }
.area { fill: var(--c); opacity: .13; }
.mark { fill: var(--c); stroke: var(--paper); stroke-width: 1; }
.arrow { stroke: var(--c); stroke-width: 2.2; fill: none; }
.poles { stroke: var(--pole); stroke-width: 3.2; stroke-linecap: round; fill: none; }
.truth { stroke: var(--truth); stroke-width: 5; fill: none; stroke-linejoin: round; stroke-linecap: round; }
.estimate { stroke: var(--estimate); stroke-width: 1.6; fill: none; stroke-linejoin: round; }
.start { stroke: var(--ink); stroke-width: 9; stroke-linecap: round; }
details { border-top: 1px solid var(--rule); padding: 4px 0; }
details:last-of-type { border-bottom: 1px solid var(--rule); }
summary { cursor: pointer; padding: 7px 0; font: 15.5px/1.4 var(--sans); overflow-wrap: anywhere; }
summary .figures { color: var(--muted); font-variant-numeric: tabular-nums; }
pre { font: 13px/1.5 ui-monospace, "SF Mono", "DejaVu Sans Mono", Menlo, Consolas, monospace; background: var(--panel); padding: 12px 14px; overflow-x: auto; margin: 8px 0 16px; }
code { font: 14px/1.5 ui-monospace, "SF Mono", "DejaVu Sans Mono", Menlo, Consolas, monospace; overflow-wrap: anywhere; }
@media (max-width: 600px) {
  body { font-size: 16px; }
  header { padding-top: 26px; }
  main, header, footer { padding-left: 16px; padding-right: 16px; }
  h1 { font-size: 27px; } h2 { font-size: 22px; margin-top: 44px; }
  .lead p { font-size: 17px; }
  th, td { padding: 5px 9px; }
  tbody th, tfoot th { max-width: 11.5em; }
}
@media print {
  :root { --paper: #fff; }
  nav { display: none; }
  body { font-size: 11pt; }
  figure, table { break-inside: avoid; }
}
)css";

}  // namespace polemcl::report
