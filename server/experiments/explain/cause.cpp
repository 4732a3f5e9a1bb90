#include "server/experiments/explain/cause.hpp"

#include <algorithm>
#include <iterator>

namespace overfly::server::experiments {
namespace {

struct CauseTexts {
  Cause cause;
  const char* name;
  const char* words;
  const char* without;
};

constexpr CauseTexts kTexts[] = {
    {Cause::kFaults, "faults", "the injected faults", "without injected faults"},
    {Cause::kDrops, "drops", "the dropped frames", "without dropped frames"},
    {Cause::kCalibration, "calibration", "the error of the intrinsics", "with the true intrinsics"},
    {Cause::kBlur, "blur", "the blur of the images", "without blur"},
    {Cause::kRollingShutter, "rolling_shutter", "the rolling shutter", "with a global shutter"},
    {Cause::kExposure, "exposure", "the exposure", "with a fixed, right exposure"},
    {Cause::kNoise, "noise", "the noise of the sensor", "without noise"},
    {Cause::kTurbulence,
     "turbulence",
     "turbulence and vibration",
     "without turbulence and vibration"},
    {Cause::kTexture, "texture", "the lack of texture", "with synthetic detail on the ground"},
    {Cause::kRollRate, "roll_rate", "the roll rate", "with half the roll rate"},
    {Cause::kFeatures, "features", "the number of features", "with twice the features"},
    {Cause::kStart, "start", "the instant of the start", "with another start"},
};

const CauseTexts& texts_of(Cause cause) {
  return *std::find_if(std::begin(kTexts), std::end(kTexts), [&](const CauseTexts& texts) {
    return texts.cause == cause;
  });
}

}  // namespace

const char* to_string(Cause cause) { return texts_of(cause).name; }

std::optional<Cause> cause_from(const std::string& text) {
  for (const CauseTexts& texts : kTexts) {
    if (text == texts.name) return texts.cause;
  }
  return std::nullopt;
}

const std::vector<Cause>& all_causes() {
  static const std::vector<Cause> causes = [] {
    std::vector<Cause> all;
    for (const CauseTexts& texts : kTexts) all.push_back(texts.cause);
    return all;
  }();
  return causes;
}

bool is_disturbance(Cause cause) {
  return cause != Cause::kTexture && cause != Cause::kRollRate && cause != Cause::kFeatures &&
         cause != Cause::kStart;
}

bool holds(const std::vector<Cause>& causes, Cause cause) {
  return std::find(causes.begin(), causes.end(), cause) != causes.end();
}

std::string words_for(Cause cause) { return texts_of(cause).words; }
std::string words_without(Cause cause) { return texts_of(cause).without; }

}  // namespace overfly::server::experiments
