#include "terrain/place/smooth_map.hpp"

#include <cmath>

namespace overfly::terrain {
namespace {

constexpr double kPiHere = 3.14159265358979323846;

double from_unit(double s, double low, double high) {
  return 0.5 * (low + high + s * (high - low));
}

/// Values at the tensor grid of Chebyshev nodes of degree n, node (i, j) in column j (n + 1) + i.
bool sample_nodes(const MapRect& domain, int n, const PlaneFunction& exact, Eigen::MatrixXd& out) {
  Eigen::Matrix2Xd points(2, (n + 1) * (n + 1));
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double s = std::cos((i + 0.5) * kPiHere / (n + 1));
      const double t = std::cos((j + 0.5) * kPiHere / (n + 1));
      points.col(j * (n + 1) + i) << from_unit(s, domain.x_min, domain.x_max),
          from_unit(t, domain.y_min, domain.y_max);
    }
  }
  return exact(points, out) && out.allFinite();
}

/// Coefficients by discrete orthogonality: c_ij = w_i w_j / (n+1)^2 sum f T_i T_j.
Eigen::MatrixXd coefficients_of(const Eigen::MatrixXd& values, int n) {
  Eigen::MatrixXd T(n + 1, n + 1);
  for (int k = 0; k <= n; ++k) {
    for (int node = 0; node <= n; ++node)
      T(k, node) = std::cos(k * (node + 0.5) * kPiHere / (n + 1));
  }
  Eigen::MatrixXd result(values.rows(), (n + 1) * (n + 2) / 2);
  Eigen::Index column = 0;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n - j; ++i) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(values.rows());
      for (int b = 0; b <= n; ++b) {
        for (int a = 0; a <= n; ++a) sum += T(i, a) * T(j, b) * values.col(b * (n + 1) + a);
      }
      const double weight = (i == 0 ? 1.0 : 2.0) * (j == 0 ? 1.0 : 2.0) / ((n + 1.0) * (n + 1.0));
      result.col(column++) = weight * sum;
    }
  }
  return result;
}

Eigen::VectorXd evaluate(const ChebyshevFit& fit, double s, double t) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(fit.coefficients.rows());
  Eigen::Index column = 0;
  for (int j = 0; j <= fit.degree; ++j) {
    for (int i = 0; i <= fit.degree - j; ++i) {
      sum +=
          std::cos(i * std::acos(s)) * std::cos(j * std::acos(t)) * fit.coefficients.col(column++);
    }
  }
  return sum;
}

}  // namespace

std::optional<ChebyshevFit> fit_chebyshev(const MapRect& domain,
                                          int outputs,
                                          const PlaneFunction& exact,
                                          double tolerance) {
  // Check points: a regular grid including the edges, which lies between the nodes of every degree.
  constexpr int kChecks = 23;
  Eigen::Matrix2Xd checks(2, kChecks * kChecks);
  const auto unit = [](int i) { return -1.0 + 2.0 * i / (kChecks - 1); };
  for (int j = 0; j < kChecks; ++j) {
    for (int i = 0; i < kChecks; ++i) {
      checks.col(j * kChecks + i) << from_unit(unit(i), domain.x_min, domain.x_max),
          from_unit(unit(j), domain.y_min, domain.y_max);
    }
  }
  Eigen::MatrixXd truth(outputs, checks.cols());
  if (!exact(checks, truth) || !truth.allFinite()) return std::nullopt;

  for (int n = 2; n <= kSmoothMapMaxDegree; ++n) {
    Eigen::MatrixXd values(outputs, (n + 1) * (n + 1));
    if (!sample_nodes(domain, n, exact, values)) return std::nullopt;
    ChebyshevFit fit{n, coefficients_of(values, n), 0.0};
    for (int j = 0; j < kChecks && fit.max_error <= tolerance; ++j) {
      for (int i = 0; i < kChecks; ++i) {
        const Eigen::VectorXd error = evaluate(fit, unit(i), unit(j)) - truth.col(j * kChecks + i);
        fit.max_error = std::max(fit.max_error, error.cwiseAbs().maxCoeff());
      }
    }
    if (fit.max_error <= tolerance) return fit;
  }
  return std::nullopt;
}

}  // namespace overfly::terrain
