#include "server/net/rest/calibration/rest_calibration_request.hpp"

#include <map>
#include <nlohmann/json.hpp>

#include "server/net/http/json_text.hpp"

namespace overfly::net {
namespace {

using calibration::LensChoice;
using nlohmann::json;
using server::SourceKind;

constexpr double kWidestSquareM = 10.0;
constexpr std::int64_t kMostCorners = 60;
constexpr int kMostVirtualViews = 200;

/// The lens in the fields `model` and `k3`.
LensChoice lens_of(JsonFields& fields) {
  const std::string name = fields.text("model").value_or("radtan");
  const auto model = distortion_model_from(name);
  LensChoice lens{model.value_or(DistortionModel::kRadtan), fields.boolean("k3").value_or(false)};
  if (!model || *model == DistortionModel::kFov) {
    fields.reject("model", ": must be none, radtan or equidistant");
  }
  if (lens.k3 && lens.model != DistortionModel::kRadtan) {
    fields.reject("k3", ": must be given with the model radtan only");
  }
  return lens;
}

Status read_source(const json& object, server::DeskRequest& request) {
  static const std::map<std::string, SourceKind> kKinds = {{"folder", SourceKind::kFolder},
                                                           {"recording", SourceKind::kRecording},
                                                           {"scenario", SourceKind::kScenario},
                                                           {"upload", SourceKind::kUpload},
                                                           {"camera", SourceKind::kCamera}};
  JsonFields fields(object, "source");
  fields.require("kind");
  const auto kind = kKinds.find(fields.text("kind").value_or(""));
  if (kind == kKinds.end()) {
    fields.reject("kind", ": must be folder, recording, scenario, upload or camera");
    return fields.finish();
  }
  request.kind = kind->second;
  if (request.kind != SourceKind::kUpload) {
    fields.require("name");
    request.name = fields.text("name").value_or("");
  }
  if (request.kind == SourceKind::kRecording) request.topic = fields.text("topic").value_or("");
  if (request.kind == SourceKind::kScenario) {
    request.camera = fields.text("camera").value_or("");
    request.views = static_cast<int>(fields.integer("views", 4, kMostVirtualViews).value_or(20));
    request.seed = static_cast<std::uint64_t>(fields.integer("seed", 0, 1'000'000'000).value_or(1));
  }
  return fields.finish();
}

Status read_board(const json& object, calibration::Board& board) {
  JsonFields fields(object, "board");
  for (const char* field : {"cols", "rows", "square_m"}) fields.require(field);
  board.cols = static_cast<int>(fields.integer("cols", 3, kMostCorners).value_or(0));
  board.rows = static_cast<int>(fields.integer("rows", 3, kMostCorners).value_or(0));
  board.square_m = fields.number("square_m", 1e-6, kWidestSquareM).value_or(0.0);
  const auto markers = fields.text("markers");
  const auto marker_m = fields.number("marker_m", 1e-6, kWidestSquareM);
  if (markers && *markers != "4x4" && *markers != "5x5" && *markers != "6x6") {
    fields.reject("markers", ": must be 4x4, 5x5 or 6x6");
  }
  if (markers.has_value() != marker_m.has_value()) {
    fields.reject("marker_m", ": must be given together with board.markers");
  }
  if (markers && marker_m)
    board.markers = calibration::BoardMarkers{markers->front() - '0', *marker_m};
  if (Status status = fields.finish(); !status) return status;
  return board.validate();
}

}  // namespace

Result<server::DeskRequest> calibration_request_from(const std::string& body) {
  const Result<json> object = parse_object(body, "a calibration");
  if (!object) return object.error();
  JsonFields fields(*object, "");
  fields.require("source");
  fields.require("board");
  server::DeskRequest request;
  const json* const source = fields.object("source");
  const json* const board = fields.object("board");
  request.calibrator.lens = lens_of(fields);
  request.calibrator.accept_symmetric = fields.boolean("accept_symmetric").value_or(false);
  if (Status status = fields.finish(); !status) return status.error();
  if (Status status = read_source(*source, request); !status) return status.error();
  if (Status status = read_board(*board, request.calibrator.board); !status) return status.error();
  return request;
}

Result<SolveCommand> solve_command_from(const std::string& body) {
  const Result<json> object = parse_object(body, "a solution");
  if (!object) return object.error();
  JsonFields fields(*object, "");
  SolveCommand command;
  command.lens = lens_of(fields);
  if (const json* const views = fields.array("left_out")) {
    for (const json& view : *views) {
      const bool whole = view.is_number_unsigned() && view < server::kMostSessionViews;
      if (!whole) {
        fields.reject("left_out", ": must be numbers of views");
        break;
      }
      command.left_out.insert(view.get<std::size_t>());
    }
  }
  if (Status status = fields.finish(); !status) return status.error();
  return command;
}

Result<SessionControl> session_control_from(const std::string& body) {
  const Result<json> object = parse_object(body, "a control");
  if (!object) return object.error();
  JsonFields fields(*object, "");
  SessionControl control;
  control.automatic = fields.boolean("automatic");
  control.capture = fields.boolean("capture").value_or(false);
  control.finish = fields.boolean("finish").value_or(false);
  control.clear = fields.boolean("clear").value_or(false);
  if (Status status = fields.finish(); !status) return status.error();
  return control;
}

}  // namespace overfly::net
