#include <garment/fit/fit_places.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/version.hpp>
#include <sloper/garment/fit/fit.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::garment {

namespace {

constexpr int SORT_DIGITS = 6; ///< of the number that a column is sorted by

const char* HEAD = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<style>
:root{--ink:#1d2433;--pale:#667;--line:#dde1ea;--ok:#2c7a4b;--loose:#3a6ea5;--tight:#a86400;--bad:#b3261e}
*{box-sizing:border-box}body{font:16px/1.45 system-ui,sans-serif;color:var(--ink);max-width:68rem;margin:0 auto;padding:1rem}
h1{font-size:1.4rem;margin:.2rem 0}h2{font-size:1.05rem;margin:1.6rem 0 .4rem}.pale{color:var(--pale)}
.verdict{border-left:.5rem solid;padding:.6rem 1rem;margin:1rem 0;background:#f6f7fa;font-size:1.1rem}
.ok{color:var(--ok)}.loose{color:var(--loose)}.tight{color:var(--tight)}.bad{color:var(--bad)}
.wide{overflow-x:auto}table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums;font-size:.9rem}
th,td{padding:.35rem .6rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th:first-child,td:first-child,th.words,td.words{text-align:left}th{cursor:pointer;color:var(--pale);font-weight:600}th[aria-sort]{color:var(--ink)}
.bars{display:grid;grid-template-columns:minmax(6rem,max-content) minmax(8rem,1fr) max-content;gap:.2rem .7rem;align-items:center;font-size:.9rem}
.bars b{font-weight:400}.bars .n{text-align:right;font-variant-numeric:tabular-nums}.track,.axis{position:relative;height:1.25rem;overflow:hidden}
.track i{position:absolute;top:0;bottom:0}.axis i{position:absolute;transform:translateX(-50%);font-style:normal;font-size:.75rem;color:var(--pale)}
.okay{background:#dcefe3}.grid{border-left:1px solid #eceef3}.zero{border-left:1px solid #667}
.track .bar{top:.3rem;bottom:.3rem;background:currentColor}.track .error{top:.58rem;bottom:.58rem;background:var(--ink)}
.track .limit{width:3px;margin-left:-1.5px;background:var(--bad)}
</style>)";

const char* SCRIPT = R"(<script>
for(const table of document.querySelectorAll("table"))table.tHead.addEventListener("click",e=>{const th=e.target.closest("th");if(!th)return;
const i=th.cellIndex,down=th.getAttribute("aria-sort")==="ascending",key=r=>r.cells[i].dataset.v??r.cells[i].textContent,
rows=[...table.tBodies[0].rows].sort((a,b)=>{const x=key(a),y=key(b),d=Number(x)-Number(y);return (isNaN(d)?x.localeCompare(y):d)*(down?-1:1)});
for(const h of table.tHead.rows[0].cells)h.removeAttribute("aria-sort");th.setAttribute("aria-sort",down?"descending":"ascending");
table.tBodies[0].append(...rows)});
</script>)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string number(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string cell(double value, int digits, double uncertainty = -1) {
  std::string text = "<td data-v=\"" + number(value, SORT_DIGITS) + "\">" + number(value, digits);
  if (uncertainty >= 0)
    text += " <span class=\"pale\">&plusmn; " + number(uncertainty, digits) + "</span>";
  return text + "</td>";
}

/// Cell of a figure that was not measured; it sorts below every number.
std::string unmeasured_cell() {
  return "<td data-v=\"-1e9\" class=\"pale\">&ndash;</td>";
}

const char* css_class(FitVerdict verdict) {
  switch (verdict) {
  case FitVerdict::OK: return "ok";
  case FitVerdict::LOOSE: return "loose";
  case FitVerdict::TIGHT: return "tight";
  default: return "bad";
  }
}

/// What only draped cloth has: strain, gap and pressure.
std::string draped_cells(const FitRow& r) {
  return cell(100 * r.strain_p99, 1, 100 * r.strain_uncertainty) + "<td class=\"words\">" +
         r.strain_direction + "</td>" + cell(1000 * r.gap_p05_m, 1) +
         cell(1000 * r.gap_p50_m, 1, 1000 * r.gap_uncertainty_m) +
         cell(r.pressure_p95_pa, 0, r.pressure_uncertainty_pa);
}

/// A girth as it is spoken of, with its name in the documents where that is another word.
std::string girth_cell(const std::string& name) {
  const std::string spoken = spoken_girth(name);
  std::string text = "<td>" + escaped(spoken);
  if (name == "omphalion")
    text += " <span class=\"pale\">" + name + "</span>";
  return text + "</td>";
}

/// Ease on the body that the garment comes from, and by how much it changed.
std::string source_ease_cells(const FitRow& r) {
  if (!r.source_ease_m)
    return unmeasured_cell() + unmeasured_cell();
  const double change = 100 * (r.ease_m - *r.source_ease_m);
  return cell(100 * *r.source_ease_m, 1) + "<td data-v=\"" + number(change, SORT_DIGITS) + "\">" +
         (change > 0 ? "+" : "") + number(change, 1) + "</td>";
}

std::string table(const std::vector<std::string>& heads, const std::string& rows) {
  std::string text = "<div class=\"wide\"><table><thead><tr>";
  for (const std::string& head : heads)
    text +=
        (head == "along" || head == "verdict" || head == "of" ? "<th class=\"words\">" : "<th>") +
        head + "</th>";
  return text + "</tr></thead><tbody>" + rows + "</tbody></table></div>\n";
}

/// Shares of the body girth that the bars show, and where they lie on the track.
struct Scale {
  static constexpr double LEAST_LOW = -0.06, LEAST_HIGH = 0.2; ///< always shown
  static constexpr double LOWEST = -0.5, HIGHEST = 1.2;        ///< never shown beyond
  static constexpr double STEPS[] = {0.05, 0.1, 0.2}, WIDEST_STEP = 0.25;
  static constexpr int MOST_STEPS = 7; ///< marks on the axis
  double low = LEAST_LOW, high = LEAST_HIGH;
  void show(double share) {
    low = std::max(LOWEST, std::min(low, share));
    high = std::min(HIGHEST, std::max(high, share));
  }
  bool shows(double share) const { return share >= low && share <= high; }
  double at(double share) const {
    return 100 * (std::clamp(share, low, high) - low) / (high - low);
  } ///< per cent of the track
  double step() const {
    for (const double s : STEPS)
      if ((high - low) / s <= MOST_STEPS)
        return s;
    return WIDEST_STEP;
  }
};

std::string mark(const char* what, double left, double width = -1) {
  return std::string("<i class=\"") + what + "\" style=\"left:" + number(left, 2) + "%" +
         (width >= 0 ? ";width:" + number(width, 2) + "%" : "") + "\"></i>";
}

/// Bars of ease with their uncertainty and the policy's limits, all in per cent of the body girth,
/// on one scale.
std::string ease_bars(const std::vector<FitRow>& rows) {
  constexpr double BESIDE_BAR = 0.02;    // share of the girth that stays free beside a bar
  constexpr double LARGEST_LIMIT = 0.65; // a limit beyond it would make the bars too short
  Scale scale;
  for (const FitRow& r : rows) {
    const double share = r.ease_m / r.body_m, error = r.ease_uncertainty_m / r.body_m;
    scale.show(share - error);
    scale.show(share + error + BESIDE_BAR);
    if (r.limits.loose_ease <= LARGEST_LIMIT)
      scale.show(r.limits.loose_ease);
    if (r.limits.too_large_ease <= LARGEST_LIMIT)
      scale.show(r.limits.too_large_ease + 0.01);
    scale.show(r.limits.too_small_ease - 0.01);
  }
  std::string axis, lines;
  for (int k = static_cast<int>(std::ceil(scale.low / scale.step()));
       k * scale.step() <= scale.high; ++k) {
    const double at = scale.at(k * scale.step());
    axis +=
        "<i style=\"left:" + number(at, 2) + "%\">" + number(100 * scale.step() * k, 0) + "</i>";
    lines += mark(k == 0 ? "zero" : "grid", at);
  }
  std::string bars = "<div class=\"bars\"><b></b><span class=\"axis\">" + axis +
                     "</span><b class=\"n\">ease %</b>\n";
  for (const FitRow& r : rows) {
    const double share = r.ease_m / r.body_m, error = r.ease_uncertainty_m / r.body_m,
                 tight = scale.at(r.limits.tight_ease);
    bars +=
        "<b>" + escaped(spoken_girth(r.name)) + "</b><span class=\"track " + css_class(r.verdict) +
        "\">" + mark("okay", tight, scale.at(r.limits.loose_ease) - tight) + lines +
        mark("bar", scale.at(std::min(0.0, share)), std::abs(scale.at(share) - scale.at(0))) +
        mark("error", scale.at(share - error), scale.at(share + error) - scale.at(share - error));
    for (const double limit : {r.limits.too_small_ease, r.limits.too_large_ease})
      if (scale.shows(limit))
        bars += mark("limit", scale.at(limit));
    bars += "</span><b class=\"n\">" + number(100 * share, 1) + " &plusmn; " +
            number(100 * error, 1) + "</b>\n";
  }
  return bars + "</div>\n<p class=\"pale\">Ease in per cent of the body's girth, with its "
                "uncertainty. Pale green: what the policy calls well fitting, from tight to "
                "loose. Red marks: below, too small; above, too large.</p>\n";
}

/// How likely it fits, in a sentence.
std::string likelihood_of(const FitReport& report) {
  std::string text = "It fits with a probability of " + whole_percent(report.probability.fits);
  if (!report.probability.girth.empty())
    text += "; the most doubt is at the " + escaped(spoken_girth(report.probability.girth));
  if (report.bears)
    text += "; its strain on the body that it comes from is unknown: it bears " +
            percent(*report.bears);
  return text + ".";
}

std::string said_of(const std::string& state) {
  if (state == "placed")
    return "; measured as it was placed: it was not draped";
  return state == "not at rest" ? "; the drape did not come to rest" : "";
}

/// Ease of each girth, as bars and as a table.
std::string girth_sections(const FitReport& report) {
  const std::string undraped = unmeasured_cell() + "<td class=\"words\"></td>" + unmeasured_cell() +
                               unmeasured_cell() + unmeasured_cell();
  const bool knows_source =
      std::any_of(report.rows.begin(), report.rows.end(),
                  [](const FitRow& r) { return r.source_ease_m.has_value(); });
  std::string rows;
  for (const FitRow& r : report.rows)
    rows += "<tr>" + girth_cell(r.name) + cell(r.height_m * 100, 1) +
            cell(r.body_m * 100, 1, r.body_uncertainty_m * 100) +
            cell(r.rest_m * 100, 1, r.garment_uncertainty_m * 100) +
            cell(r.ease_m * 100, 1, r.ease_uncertainty_m * 100) +
            cell(100 * r.ease_m / r.body_m, 1) + (knows_source ? source_ease_cells(r) : "") +
            "<td class=\"words " + css_class(r.verdict) + "\">" + verdict_name(r.verdict) +
            "</td>" + (report.was_draped() ? draped_cells(r) : undraped) + "</tr>\n";
  std::vector<std::string> heads = {"girth",      "height cm", "body cm",
                                    "garment cm", "ease cm",   "ease %"};
  if (knows_source)
    heads.insert(heads.end(), {"ease before cm", "change cm"});
  heads.insert(heads.end(),
               {"verdict", "strain p99 %", "along", "gap p05 mm", "gap p50 mm", "pressure p95 Pa"});
  return "<h2>Ease</h2>\n" + ease_bars(report.rows) + "<h2>Girths</h2>\n" + table(heads, rows) +
         (knows_source ? "<p class=\"pale\">Ease before: of the same cloth on the body that the "
                         "garment comes from. &plusmn; is an uncertainty, not a change.</p>\n"
                       : "");
}

std::string region_section(const std::vector<FitRegion>& regions) {
  std::string rows;
  for (const FitRegion& r : regions)
    rows += "<tr><td>" + r.name + "</td>" + cell(100 * r.strain_p50, 1) +
            cell(100 * r.strain_p99, 1) + cell(100 * r.strain_max, 1) + "<td class=\"words\">" +
            r.strain_direction + "</td></tr>\n";
  return "<h2>Strain by region</h2>\n" +
         table({"region", "p50 %", "p99 %", "largest %", "along"}, rows);
}

std::string hem_section(const FitReport& report) {
  std::string rows;
  for (const FitHem& h : report.lines.hems)
    rows += "<tr><td>" + h.name + "</td>" +
            cell(100 * h.height_m, 1, 100 * (h.uncertainty_m + report.convergence_m)) +
            cell(100 * h.length_m, 1) + cell(100 * h.front_minus_back_m, 1) +
            cell(100 * h.left_minus_right_m, 1) + "</tr>\n";
  return "<h2>Hems</h2>\n" +
         table({"edge", "height cm", "length cm", "front higher by cm", "left higher by cm"}, rows);
}

/// Where hems, sleeves and legs end.
std::string length_section(const std::vector<FitLength>& lengths) {
  const bool knows_source = std::any_of(lengths.begin(), lengths.end(), [](const FitLength& l) {
    return l.source_above_m.has_value();
  });
  const auto source_cells = [](const FitLength& l) {
    return (l.source_above_m ? cell(100 * *l.source_above_m, 1) : unmeasured_cell()) +
           "<td class=\"words\">" + l.verdict + "</td>";
  };
  std::string rows;
  for (const FitLength& l : lengths)
    rows += "<tr><td>" + escaped(spoken_girth(l.name)) + "</td>" +
            cell(100 * l.above_m, 1, 100 * l.uncertainty_m) + "<td class=\"words\">" + l.place +
            "</td>" + (knows_source ? source_cells(l) : "") + "</tr>\n";
  std::vector<std::string> heads = {"edge", "above cm", "of"};
  if (knows_source)
    heads.insert(heads.end(), {"before cm", "verdict"});
  return "<h2>Length</h2>\n" + table(heads, rows) +
         "<p class=\"pale\">How far above a joint or level of the body each edge ends, along the "
         "limb; negative: below it." +
         (knows_source ? " Before: on the body that the garment comes from.</p>\n" : "</p>\n");
}

std::string finding_section(const std::vector<Message>& findings) {
  std::string text = "<h2>Findings</h2>\n<ul>\n";
  for (const Message& finding : findings)
    text += "<li>" + escaped(finding.text) + " <span class=\"pale\">" + escaped(finding.id) +
            "</span></li>\n";
  return text + "</ul>\n";
}

} // namespace

std::string fit_page(const FitReport& report, const std::string& garment, const std::string& body) {
  const std::string title = escaped(garment) + " on " + escaped(body);
  std::string page = HEAD + ("<title>" + title) + "</title></head><body>\n<h1>" + title + "</h1>\n";
  page += std::string("<div class=\"verdict ") + css_class(report.verdict) + "\"><b>" +
          (report.fits ? "Fits" : "Does not fit") + ": " + verdict_name(report.verdict) + "</b>" +
          (report.reason.empty() ? "" : "<br>The garment " + escaped(report.reason) + ".") +
          "</div>\n<p>" + likelihood_of(report) + "</p>\n";
  page += "<p class=\"pale\">Policy: " + escaped(report.policy) +
          (report.mode.empty() ? "" : "; mode: " + report.mode) +
          (report.garment_class.empty() ? "" : "; class: " + report.garment_class) +
          (report.fabric.empty() ? "" : "; fabric: " + escaped(report.fabric)) +
          said_of(report.state) + "; Sloper " + VERSION + "</p>\n";
  if (!report.findings.empty())
    page += finding_section(report.findings);
  if (!report.rows.empty())
    page += girth_sections(report);
  if (!report.lengths.empty() && report.was_draped())
    page += length_section(report.lengths);
  if (!report.regions.empty() && report.was_draped())
    page += region_section(report.regions);
  if (!report.lines.hems.empty())
    page += hem_section(report);
  if (!report.lines.coverage.empty()) {
    std::string rows;
    for (const auto& [name, share] : report.lines.coverage)
      rows += "<tr><td>" + escaped(spoken_girth(name)) + "</td>" +
              cell(100 * report.lines.coverage_m.at(name), 1) + cell(100 * share, 0) + "</tr>\n";
    page += "<h2>Coverage</h2>\n" + table({"limb", "length cm", "of the limb %"}, rows);
  }
  if (!report.left_out.empty()) {
    page += "<h2>Not measured</h2>\n<p class=\"pale\">";
    for (const auto& [name, why] : report.left_out)
      page += escaped(spoken_girth(name)) + ": " + escaped(why) + ". ";
    page += "</p>\n";
  }
  return page + SCRIPT + "</body></html>\n";
}

} // namespace sloper::garment
