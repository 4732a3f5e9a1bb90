// A picture stream that a client asks for (docs/PROTOCOL.md, "subscribe").
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/net/http/json_text.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// Another run whose tracks a scene shows.
struct SceneRun {
  std::string run_id;
  server::TrackLook look{};
  bool operator==(const SceneRun&) const = default;
};

/// One requested picture stream.
struct StreamRequest {
  std::string run_id;
  std::string name;  ///< "camera", "scene", "depth", "error", "error/NAME" or "debug/NAME"
  double max_hz = 31.0;
  int quality = 75;
  int max_width_px = 1280;
  bool video = false;               ///< may be sent as VP8
  std::string camera = {};          ///< for "camera", "depth", "error"; empty = the run's first
  std::string view = {};            ///< for the stream "scene": the name of its view
  server::TrackLook look{};         ///< likewise: of the run's tracks
  std::vector<SceneRun> with = {};  ///< likewise: other runs whose tracks it shows
  std::string compared = {};        ///< likewise: a second alignment of all estimates
  bool operator==(const StreamRequest&) const = default;
};

/// A name that selects something; empty if the field is absent.
[[nodiscard]] std::string read_name(JsonFields* fields, const char* field);

/// The field "run", which must be there.
[[nodiscard]] std::string require_run(JsonFields* fields);

/// @param where  of the entry, for messages: "pictures.0"
/// Errors: kInvalidArgument naming the field, its value and the limit.
[[nodiscard]] Result<StreamRequest> read_stream(const nlohmann::json& entry,
                                                const std::string& where);

}  // namespace overfly::net
