#include "report/detail/style.hpp"

#include <array>

#include <fmt/format.h>

#include "report/detail/markup.hpp"

namespace clearway::report::detail {
namespace {

/// A colour by name. One colour means one thing on the whole page: `better` and `worse` what their names say,
/// `s1` to `s6` conditions, `go`, `wait` and `stop` what a signal shows. Better and worse are the blue and
/// the vermillion of Okabe and Ito, "Color Universal Design", 2008. Colours of conditions were sought for a
/// difference of at least 15 (CIE 1976) from each other, ink, better and worse, with full colour vision and
/// without one kind of cone (Machado, Oliveira and Fernandes 2009).
struct Colour {
    const char* name;
    const char* light;
    const char* dark;
};
constexpr std::array<Colour, 17> page_colours = {{{"paper", "#fff", "#14181c"},
                                                  {"ink", "#1c2126", "#e4e8eb"},
                                                  {"muted", "#5a646e", "#9ba6b0"},
                                                  {"rule", "#d9dee3", "#323a42"},
                                                  {"panel", "#f5f7f8", "#1c2227"},
                                                  {"better", "#005f94", "#6cbcf0"},
                                                  {"worse", "#b04300", "#ff9a57"},
                                                  {"s1", "#26873f", "#608c58"},
                                                  {"s2", "#9833cc", "#a467df"},
                                                  {"s3", "#b38e08", "#f8e04b"},
                                                  {"s4", "#0fa4af", "#5cfdad"},
                                                  {"s5", "#90035c", "#b55b9f"},
                                                  {"s6", "#c45081", "#cc97ad"},
                                                  {"go", "#7fae8d", "#5f8f6d"},
                                                  {"wait", "#c9a400", "#d9bd3a"},
                                                  {"stop", "#7d0a1e", "#c4475c"},
                                                  {"road", "#b9c1c8", "#4a545e"}}};

constexpr const char* page_rules = R"css(
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;
overflow-wrap:break-word}
header,main,footer{max-width:1240px;margin:0 auto;padding:0 16px}
header{padding-top:1.6rem}
h1{font-size:clamp(1.2rem,1.1rem + .5vw,1.5rem);line-height:1.2;margin:0 0 .4rem}
h2{font-size:1.35rem;line-height:1.3;margin:2.2rem 0 .5rem;padding-top:1rem;border-top:1px solid var(--rule)}
h3{font-size:1.15rem;margin:2rem 0 .3rem}
.caption{font-size:.8rem;letter-spacing:.04em;color:var(--muted);margin:1rem 0 0}
p{max-width:46rem;margin:.5rem 0}
.lead{font-size:1rem;line-height:1.5;color:var(--muted)}
.note,figcaption+p,small{color:var(--muted);font-size:.85rem}
nav{margin:.8rem 0 0;font-size:.9rem}
nav a{color:inherit;margin-right:1.1rem;white-space:nowrap;display:inline-block;padding:.15rem 0;text-underline-offset:.2em;
text-decoration-color:var(--muted)}
:focus-visible{outline:3px solid var(--better);outline-offset:2px}
#overview h2{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%);white-space:nowrap}
.glance{border-top:1px solid var(--rule);margin:1.2rem 0 2.2rem;padding-top:.2rem}
.glance h3{margin:.8rem 0 .2rem;font-size:1rem;font-weight:600}.glance h3 small{font-weight:400;margin-left:.5em}
.headline{font-size:clamp(1.3rem,1.1rem + 1.1vw,1.75rem);line-height:1.3;font-weight:600;max-width:62rem;margin:.2rem 0 .5rem}
.badge{display:inline-block;border:1px solid var(--muted);border-radius:1rem;padding:.15rem .8rem;font-size:.85rem;margin:.3rem 0}
.badge.few{border-style:dashed;border-width:2px;font-weight:600}
.tiles{display:grid;grid-template-columns:repeat(3,1fr);gap:14px;margin:.8rem 0}
.tile{background:var(--panel);border-radius:8px;padding:.7rem 1rem;border-left:6px solid var(--rule);min-width:0}
.tile h4{margin:0;font-size:.85rem;font-weight:600;color:var(--muted)}
.tile .figure{font-size:1.5rem;line-height:1.25;font-weight:700;margin:.1rem 0;font-variant-numeric:tabular-nums}
.tile p{margin:0;font-size:.88rem}
.tile.better{border-color:var(--better)}.tile.worse{border-color:var(--worse)}
.tile.better .figure{color:var(--better)}.tile.worse .figure{color:var(--worse)}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,340px),1fr));gap:16px;margin:1rem 0;align-items:start}
.card{background:var(--panel);border-radius:8px;padding:.9rem 1.1rem}
.card h3{margin:0 0 .3rem}
.card dl{margin:0}.card dt{font-weight:600;margin-top:.7rem;font-size:.95rem}.card dd{margin:.1rem 0 0;font-size:.92rem}
.effect{font-weight:600}.better{color:var(--better)}.worse{color:var(--worse)}
.tile.better,.tile.worse{color:inherit}
.scroll{overflow-x:auto;margin:.5rem 0 1rem;-webkit-overflow-scrolling:touch;container-type:inline-size}
table{border-collapse:collapse;font-size:.88rem;line-height:1.4;font-variant-numeric:tabular-nums lining-nums;min-width:100%}
table[hidden]{display:none!important}
th,td{padding:.42rem .65rem;text-align:right;vertical-align:top;border-bottom:1px solid var(--rule)}
thead th{vertical-align:bottom;font-weight:600;border-bottom:2px solid var(--muted)}
thead tr.group th{border-bottom:0;padding-bottom:0}
thead tr.sub th{font-weight:400;color:var(--muted);font-size:.8rem;padding-top:0}
th:first-child{text-align:left;padding-left:0!important;font-weight:600}
tbody th{min-width:7.5rem;max-width:17rem;overflow-wrap:anywhere}
td .mean,td .range,td .delta{white-space:nowrap}
td .mean{font-weight:600}td .range{color:var(--muted);margin-left:.3em}
td .delta{display:block;font-size:.8rem;color:var(--muted)}td .delta.better,td .delta.worse{font-weight:600}
td .delta.better{color:var(--better)}td .delta.worse{color:var(--worse)}
td.published{color:var(--muted);font-style:italic;border-left:1px dotted var(--rule);background:var(--panel)}
table.data{min-width:0}table.words td,table.words thead th{text-align:left;overflow-wrap:anywhere}
table.data th,table.data td{padding:.22rem .65rem}
.unsafe{display:inline-block;font-size:.75rem;font-weight:600;border:1px solid var(--worse);color:var(--worse);
border-radius:4px;padding:0 .35em}
@media screen{.cut{max-height:60vh;overflow:hidden;border-bottom:1px dashed var(--muted)}}
@media print{.more{display:none}}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,350px),1fr));gap:28px 32px;margin:1rem 0}
.figures.one{grid-template-columns:1fr}
.figures.pair{grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr))}
figure{margin:0;min-width:0;container-type:inline-size}
.figures.one figure{max-width:760px}figure:has(details[open]){grid-column:1/-1;max-width:none!important}
figure:has(details[open])>svg{max-width:760px!important}
figcaption{font-weight:600;margin-bottom:.3rem;display:flex;flex-wrap:wrap;gap:0 .8rem;justify-content:space-between;align-items:baseline}
.save{font-weight:400;font-size:.78rem;white-space:nowrap}
.save button{font:inherit;color:var(--muted);background:none;border:0;padding:.2rem .35rem;cursor:pointer;text-decoration:underline;
text-underline-offset:.2em}
.save button:hover{color:var(--ink)}
figure svg.plot,figure svg.network{display:block;width:100%;height:auto;max-width:100%}
figure svg.network{background:var(--panel);border-radius:8px;max-height:420px}.network text{font-size:26px!important}
@container (min-width:480px){.plot text{font-size:10.5px}.plot .heading{font-size:11.5px}.plot .range{font-size:9.8px}}
@container (min-width:640px){.plot text{font-size:9px}.plot .heading{font-size:10px}.plot .range{font-size:8.4px}}
details{margin:.4rem 0;font-size:.9rem}summary{cursor:pointer;color:var(--muted);padding:.2rem 0}
details.section{font-size:1rem;border-top:1px solid var(--rule);margin:0}
details.section>summary{padding:.55rem 0;color:var(--ink)}
details.section>summary h2{display:inline;border:0;padding:0;margin:0;font-size:1.1rem}
details.section>section{padding-bottom:1.4rem;scroll-margin-top:3rem}
code,pre{font-family:ui-monospace,"Liberation Mono",monospace;font-size:.88em}
pre{background:var(--panel);border-radius:8px;padding:.8rem 1rem;overflow-x:auto;max-width:100%}
dl.facts{display:grid;grid-template-columns:minmax(8rem,auto) 1fr;gap:.25rem 1.2rem;font-size:.9rem;margin:.6rem 0}
dl.facts dt{color:var(--muted)}dl.facts dd{margin:0;overflow-wrap:anywhere}
footer{padding-top:2rem;padding-bottom:3rem;color:var(--muted);font-size:.85rem}
@media(max-width:560px){dl.facts{grid-template-columns:1fr}dl.facts dt{margin-top:.5rem}.tiles{grid-template-columns:1fr;gap:8px}
.tile{padding:.5rem .8rem}th,td{padding:.4rem .5rem}
nav{white-space:nowrap;overflow-x:auto;margin-right:-16px;padding-bottom:.3rem}}
@media(min-width:561px){.scroll table.paired tbody th,.scroll table.paired thead th:first-child{position:sticky;left:0;
background:var(--paper)}}
@media print{:root{color-scheme:light}body{font-size:10.5pt}nav,.save{display:none}h2{break-after:avoid}
figure,.card,.tile,tr{break-inside:avoid}.scroll{overflow:visible}table{font-size:7.5pt}
th,td,table.data th,table.data td{padding:.2rem .3rem}tbody th{min-width:0}
td .range{display:block;margin-left:0}td .delta{white-space:normal}details:not([open]){display:none}
details.fold:not([open]){display:block}details.fold::details-content{display:block;content-visibility:visible}
.figures,.figures.pair{grid-template-columns:1fr 1fr}}
)css";

