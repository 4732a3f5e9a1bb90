// Whether an estimator's errors are as large as the covariance that it states for them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace overfly::evaluation {

enum class Honesty {
  kConsistent,
  kOverconfident,  ///< the errors are larger than the stated covariance
  kTooCautious,    ///< the errors are smaller than the stated covariance
};
[[nodiscard]] const char* to_string(Honesty honesty);  ///< "consistent", "overconfident", ...
[[nodiscard]] std::optional<Honesty> honesty_from(const std::string& text);

struct Band {
  double low = 0.0;
  double high = 0.0;
};

/// Where the mean of `samples` independent NEES with that many degrees of freedom lies with a
/// probability of 95 %: chi-square quantiles of samples * degrees, divided by samples (Bar-Shalom,
/// Li, Kirubarajan 2001, sec. 5.4.2).
/// @pre both > 0
[[nodiscard]] Band nees_band_95(int degrees, std::size_t samples);

/// Normalised estimation errors squared (NEES), e^T P^-1 e with an error e and its covariance P:
/// Bar-Shalom, Li, Kirubarajan 2001, Estimation with Applications to Tracking and Navigation, sec.
/// 5.4.2. With Gaussian errors and a true P it is chi-square distributed with as many degrees of
/// freedom n as e has components; the mean of N independent ones, times N, with N n.
struct Nees {
  int degrees = 0;    ///< n: 3 of a position or a rotation, 6 of a pose
  int samples = 0;    ///< N
  double mean = 0.0;  ///< n is expected
  /// In which the mean of N independent samples lies with a probability of 95 %. Errors of
  /// consecutive poses are correlated, which makes the mean of one flight scatter more than this: a
  /// mean slightly outside is no proof.
  Band band_95;
  Band pose_band_95;                       ///< the same for a single pose
  double share_in_band = 0.0;              ///< of the poses in pose_band_95: 0.95 is expected
  Honesty honesty = Honesty::kConsistent;  ///< where the mean lies relative to band_95

  /// By which factor the errors exceed the stated standard deviations: sqrt(mean / n).
  [[nodiscard]] double deviation_ratio() const;
};

/// @param squared  NEES of each pose
/// @pre !squared.empty()
[[nodiscard]] Nees nees_of(const std::vector<double>& squared, int degrees);

/// By one alignment. The covariance is transformed like the pose: rotated, positions scaled.
struct Consistency {
  /// In the world's axes. Empty without a covariance of it that can be inverted.
  std::optional<Nees> position;
  /// Small rotation about the world's axes; empty also if the alignment is degenerate.
  std::optional<Nees> rotation;
  std::optional<Nees> pose;  ///< both together, with what the covariance says of their relation
  /// Poses whose position has a singular covariance: it has no inverse, they are not scored.
  int singular = 0;

  /// Overconfident if one of its parts is; else too cautious if one is. Empty without any.
  [[nodiscard]] std::optional<Honesty> honesty() const;
};

/// Of the tracked frames.
struct CovarianceCounts {
  int stated = 0;    ///< valid ones
  int left_out = 0;  ///< stated, but invalid: not finite, not symmetric, not positive semi-definite

  [[nodiscard]] bool any() const { return stated > 0 || left_out > 0; }
};

}  // namespace overfly::evaluation
