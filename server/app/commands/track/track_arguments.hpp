// Converts the arguments of `overfly track` to a data set and an estimator.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/result.hpp"
#include "server/dataset/dataset.hpp"
#include "server/scenario/estimator_spec.hpp"

namespace overfly::app {

struct TrackArguments {
  std::string images;
  std::string layout;
  std::string times;
  std::string time_unit = "auto";
  std::string camera;
  std::string distortion;
  std::string camera_name;
  int sample_bits = 16;

  std::string estimator;           ///< type
  std::string scenario_estimator;  ///< FILE or FILE:NAME
  std::vector<std::string> parameters;
  std::vector<std::string> sets;
  std::string command;
  std::string listen;
  std::string estimator_folder;
  std::uint64_t seed = 1;

  std::string out;
  std::string statuses;
  std::string points;
  std::string debug;
  std::string truth;
  double init_true_depth_m = 0.0;  ///< 0 = not given
  bool json = false;
  bool quiet = false;
};

/// "FX,FY,CX,CY" or "FX,FY,CX,CY,WIDTH,HEIGHT" [px]; without a size it is 0 x 0 px.
/// Errors: kInvalidArgument.
[[nodiscard]] Result<PinholeCamera> pinhole_from_text(const std::string& text);
/// "MODEL:K1,K2,...", with all coefficients of the model; k3 of radtan may be omitted.
/// Errors: kInvalidArgument.
[[nodiscard]] Result<Distortion> distortion_from_text(const std::string& text);
/// Splits text at blanks. Quotes group words; a backslash escapes the next character (except within
/// single quotes).
/// Errors: kInvalidArgument for an unclosed quote.
[[nodiscard]] Result<std::vector<std::string>> words_of(const std::string& text);

/// Errors: kInvalidArgument naming the option.
[[nodiscard]] Result<server::DatasetOptions> dataset_options_from(const TrackArguments& arguments);
/// The named estimator, or that of a scenario, with the parameters and overrides applied.
/// Errors: kInvalidArgument with field, value and limit; as load_scenario.
[[nodiscard]] Result<server::EstimatorSpec> estimator_from(const TrackArguments& arguments);

}  // namespace overfly::app