/// Of what is inside `<svg class="plot">`.
constexpr const char* drawing_rules = R"css(
.plot text{font-size:12px;fill:var(--ink);font-family:inherit;font-variant-numeric:tabular-nums}
.plot .tick,.plot .axis{fill:var(--muted)}.plot .heading{font-weight:600;font-size:13px}
.plot .label{fill:var(--muted)}.plot .label,.plot .value,.plot .heading,.plot .halo{paint-order:stroke;stroke:var(--paper);
stroke-width:4px;stroke-linejoin:round}
.plot .grid{stroke:var(--rule);stroke-width:1;fill:none}.plot .zero{stroke:var(--ink);stroke-width:1.3}
.plot .blank{fill:var(--paper)}
.plot .line,.plot .bar,.plot .leader,.plot .ring{fill:none;stroke-width:1.8;stroke-linejoin:round;stroke:currentColor}
.plot .bar{stroke-width:2.4}.plot .leader{stroke-width:1.4}.plot .ring{stroke-width:2}
.plot .line.lead{stroke-width:3.8}.plot text.lead{font-weight:700;fill:var(--ink)}
.plot .s0{color:var(--ink)}.plot .s1{color:var(--s1)}.plot .s2{color:var(--s2)}.plot .s3{color:var(--s3)}
.plot .s4{color:var(--s4)}.plot .s5{color:var(--s5)}.plot .s6{color:var(--s6)}
.plot .better{color:var(--better)}.plot .worse{color:var(--worse)}
.plot .signal-red{stroke:var(--stop);stroke-width:4.5;fill:none}
.plot .signal-yellow{stroke:var(--wait);stroke-width:4.5;stroke-dasharray:2 2;fill:none}
.plot .signal-green{stroke:var(--go);stroke-width:1.6;fill:none}
.plot .beam{fill:currentColor;fill-opacity:.35;stroke:none}
.plot .hair{fill:none;stroke:currentColor;stroke-width:1;stroke-opacity:.4}
.plot .band{fill:currentColor;fill-opacity:.16;stroke:none}
.plot .dot{fill:currentColor;stroke:var(--paper);stroke-width:1.2}
.plot .dot.through{fill-opacity:.45;stroke:currentColor;stroke-width:1.4}
.plot .dot.hollow{fill:var(--paper);stroke:currentColor;stroke-width:2}
.plot .bar.thin{stroke-width:1.4}.plot .onDot{fill:var(--paper);font-weight:700}
.plot .uncounted{fill:var(--muted);fill-opacity:.16}
.plot .range{font-size:11.2px}
.plot .cell{fill:var(--rule);fill-opacity:.45}.plot .cell.empty{fill:none}
.plot .cell.better{fill:var(--better);fill-opacity:.3}.plot .cell.worse{fill:var(--worse);fill-opacity:.32}
.plot .road,.plot .way{fill:none;stroke-linejoin:round}.plot .road{stroke:var(--road);stroke-width:1.2}
.plot .way{stroke:var(--muted);stroke-width:2}.plot .way.reached{stroke:var(--ink);stroke-width:1.8}
.plot .way.better,.plot .way.worse{stroke:currentColor;stroke-width:2.6}.plot .way.better.much,.plot .way.worse.much{stroke-width:5}
.plot .way.worse{stroke-dasharray:6 2}.plot .way.few{stroke-width:1.6;stroke-dasharray:1 3}
.plot .way.taken,.plot .way.left{stroke:var(--ink);stroke-width:7;stroke-opacity:.22}
.plot .way.left{stroke-dasharray:1.5 2.5;stroke-opacity:.45}
.plot .way.considered{stroke:var(--ink);stroke-width:1.4;stroke-dasharray:4 3}
.plot .spare{fill:var(--paper);stroke:var(--muted);stroke-width:1}
.plot .held{fill:none;stroke:var(--ink);stroke-width:1.5}.plot .losing{fill:var(--worse);stroke:var(--paper);stroke-width:.8}
.plot .lock{fill:none;stroke:var(--ink);stroke-width:2}.plot .lock.before{opacity:.45}
.plot .call{fill:none;stroke:var(--better);stroke-width:2}.plot .block{fill:var(--worse);stroke:var(--paper);stroke-width:1}.plot .blockBar{fill:var(--paper)}.plot .blocked{fill:none;stroke:var(--worse);stroke-width:4;stroke-dasharray:4 3}
.plot .station{fill:var(--paper);stroke:var(--ink);stroke-width:1.8}
.plot .d1{stroke-dasharray:8 3}.plot .d2{stroke-dasharray:3 2}.plot .d3{stroke-dasharray:10 3 2 3}
.plot .d4{stroke-dasharray:6 2 2 2 2 2}.plot .d5{stroke-dasharray:1 3}.plot .d6{stroke-dasharray:16 4}
)css";

