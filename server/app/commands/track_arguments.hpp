// What `overfly track` is told, made into a data set and an estimator.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
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
/// "MODEL:K1,K2,...", as many coefficients as the model has, of radtan also without k3.
/// Errors: kInvalidArgument.
[[nodiscard]] Result<Distortion> distortion_from_text(const std::string& text);
/// Words between blanks; quotes hold blanks together, a backslash takes the next character as it
/// is (not within single quotes). Errors: kInvalidArgument for an open quote.
[[nodiscard]] Result<std::vector<std::string>> words_of(const std::string& text);

/// Errors: kInvalidArgument naming the option.
[[nodiscard]] Result<engine::DatasetOptions> dataset_options_from(const TrackArguments& arguments);
/// The estimator that is named, or a scenario's, with the parameters and changes put in.
/// Errors: kInvalidArgument with field, value and limit; as load_scenario.
[[nodiscard]] Result<engine::EstimatorSpec> estimator_from(const TrackArguments& arguments);

}  // namespace overfly::app
