#pragma once

namespace clearway::report::detail {

/// The page's style sheet. Series colours: Okabe and Ito, "Color Universal Design", 2008; the first follows
/// the text colour. Each series also has a dash pattern of its own, for print.
inline constexpr const char* style_sheet = R"css(
:root{color-scheme:light dark;--paper:#fff;--ink:#1c2126;--muted:#5a646e;--rule:#d9dee3;--panel:#f5f7f8;
--better:#005f94;--worse:#b04300;--s1:#0072b2;--s2:#d55e00;--s3:#009e73;--s4:#b5588c;--s5:#c98500;--s6:#3a9bd0}
@media screen and (prefers-color-scheme:dark){:root{--paper:#14181c;--ink:#e4e8eb;--muted:#9ba6b0;--rule:#323a42;--panel:#1c2227;
--better:#6cbcf0;--worse:#ff9a57;--s1:#4aa8e6;--s2:#f07c2a;--s3:#2bbf95;--s4:#d98cb8;--s5:#e69f00;--s6:#7cc8f2}}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;
overflow-wrap:break-word}
header,main,footer{max-width:1240px;margin:0 auto;padding:0 16px}
header{padding-top:2.2rem}
h1{font-size:clamp(1.5rem,1.1rem + 1.8vw,2.1rem);line-height:1.2;margin:0 0 .7rem;letter-spacing:-.01em}
h2{font-size:1.35rem;line-height:1.3;margin:3rem 0 .5rem;padding-top:1rem;border-top:1px solid var(--rule)}
h3{font-size:1.15rem;margin:2rem 0 .3rem}
.caption{font-size:.8rem;letter-spacing:.04em;color:var(--muted);margin:1rem 0 0}
p{max-width:46rem;margin:.5rem 0}
.lead{font-size:1.1rem;line-height:1.5}
.note,figcaption+p,small{color:var(--muted);font-size:.85rem}
nav{margin:1.2rem 0 0;font-size:.9rem}
nav a{color:inherit;margin-right:1.1rem;white-space:nowrap;display:inline-block;padding:.15rem 0;text-underline-offset:.2em;
text-decoration-color:var(--muted)}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,340px),1fr));gap:16px;margin:1rem 0;align-items:start}
.card{background:var(--panel);border-radius:8px;padding:.9rem 1.1rem}
.card h3{margin:0 0 .3rem}
.card dl{margin:0}.card dt{font-weight:600;margin-top:.7rem;font-size:.95rem}.card dd{margin:.1rem 0 0;font-size:.92rem}
.effect{font-weight:600}.better{color:var(--better)}.worse{color:var(--worse)}
.scroll{overflow-x:auto;margin:.5rem 0 1rem;-webkit-overflow-scrolling:touch}
table{border-collapse:collapse;font-size:.88rem;line-height:1.4;font-variant-numeric:tabular-nums lining-nums;min-width:100%}
th,td{padding:.42rem .65rem;text-align:right;vertical-align:top;white-space:nowrap;border-bottom:1px solid var(--rule)}
thead th{vertical-align:bottom;font-weight:600;border-bottom:2px solid var(--muted)}
thead tr.group th{border-bottom:0;padding-bottom:0}
thead tr.sub th{font-weight:400;color:var(--muted);font-size:.8rem;padding-top:0}
th:first-child{text-align:left;padding-left:0!important;font-weight:600}
tbody th{min-width:9.5rem;white-space:normal;max-width:17rem}
td .mean{font-weight:600}td .range{color:var(--muted);margin-left:.3em}
td .delta{display:block;font-size:.8rem;color:var(--muted)}td .delta.better,td .delta.worse{font-weight:600}
td .delta.better{color:var(--better)}td .delta.worse{color:var(--worse)}
td.published{color:var(--muted);font-style:italic;border-left:1px dotted var(--rule);background:var(--panel)}
tr.floor th,tr.floor td{color:var(--muted)}
table.data{min-width:0}table.words td,table.words thead th{text-align:left;white-space:normal}
table.data th,table.data td{padding:.22rem .65rem}table.data td{white-space:nowrap}
.unsafe{display:inline-block;font-size:.75rem;font-weight:600;border:1px solid var(--worse);color:var(--worse);
border-radius:4px;padding:0 .35em}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,350px),1fr));gap:28px 32px;margin:1rem 0}
figure{margin:0;min-width:0;max-width:520px}
.figures.wide figure{max-width:none}
figcaption{font-weight:600;margin-bottom:.3rem}
figure svg.plot,figure svg.network{display:block;width:100%;height:auto;max-width:100%}
figure svg.network{background:var(--panel);border-radius:8px;max-height:420px}
.plot text{font-size:12px;fill:var(--ink);font-family:inherit;font-variant-numeric:tabular-nums}
.plot .tick,.plot .axis{fill:var(--muted)}.plot .heading{font-weight:600;font-size:13px}
.plot .label{fill:var(--muted)}.plot .label,.plot .value,.plot .heading{paint-order:stroke;stroke:var(--paper);
stroke-width:4px;stroke-linejoin:round}.network text{font-size:26px!important}
.plot .grid{stroke:var(--rule);stroke-width:1;fill:none}.plot .zero{stroke:var(--ink);stroke-width:1.3}
.line,.bar{fill:none;stroke-width:2;stroke-linejoin:round}.bar{stroke-width:2.4}
.s0{--c:var(--ink)}.s1{--c:var(--s1)}.s2{--c:var(--s2)}.s3{--c:var(--s3)}.s4{--c:var(--s4)}.s5{--c:var(--s5)}.s6{--c:var(--s6)}
.signal-red{stroke:var(--s2);stroke-width:5;fill:none}.signal-yellow{stroke:var(--s5);stroke-width:5;stroke-dasharray:2 2;fill:none}
.signal-green{stroke:var(--s3);stroke-width:1.6;fill:none}
.beam{fill:var(--c);fill-opacity:.35;stroke:none}.hair{fill:none;stroke:var(--c);stroke-width:1;stroke-opacity:.4}.band{fill:var(--c);fill-opacity:.16;stroke:none}
.line,.bar{stroke:var(--c)}.dot{fill:var(--c);stroke:var(--paper);stroke-width:1.2}
.line.s2{stroke-dasharray:7 3}.line.s3{stroke-dasharray:2 3}.line.s4{stroke-dasharray:9 3 2 3}.line.s5{stroke-dasharray:4 2}
.line.s6{stroke-dasharray:1 4}
.legend{list-style:none;display:flex;flex-wrap:wrap;gap:.1rem 1.1rem;padding:0;margin:.4rem 0;font-size:.85rem}
.legend li{display:flex;align-items:center;gap:.45em}.swatch{width:28px;height:10px;flex:none}
details{margin:.4rem 0;font-size:.9rem}summary{cursor:pointer;color:var(--muted);padding:.2rem 0}
details .scroll{max-height:24rem;overflow:auto}
.plot .blank{fill:var(--paper)}
code,pre{font-family:ui-monospace,"Liberation Mono",monospace;font-size:.88em}
pre{background:var(--panel);border-radius:8px;padding:.8rem 1rem;overflow-x:auto;max-width:100%}
dl.facts{display:grid;grid-template-columns:minmax(8rem,auto) 1fr;gap:.25rem 1.2rem;font-size:.9rem;margin:.6rem 0}
dl.facts dt{color:var(--muted)}dl.facts dd{margin:0;overflow-wrap:anywhere}
footer{padding-top:2rem;padding-bottom:3rem;color:var(--muted);font-size:.85rem}
@media(max-width:560px){dl.facts{grid-template-columns:1fr}dl.facts dt{margin-top:.5rem}
tbody th{min-width:7.5rem}th,td{padding:.4rem .5rem}}
@media(min-width:561px){.scroll table.paired tbody th,.scroll table.paired thead th:first-child{position:sticky;left:0;
background:var(--paper)}}
@media print{:root{color-scheme:light}body{font-size:10.5pt}nav{display:none}h2{break-after:avoid}
figure,.card,tr{break-inside:avoid}.scroll,details .scroll{overflow:visible;max-height:none}table{font-size:7.5pt}
th,td,table.data th,table.data td{padding:.2rem .3rem}thead th{white-space:normal}tbody th{min-width:0}
td .range{display:block;margin-left:0}td .delta{white-space:normal}details:not([open]){display:none}
details.fold:not([open]){display:block}details.fold::details-content{display:block;content-visibility:visible}}
)css";

}  // namespace clearway::report::detail
