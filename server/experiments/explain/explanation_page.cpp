#include "server/experiments/explain/explanation_page.hpp"

#include <algorithm>
#include <cstdio>

#include "server/experiments/explain/cause_finding.hpp"
#include "server/experiments/explain/cause_picture.hpp"
#include "server/experiments/explain/explanation_words.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/band_plot.hpp"
#include "server/report/plot/markup.hpp"

namespace overfly::server::experiments {
namespace {

namespace html = server::report;
using plot::BandKind;

std::string fixed(double value, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Initialising, tracking, lost: as far as the score tells.
plot::BandRow row_of(const Reflight& flight) {
  const double from_s = flight.part.from_s;
  const double to_s = flight.part.to_s;
  plot::BandRow row{flight.name, {}};
  if (!flight.error.empty()) return row;
  const double begin_s = from_s + flight.score.initialised_at_s.value_or(to_s - from_s);
  if (begin_s > from_s) row.bands.push_back({from_s, begin_s, BandKind::kInitialising});
  // One that initialises late tracks from then on.
  const bool lost = flight.failed() && flight.score.initialised_at_s &&
                    flight.score.outcome != evaluation::Outcome::kInitLate;
  const double end_s =
      lost ? std::clamp(from_s + flight.score.outcome_time_s.value_or(0.0), begin_s, to_s) : to_s;
  if (end_s > begin_s) row.bands.push_back({begin_s, end_s, BandKind::kTracking});
  if (to_s > end_s) row.bands.push_back({end_s, to_s, BandKind::kLost});
  return row;
}

std::string causes_of(const std::vector<CauseFinding>& findings) {
  return html::figure("Causes.",
                      "Necessary: without it the estimator survives. Sufficient: with everything "
                      "else taken away it still fails.",
                      cause_picture(findings));
}

std::string picture_of(const Explanation& explanation) {
  plot::BandPlot bands;
  bands.id = "flights";
  bands.title = "What the estimator did in each flight";
  bands.x_label = "time of the run [s]";
  bands.x_range = {explanation.part.from_s, explanation.part.to_s};
  for (const Reflight& flight : explanation.flights) {
    bands.x_range.low = std::min(bands.x_range.low, flight.part.from_s);
    bands.x_range.high = std::max(bands.x_range.high, flight.part.to_s);
    bands.rows.push_back(row_of(flight));
    bands.description += flight.name + ": " + result_words(flight) + ". ";
  }
  return html::figure(
      "Flights.", "From the start of the estimator to the failure.", plot::svg_of(bands));
}

std::string table_of(const Explanation& explanation, const std::filesystem::path& folder) {
  using plot::escaped;
  std::string rows;
  for (const Reflight& flight : explanation.flights) {
    const std::string link = flight.folder.lexically_relative(folder).string();
    rows += "<tr><th scope=\"row\">" + escaped(flight.name) + "</th><td>" +
            escaped(result_words(flight)) + "</td><td class=\"n\">" +
            (flight.error.empty() ? fixed(100.0 * flight.score.coverage, "%.1f") : "") +
            "</td><td class=\"n\">" + std::to_string(flight.seed) + "</td><td class=\"n\">" +
            fixed(flight.part.from_s, "%.0f") + " to " + fixed(flight.part.to_s, "%.1f") +
            "</td><td><a href=\"" + escaped(link) + "/\">" + escaped(link) + "</a></td></tr>\n";
  }
  return "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"Flights\"><table>\n"
         "<caption><span>Times of outcomes count from the start of the part that was "
         "flown.</span></caption>\n<thead><tr><th scope=\"col\">Flight</th><th scope=\"col\">Result"
         "</th><th scope=\"col\" class=\"n\">Coverage [%]</th><th scope=\"col\" class=\"n\">Seed"
         "</th><th scope=\"col\" class=\"n\">Part [s]</th><th scope=\"col\">Run folder</th></tr>"
         "</thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

}  // namespace

std::string page_of(const Explanation& explanation, const std::filesystem::path& folder) {
  const std::string title = "Why " + explanation.estimator + " failed";
  std::string page = html::page_start(title + " - Overfly") + "<h1>" + plot::escaped(title) +
                     "</h1>\n" +
                     html::paragraph("Explanation by Overfly " + html::program_text() + " of run " +
                                         explanation.run + ": " + explanation.title,
                                     "lead");
  const std::vector<std::string> sentences = sentences_of(explanation);
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    page += html::paragraph(sentences[i], i == 0 ? "verdict" : "");
  }
  if (const auto findings = findings_of(explanation); !findings.empty()) {
    page += html::heading(2, "Causes") + causes_of(findings);
  }
  if (!explanation.flights.empty()) {
    page += html::heading(2, "Flights") + picture_of(explanation) + table_of(explanation, folder);
  }
  if (!explanation.untried.empty()) {
    html::Table untried;
    untried.caption = "Causes that were not tried";
    untried.head = {{"Cause"}, {"Reason"}};
    for (const UntriedCause& each : explanation.untried) {
      untried.rows.push_back({{to_string(each.cause)}, {each.reason}});
    }
    page += html::heading(2, "Not tried") + html::table(untried);
  }
  return page + "</body>\n</html>\n";
}

}  // namespace overfly::server::experiments
