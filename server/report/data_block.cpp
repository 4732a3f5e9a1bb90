#include "server/report/data_block.hpp"

#include "server/report/plot/markup.hpp"
#include "server/report/run/words.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::report {
namespace {

using Json = nlohmann::json;

Json axes_json(const ReportRun& run, const ReportEstimate& estimate) {
  Json modes = Json::object();
  for (const auto& [mode, rmse] : estimate.axis_rmse) {
    Json& entry = modes[evaluation::to_string(mode)];
    entry = {{"along_rmse_m", rmse.along_m},
             {"across_rmse_m", rmse.across_m},
             {"horizontal_rmse_m", rmse.horizontal_m},
             {"vertical_rmse_m", rmse.vertical_m}};
    const auto aligned = run.metrics_of(estimate).score.alignments.find(mode);
    if (aligned == run.metrics_of(estimate).score.alignments.end()) continue;
    if (const auto percent = percent_of_path(run, aligned->second.position_m.rmse)) {
      entry["percent_of_path"] = *percent;
    }
  }
  return modes;
}

Json latency_json(const ReportEstimate& estimate) {
  if (!estimate.status.latency) return nullptr;
  return {{"median_ms", estimate.status.latency->median_ms},
          {"p95_ms", estimate.status.latency->p95_ms},
          {"p99_ms", estimate.status.latency->p99_ms},
          {"max_ms", estimate.status.latency->max_ms}};
}

Json run_json(const ReportRun& run) {
  Json axes = Json::object();
  Json latency = Json::object();
  for (const ReportEstimate& estimate : run.estimates) {
    axes[estimate.name] = axes_json(run, estimate);
    latency[estimate.name] = latency_json(estimate);
  }
  return {{"run", plot::clean_text(run.id)},
          {"label", run.label},
          {"status", to_string(run.info.status)},
          {"metrics", json_from(run.metrics)},
          {"axes", std::move(axes)},
          {"latency", std::move(latency)}};
}

}  // namespace

Json report_data(const ReportContent& content) {
  Json runs = Json::array();
  for (const ReportRun& run : content.runs) runs.push_back(run_json(run));
  Json left_out = Json::array();
  for (const LeftOutRun& run : content.left_out) {
    left_out.push_back(
        {{"run", plot::clean_text(run.name)}, {"reason", plot::clean_text(run.reason)}});
  }
  return {{"format_version", 1},
          {"alignment", evaluation::to_string(content.alignment)},
          {"runs", std::move(runs)},
          {"left_out", std::move(left_out)}};
}

std::string data_block(const Json& data) {
  std::string block = "<script type=\"application/json\" id=\"overfly-report\">\n";
  // No text can end the block or begin a comment in it: "<" only occurs in JSON's strings.
  for (const char c : data.dump(1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<') {
      block += "\\u003c";
    } else if (c == '>') {
      block += "\\u003e";
    } else if (c == '&') {
      block += "\\u0026";
    } else {
      block += c;
    }
  }
  return block + "\n</script>\n";
}

}  // namespace overfly::server::report