/// Tables that need more room than they have become lists: a block for each row, a line for each cell.
/// Written for each class that says how wide a table is (report/detail/markup.cpp).
constexpr const char* list_rules = R"css(
{0}{{display:block;min-width:0}}{0}>thead{{display:none}}{0}>tbody,{0}>tbody>tr{{display:block}}
{0}>tbody>tr>*{{display:flow-root;text-align:right;padding:.2rem 0!important;border-bottom:1px dotted var(--rule)}}
{0}>tbody>tr>th{{text-align:left;max-width:none;margin-top:.7rem;border-bottom:1px solid var(--muted);position:static!important}}
{0}>tbody>tr>td:empty{{display:none}}
{0}>tbody>tr>td::before{{content:attr(data-label);float:left;max-width:46%;margin-right:.5rem;text-align:left;color:var(--muted);font-style:normal}}
)css";

std::string lists() {
    std::string css = "@media screen{";
    for (const TableWidth& width : table_widths)
        css += fmt::format("@container (max-width:{}px){{{}}}", width.room_px,
                           fmt::format(fmt::runtime(list_rules), fmt::format("table.{}", width.name)));
    return css + "}";
}

std::string custom_properties(bool dark) {
    std::string text = ":root{";
    for (const Colour& colour : page_colours)
        text += fmt::format("--{}:{};", colour.name, dark ? colour.dark : colour.light);
    return text + "}";
}

}  // namespace

std::string page_style() {
    return "\n:root{color-scheme:light dark}" + custom_properties(false) +
           "\n@media screen and (prefers-color-scheme:dark){" + custom_properties(true) + "}" +
           drawing_rules + page_rules + lists();
}

std::string drawing_style() {
    std::string style = drawing_rules;
    for (const Colour& colour : page_colours) {
        const std::string used = fmt::format("var(--{})", colour.name);
        for (std::size_t at = style.find(used); at != std::string::npos; at = style.find(used, at))
            style.replace(at, used.size(), colour.light);
    }
    return style;
}

}  // namespace clearway::report::detail
