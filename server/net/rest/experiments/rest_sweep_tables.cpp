// Tables of a sweep as texts, and its comparison with another one.
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/text/shown_path.hpp"
#include "server/experiments/comparison/compare_sweeps.hpp"
#include "server/experiments/service/sweep_files.hpp"
#include "server/experiments/tables/sweep_tables.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

namespace fs = std::filesystem;
namespace experiments = server::experiments;
using experiments::TableFormat;
using nlohmann::json;
using Cancel = const std::atomic<bool>*;

struct TextKind {
  const char* content_type;
  const char* extension;
};

TextKind text_kind_of(TableFormat format) {
  switch (format) {
    case TableFormat::kMarkdown:
      return {"text/markdown; charset=utf-8", ".md"};
    case TableFormat::kLatex:
      return {"application/x-tex; charset=utf-8", ".tex"};
    case TableFormat::kHtml:
      return {"text/html; charset=utf-8", ".html"};
    case TableFormat::kCsv:
      return {"text/csv; charset=utf-8", ".csv"};
    case TableFormat::kJson:
      break;
  }
  return {"application/json", ".json"};
}

/// "one=ONE,two=TWO". Errors: kInvalidArgument.
Result<std::map<std::string, std::string>> counterparts_of(const std::string& list) {
  std::map<std::string, std::string> counterparts;
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string pair = list.substr(begin, end - begin);
    const std::size_t sign = pair.find('=');
    if (sign == std::string::npos) {
      return bad_query("as", list, "ESTIMATOR=PUBLISHED_NAME, with commas between");
    }
    counterparts[pair.substr(0, sign)] = pair.substr(sign + 1);
    begin = end + 1;
  }
  return counterparts;
}

struct TableQuery {
  TableFormat format = TableFormat::kMarkdown;
  std::string published;  ///< name of the file; may be empty
  experiments::TableOptions options;
};

Result<TableQuery> table_query_of(const RouteCall& call) {
  TableQuery query;
  const std::string format = call.query_or("format", "markdown");
  const auto known = experiments::table_format_from(format);
  if (!known) return bad_query("format", format, "markdown, latex, html, csv or json");
  query.format = *known;
  query.published = call.query_or("published", "");
  auto counterparts = counterparts_of(call.query_or("as", ""));
  if (!counterparts) return counterparts.error();
  query.options.counterparts = std::move(*counterparts);
  const std::string margin = call.query_or("margin_percent", "10");
  const auto percent = number_from<double>(margin);
  // Written so that not-a-number is rejected as well.
  if (!percent || !(*percent >= 0.0 && *percent <= 100.0)) {
    return bad_query("margin_percent", margin, "a number in [0, 100]");
  }
  query.options.differences.margin = *percent / 100.0;
  return query;
}

Result<HttpResponse> tables_of(const SweepRoutes& routes,
                               const std::string& name,
                               TableQuery query,
                               Cancel cancel) {
  if (const Result<json> entry = routes.sweeps->entry(name); !entry) return entry.error();
  if (!query.published.empty()) {
    const auto file = experiments::published_file(routes.sweeps->files_folder(), query.published);
    if (!file) return file.error();
    auto published = experiments::read_published_errors(*file);
    if (!published) return published.error();
    query.options.published = std::move(*published);
  }
  auto scores = experiments::read_sweep_scores(routes.folder / name, cancel);
  if (!scores) return scores.error();
  for (std::string& problem : scores->problems) {
    problem = shown_without(routes.folder, "", std::move(problem));
  }
  const auto tables = experiments::sweep_tables(std::move(*scores), query.options, cancel);
  if (!tables) return tables.error();
  const TextKind kind = text_kind_of(query.format);
  HttpResponse response =
      page_response(experiments::text_from(*tables, query.options, query.format));
  response.content_type = kind.content_type;
  response.headers.emplace_back("Content-Disposition",
                                "inline; filename=\"" + name + kind.extension + "\"");
  return response;
}

struct ComparisonBody {
  std::string baseline;
  std::string estimator;
  evaluation::AlignmentMode alignment = evaluation::AlignmentMode::kInitScale;
  std::vector<std::string> conditions;
};

void read_conditions(JsonFields& fields, std::vector<std::string>& conditions) {
  constexpr std::size_t kMost = 32;
  constexpr std::size_t kLongest = 500;
  const json* list = fields.array("conditions");
  if (list == nullptr) return;
  if (list->size() > kMost) return fields.reject("conditions", ": must be at most 32");
  for (const json& text : *list) {
    if (!text.is_string() || text.get_ref<const std::string&>().size() > kLongest) {
      return fields.reject("conditions", ": must be texts of at most 500 bytes");
    }
    conditions.push_back(text.get<std::string>());
  }
}

