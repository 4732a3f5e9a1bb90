#include "server/report/page_style.hpp"

#include "server/report/plot/series.hpp"

namespace overfly::server::report {
namespace {

std::string variables_of(const Theme& theme) {
  std::string css = "{";
  const auto set = [&](const std::string& name, std::string_view colour) {
    css += "--" + name + ":" + std::string(colour) + ";";
  };
  set("page", theme.page);
  set("text", theme.text);
  set("muted", theme.muted);
  set("grid", theme.grid);
  set("box", theme.box);
  set("link", theme.link);
  set("error", theme.error);
  set("caution", theme.caution);
  set("truth", theme.truth);
  for (std::size_t i = 0; i < theme.series.size(); ++i) {
    set("e" + std::to_string(i), theme.series[i]);
  }
  set("tracking", theme.tracking);
  set("initialising", theme.initialising);
  set("lost", theme.lost);
  return css + "}";
}

/// s1 to s12: the four colours solid, then dashed, then dotted.
std::string series_rules() {
  const auto colours = static_cast<int>(kLightTheme.series.size());
  constexpr std::string_view kDashes[] = {"", "stroke-dasharray:8 4;", "stroke-dasharray:2 4;"};
  std::string css = ".line.s0{stroke:var(--truth);stroke-width:4}\n";
  for (int style = 0; style < plot::kEstimateStyles; ++style) {
    css += ".s" + std::to_string(style + 1) + "{stroke:var(--e" + std::to_string(style % colours) +
           ");" + std::string(kDashes[style / colours]) + "}\n";
  }
  return css;
}

/// Lines over a picture keep the colours of the light theme, whose outline is white.
std::string pictured_rules() { return ".pictured" + variables_of(kLightTheme) + "\n"; }

constexpr std::string_view kRules = R"css(
*{box-sizing:border-box}
body{margin:0 auto;max-width:70rem;padding:1.5rem 1rem 3rem;background:var(--page);
color:var(--text);font:1rem/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
h1{font-size:1.7rem;line-height:1.2;margin:0 0 .3rem}
h2{font-size:1.3rem;margin:2.4rem 0 .6rem;padding-bottom:.2rem;border-bottom:2px solid var(--grid)}
h3{font-size:1.08rem;margin:1.6rem 0 .4rem}
p,ul{margin:.4rem 0}
li{margin:.25rem 0}
code{font-size:.88em;overflow-wrap:anywhere}
p,li,figcaption,.fields td{overflow-wrap:anywhere}
.lead{color:var(--muted);margin:0 0 1rem}
.flight{border-left:4px solid var(--e0);padding:.1rem 0 .1rem 1rem;margin:.8rem 0 1.2rem}
.runs{list-style:none;padding:0;color:var(--muted)}
.verdict{font-size:1.12rem;font-weight:600}
.warnings{list-style:none;padding:0}
.warnings li{border-left:4px solid var(--caution);padding:.1rem 0 .1rem .7rem}
.warnings li.note{border-color:var(--grid)}
.warnings li.error{border-color:var(--error)}
.warnings b{color:var(--caution)}
.warnings .error b{color:var(--error)}
.warnings .note b{color:var(--muted)}
nav{display:flex;flex-wrap:wrap;gap:.2rem 1.1rem}
nav a{color:var(--link);white-space:nowrap}
a:focus-visible,summary:focus-visible,.wide:focus-visible{outline:3px solid var(--link);
outline-offset:2px}
.wide{overflow-x:auto;margin:.8rem 0}
table{border-collapse:collapse;font-size:.86rem;font-variant-numeric:tabular-nums;min-width:100%}
caption{text-align:left;color:var(--muted);padding:.3rem 0;caption-side:top}
caption span{display:inline-block;position:sticky;left:0;max-width:calc(100vw - 2rem)}
th,td{padding:.28rem .55rem;text-align:left;vertical-align:top;border-bottom:1px solid var(--grid)}
thead th{background:var(--box);border-bottom:2px solid var(--muted);vertical-align:bottom}
tbody th{font-weight:600}
td{max-width:34rem}
.fields th{max-width:24rem;min-width:min(16rem,45vw);overflow-wrap:break-word}
.n{text-align:right;white-space:nowrap}
thead .n{white-space:normal}
.best{font-weight:700}
.unseen{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%);
white-space:nowrap}
details{margin:.7rem 0}
summary{cursor:pointer;color:var(--link);font-weight:600}
figure{margin:1.1rem 0;break-inside:avoid}
figcaption{color:var(--muted);font-size:.92rem;margin-bottom:.2rem}
figcaption strong{color:var(--text)}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(24rem,100%),1fr));gap:0 1rem}
svg{display:block;width:100%;height:auto}
svg text{font:12px system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;
fill:var(--text)}
svg .tick,svg .label{fill:var(--muted)}
svg path{fill:none}
.line{stroke-width:1.8;stroke-linecap:round;stroke-linejoin:round}
.halo{stroke:#fff;stroke-width:6}
.axis{stroke:var(--muted);stroke-width:1}
.grid{stroke:var(--grid);stroke-width:1}
.frame{fill:none;stroke:var(--muted);stroke-width:1}
.level{stroke:var(--muted);stroke-width:1.2;stroke-dasharray:6 4}
svg .level-text{fill:var(--muted);font-size:11px}
.marker{fill:var(--page);stroke:var(--truth);stroke-width:2.5}
svg .on-map{font-weight:600;paint-order:stroke;stroke:var(--page);stroke-width:4px;
stroke-linejoin:round}
.bar-halo{stroke:var(--page);stroke-width:6}
.bar{stroke:var(--text);stroke-width:2.4}
svg .north{fill:var(--text);stroke:var(--page);stroke-width:2;paint-order:stroke}
.band-tracking{fill:var(--tracking)}
.band-initialising{fill:var(--initialising)}
.band-lost{fill:var(--lost)}
.mark-yes{fill:var(--lost)}
.mark-no{fill:none;stroke:var(--muted);stroke-width:2}
footer{margin-top:3rem;padding-top:.6rem;border-top:2px solid var(--grid);color:var(--muted);
font-size:.9rem}
@media screen and (max-width:40rem){
figure{overflow-x:auto}
figure>svg{min-width:36rem}
.pair svg{min-width:0}
}
@page{size:A4;margin:14mm 12mm}
@media print{
body{max-width:none;padding:0;font-size:10pt}
nav,details:not([open]){display:none}
table{font-size:7.5pt}
.wide{overflow:visible}
th,td{padding:.15rem .3rem}
tbody th{overflow-wrap:anywhere}
.fields th{min-width:8rem}
caption{break-after:avoid}
thead{display:table-header-group}
tr{break-inside:avoid}
h2,h3,figcaption{break-after:avoid}
}
)css";

}  // namespace

std::string style_sheet() {
  return ":root{color-scheme:light dark}\n:root" + variables_of(kLightTheme) +
         "\n@media screen and (prefers-color-scheme:dark){:root" + variables_of(kDarkTheme) +
         "}\n" + std::string(kRules) + series_rules() + pictured_rules();
}

}  // namespace overfly::server::report
