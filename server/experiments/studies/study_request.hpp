// What clients of a server can ask of a study: why a run failed, where a flight is risky, which
// flight is the worst.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/scenario/scenario.hpp"

namespace overfly::server::experiments {

enum class StudyKind { kExplain, kPredict, kHunt };
/// "explain", "predict", "hunt": also the command of the program that makes the study.
[[nodiscard]] const char* to_string(StudyKind kind);
[[nodiscard]] std::optional<StudyKind> study_kind_from(const std::string& text);

/// Limits of a client's options. The command line allows more.
struct StudyLimits {
  static constexpr std::size_t kMostExplainFlights = 60;
  static constexpr std::size_t kMostHuntFlights = 200;
  static constexpr std::size_t kMostHuntRepeats = 10;
  static constexpr std::size_t kMostHuntAxes = 6;
  static constexpr std::uint64_t kMostSeed = 4'294'967'295;
  static constexpr double kLeastRateHz = 0.1;
  static constexpr double kMostRateHz = 10.0;
  static constexpr double kLeastMapKm = 0.1;
  static constexpr double kMostMapKm = 25.0;
  static constexpr double kLeastCellM = 10.0;
  static constexpr double kMostCellM = 10'000.0;
};

/// Why an estimator of a run failed.
struct ExplainRequest {
  std::string run;                  ///< id
  std::string estimator;            ///< empty = the first one that failed
  std::vector<std::string> causes;  ///< names; empty = all
  std::size_t flights = 12;         ///< at most
};

/// A scenario of the server with changes, or a client's own document.
struct StudyScenario {
  std::string name;
  std::vector<Override> overrides;
  std::optional<nlohmann::json> document;  ///< in place of name and overrides
};

/// Where an estimator is likely to be lost.
struct PredictRequest {
  StudyScenario scenario;
  std::string camera;    ///< empty = the first
  double rate_hz = 2.0;  ///< instants per second of the flight
  bool map = true;
  double map_km = 10.0;   ///< side of the map at most
  double cell_m = 100.0;  ///< side of its cells
};

/// A numeric field of a scenario within limits.
struct HuntAxis {
  std::string path;
  std::string label;  ///< empty = the path
  std::string unit;
  double from = 0.0;
  double to = 0.0;
  std::optional<double> step;
};

/// Which flight within limits is the worst.
struct HuntRequest {
  StudyScenario scenario;
  std::vector<HuntAxis> axes;
  std::string estimator;  ///< empty = the first one
  std::size_t flights = 40;
  std::size_t repeats = 1;  ///< seeds of each point
  std::uint64_t seed = 1;   ///< of the search
  bool all = false;         ///< do not stop at the first failure
  std::optional<double> position_rmse_limit_m;
};

struct StudyRequest {
  std::variant<ExplainRequest, PredictRequest, HuntRequest> asks;
  std::size_t jobs = 0;  ///< flights or threads at the same time; 0 = half of the processors

  [[nodiscard]] StudyKind kind() const { return static_cast<StudyKind>(asks.index()); }
};

/// Why a study is not made, in addition to the error.
enum class StudyRefusal {
  kNone,
  kOff,     ///< the server has no folder of studies
  kMemory,  ///< a flight needs more memory than there is
  kFull,    ///< too many wait, or too many are kept
};

}  // namespace overfly::server::experiments
