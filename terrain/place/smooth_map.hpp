// Inside terrain only: a smooth function of the plane as one polynomial with a checked error, so
// that a map projection takes tens of nanoseconds instead of a library call.
//
// Method: interpolation at Chebyshev nodes (Trefethen, Approximation Theory and Approximation
// Practice, 2013, ch. 3), with terms of total degree <= n; n is increased until the error at points
// between the nodes is below the tolerance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace overfly::terrain {

struct MapRect {
  double x_min = 0.0;
  double y_min = 0.0;
  double x_max = 0.0;
  double y_max = 0.0;

  [[nodiscard]] bool contains(double x, double y) const {
    return x >= x_min && x <= x_max && y >= y_min && y <= y_max;
  }
  [[nodiscard]] MapRect grown(double margin) const {
    return {x_min - margin, y_min - margin, x_max + margin, y_max + margin};
  }
};

inline constexpr int kSmoothMapMaxDegree = 14;

/// Values of the exact function at points (columns); false if it is undefined at one of them.
using PlaneFunction = std::function<bool(const Eigen::Matrix2Xd& points, Eigen::MatrixXd& values)>;

/// Coefficients of T_i(x) T_j(y), i + j <= degree, one column each, j outermost.
struct ChebyshevFit {
  int degree = 0;
  Eigen::MatrixXd coefficients;
  double max_error = 0.0;  ///< largest difference at the check points
};

/// @return empty if no degree up to kSmoothMapMaxDegree reaches the tolerance
[[nodiscard]] std::optional<ChebyshevFit> fit_chebyshev(const MapRect& domain,
                                                        int outputs,
                                                        const PlaneFunction& exact,
                                                        double tolerance);

/// K functions of the plane. Not valid outside the polynomial's domain.
template <int K>
class SmoothMap {
 public:
  using Value = Eigen::Matrix<double, K, 1>;

  static std::optional<SmoothMap> fit(const MapRect& domain,
                                      const PlaneFunction& exact,
                                      double tolerance) {
    std::optional<ChebyshevFit> fitted = fit_chebyshev(domain, K, exact, tolerance);
    if (!fitted) return std::nullopt;
    SmoothMap map;
    map.domain_ = domain;
    map.degree_ = fitted->degree;
    for (Eigen::Index i = 0; i < fitted->coefficients.cols(); ++i) {
      map.coefficients_.push_back(fitted->coefficients.col(i));
    }
    return map;
  }

  [[nodiscard]] Value operator()(double x, double y) const {
    const double s = (2.0 * x - domain_.x_min - domain_.x_max) / (domain_.x_max - domain_.x_min);
    const double t = (2.0 * y - domain_.y_min - domain_.y_max) / (domain_.y_max - domain_.y_min);
    std::array<double, kSmoothMapMaxDegree + 1> T_x;
    T_x[0] = 1.0;
    T_x[1] = s;
    for (int i = 2; i <= degree_; ++i) T_x[i] = 2.0 * s * T_x[i - 1] - T_x[i - 2];
    Value sum = Value::Zero();
    double t_before = 0.0;
    double t_now = 1.0;
    std::size_t next = 0;
    for (int j = 0; j <= degree_; ++j) {
      Value row = coefficients_[next++];
      for (int i = 1; i <= degree_ - j; ++i) row += T_x[i] * coefficients_[next++];
      sum += t_now * row;
      const double t_next = j == 0 ? t : 2.0 * t * t_now - t_before;
      t_before = t_now;
      t_now = t_next;
    }
    return sum;
  }

  /// Adds a constant to the values.
  void shift(const Value& offset) { coefficients_.front() += offset; }

  [[nodiscard]] const MapRect& domain() const { return domain_; }

  /// The values at two places of the domain, as text.
  [[nodiscard]] std::string fingerprint() const {
    std::string text;
    for (const double share : {0.25, 0.75}) {
      const Value value = (*this)(domain_.x_min + share * (domain_.x_max - domain_.x_min),
                                  domain_.y_min + share * (domain_.y_max - domain_.y_min));
      for (int i = 0; i < K; ++i) text += (text.empty() ? "" : " ") + std::to_string(value[i]);
    }
    return text;
  }

 private:
  MapRect domain_;
  int degree_ = 0;
  std::vector<Value> coefficients_;
};

}  // namespace overfly::terrain
