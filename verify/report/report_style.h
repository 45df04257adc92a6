// The style sheet of the report's page: one column on narrow screens, two on wide ones, and light
// or dark colours as the reader's system prefers.
#pragma once

namespace svdag {

inline constexpr const char* kReportStyle = R"(
:root { color-scheme: light dark; --page: #fbfaf8; --card: #fff; --ink: #1d2329; --dim: #626c76;
  --line: #dfe2e5; --one: #2f6db3; --two: #c8641b; --three: #8a63b8; --good: #2b8a57; --bad: #c0392b; --note: #c98a00; }
@media (prefers-color-scheme: dark) { :root { --page: #14171a; --card: #1d2226; --ink: #e6e9ec; --dim: #98a2ac;
  --line: #363d44; --one: #6aa7ea; --two: #ee9450; --three: #b898e0; --good: #4bbf83; --bad: #ef6b5e; --note: #e6b23c; } }
* { box-sizing: border-box; }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page); max-width: 66rem;
  margin: 0 auto; padding: 1.5rem 1rem 3rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2.4rem 0 .6rem; }
sup { line-height: 0; font-size: .7em; } p { margin: .5rem 0; } .dim, footer { color: var(--dim); font-size: .9rem; }
code { font-size: .85em; overflow-wrap: anywhere; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(8.5rem, 1fr)); gap: .7rem; margin: 1.1rem 0; }
.tiles div, .plot, .card { background: var(--card); border: 1px solid var(--line); border-radius: .5rem; }
.tiles div { padding: .6rem .8rem; } .tiles b { display: block; font-size: 1.25rem; line-height: 1.3; }
.tiles span { color: var(--dim); font-size: .85rem; }
.verdict { padding: .6rem 1rem; border-radius: .5rem; background: var(--card); border: 1px solid var(--line);
  border-left: .4rem solid; overflow-wrap: anywhere; }
.verdict.good { border-left-color: var(--good); } .verdict.bad { border-left-color: var(--bad); }
.verdict.note { border-left-color: var(--note); }
figure { margin: 0; } figcaption { color: var(--dim); font-size: .9rem; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(18rem, 100%), 1fr)); gap: 1rem; }
.pictures figure:first-child { grid-column: 1 / -1; }
.pictures img { width: 100%; height: auto; display: block; border-radius: .5rem; }
.pictures figcaption { padding: .2rem .1rem; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(22rem, 100%), 1fr)); gap: 1rem; }
.plot { padding: .7rem .8rem; } .plot figcaption { color: var(--ink); font-weight: 600; margin-bottom: .3rem; }
svg { width: 100%; height: auto; display: block; } svg text { font: 11px system-ui, sans-serif; fill: var(--dim); }
svg path { fill: none; stroke-width: 2; stroke: currentColor; } svg circle { fill: currentColor; }
svg .grid, svg .axis { stroke: var(--line); } svg .column { fill: var(--one); }
.one { color: var(--one); } .two { color: var(--two); } .three { color: var(--three); }
.legend { margin: .2rem 0 0; font-size: .85rem; } .legend span { margin-right: .8rem; white-space: nowrap; }
.legend span::before { content: "\25CF\00A0"; }
.card { padding: .2rem .6rem; overflow-x: auto; }
table { border-collapse: collapse; width: 100%; } td, th { padding: .3rem .5rem; vertical-align: top; }
.card tr + tr > * { border-top: 1px solid var(--line); }
th { text-align: left; font-weight: 500; } .facts th { width: 38%; color: var(--dim); font-weight: 400; }
.facts td { overflow-wrap: anywhere; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.bars th { color: var(--dim); font-weight: 400; width: 1%; white-space: nowrap; padding-left: 0; } .bars .n { width: 1%; padding-right: 0; }
.bar { vertical-align: middle; } .bar div { background: currentColor; height: .8rem; border-radius: .2rem; min-width: 1px; }
.viewer { height: min(34rem, 75vh); border: 1px solid var(--line); border-radius: .5rem; margin: 1rem 0; }
footer { margin-top: 2.5rem; }
@media (max-width: 34rem) { .card { font-size: .85rem; } .card td, .card th { padding: .25rem .3rem; } th.n { white-space: normal; }
  .facts th, .facts td { display: block; width: auto; } .facts td { border: 0 !important; padding-top: 0; } })";

}  // namespace svdag