Result<ComparisonBody> comparison_body(const std::string& text) {
  const Result<json> body = parse_object(text, "the body");
  if (!body) return body.error();
  JsonFields fields(*body, "");
  ComparisonBody parsed;
  fields.require("baseline");
  parsed.baseline = fields.text("baseline").value_or("");
  parsed.estimator = fields.text("estimator").value_or("");
  const std::string mode = fields.text("alignment").value_or("init_scale");
  if (const auto known = evaluation::alignment_mode_from(mode)) {
    parsed.alignment = *known;
  } else {
    fields.reject("alignment", " = " + mode + ": must be an alignment of scores");
  }
  read_conditions(fields, parsed.conditions);
  if (const Status status = fields.finish(); !status) return status.error();
  return parsed;
}

json condition_json(const experiments::JudgedCondition& condition) {
  if (!condition.verdict) {
    return {{"text", condition.text},
            {"holds", nullptr},
            {"left", nullptr},
            {"right", nullptr},
            {"problem", condition.verdict.error().message}};
  }
  return {{"text", condition.text},
          {"holds", condition.verdict->holds},
          {"left", condition.verdict->left},
          {"right", condition.verdict->right},
          {"problem", nullptr}};
}

/// A quantity of both sweeps, exactly as conditions compute it; null where a sweep has none.
json quantity_json(const std::string& quantity,
                   const std::string& term,
                   const experiments::PairedSweeps& paired) {
  const auto both = experiments::judged_conditions({term + " > baseline"}, paired);
  const bool known = both && both->front().verdict.ok();
  const auto flights = paired.flights.find(quantity);
  return {{"quantity", quantity},
          {"flights", flights == paired.flights.end() ? 0 : flights->second.size()},
          {"sweep", known ? json(both->front().verdict->left) : json()},
          {"baseline", known ? json(both->front().verdict->right) : json()}};
}

Result<json> comparison_of(const SweepRoutes& routes,
                           const std::string& name,
                           const ComparisonBody& body,
                           Cancel cancel) {
  for (const std::string& sweep : {name, body.baseline}) {
    if (const Result<json> entry = routes.sweeps->entry(sweep); !entry) return entry.error();
  }
  const auto paired = experiments::pair_sweeps(
      routes.folder / name, routes.folder / body.baseline, body.estimator, body.alignment, cancel);
  if (!paired) {
    // Without the folders of this machine.
    return Error{paired.error().code, shown_without(routes.folder, "", paired.error().message)};
  }
  if (paired->pairs == 0) {
    return Error{ErrorCode::kNotFound,
                 name + " and " + body.baseline + ": " + experiments::kNoPairs};
  }
  const auto judged = experiments::judged_conditions(body.conditions, *paired);
  if (!judged) return judged.error();
  json quantities = json::array();
  quantities.push_back(quantity_json("success_rate", "success_rate", *paired));
  for (const std::string& quantity : experiments::condition_quantities()) {
    quantities.push_back(quantity_json(quantity, "median(" + quantity + ")", *paired));
  }
  json conditions = json::array();
  for (const experiments::JudgedCondition& condition : *judged) {
    conditions.push_back(condition_json(condition));
  }
  return json{{"pairs", paired->pairs},
              {"without_pair", paired->without_pair},
              {"failed", paired->failed},
              {"quantities", std::move(quantities)},
              {"conditions", std::move(conditions)}};
}

}  // namespace

void add_sweep_table_routes(RestRouter* router, const SweepRoutes& routes) {
  router->add("GET",
              "/api/v1/sweeps/{name}/tables",
              [routes](const RouteCall& call, const Respond& respond) {
                auto query = table_query_of(call);
                if (!query) return respond(error_response(query.error()));
                respond_from_reader(
                    routes.readers,
                    "a sweep",
                    call,
                    respond,
                    [routes, name = call.path.at("name"), query = std::move(*query)](
                        Cancel cancel) { return tables_of(routes, name, query, cancel); });
              },
              {"format", "published", "as", "margin_percent"});
  router->add_long_calculation(
      "/api/v1/sweeps/{name}/comparison", [routes](const RouteCall& call, const Respond& respond) {
        if (auto refused = not_json(call.request)) return respond(std::move(*refused));
        auto body = comparison_body(call.request.body);
        if (!body) return respond(error_response(body.error()));
        read_and_answer(routes.readers,
                        "two sweeps",
                        call,
                        respond,
                        [routes, name = call.path.at("name"), body = std::move(*body)](
                            Cancel cancel) { return comparison_of(routes, name, body, cancel); });
      });
}

}  // namespace overfly::net
