// The search finds failures with a third of the flights that random points need.
#include "server/experiments/hunt/point_search.hpp"

#include <gtest/gtest.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <set>
#include <utility>

#include "tests/server/experiments/hunt/survival_surfaces.hpp"

namespace overfly::server::experiments {
namespace {

using Points = std::vector<Eigen::VectorXd>;

/// Flights up to the first failure; `most` + 1 if none is found.
int flights_to_failure(const Surface& surface, SearchMethod method, std::uint64_t seed, int most) {
  PointSearch search(std::vector<SearchAxis>(surface.axes), method, seed);
  for (int flight = 1; flight <= most; ++flight) {
    const Points points = search.next(1);
    const double margin = surface.margin(points.front());
    if (margin < 0.0) return flight;
    search.tell({margin});
  }
  return most + 1;
}

double median(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return 0.5 * (values[middle] + values[values.size() - 1 - middle]);
}

/// What an algorithm of NLopt needs if it looks at flights themselves, from random starts; local
/// ones start again where they end.
int flights_of_nlopt(const Surface& surface,
                     nlopt_algorithm algorithm,
                     std::uint64_t seed,
                     int most) {
  struct Flights {
    const Surface& surface;
    int flown = 0;
    bool failed = false;
  } flights{surface};
  const auto fly = [](unsigned count, const double* at, double* /*gradient*/, void* data) {
    auto& flown = *static_cast<Flights*>(data);
    const double margin = flown.surface.margin(Eigen::Map<const Eigen::VectorXd>(at, count));
    if (!flown.failed) ++flown.flown;
    flown.failed = flown.failed || margin < 0.0;
    return margin;
  };
  std::mt19937_64 random(seed);
  nlopt_srand(seed);
  while (!flights.failed && flights.flown < most) {
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
        nlopt_create(algorithm, static_cast<unsigned>(surface.axes)), &nlopt_destroy);
    nlopt_set_lower_bounds1(optimiser.get(), 0.0);
    nlopt_set_upper_bounds1(optimiser.get(), 1.0);
    nlopt_set_min_objective(optimiser.get(), fly, &flights);
    nlopt_set_stopval(optimiser.get(), -1e-12);
    nlopt_set_maxeval(optimiser.get(), most - flights.flown);
    nlopt_set_initial_step1(optimiser.get(), 0.3);
    nlopt_set_xtol_abs1(optimiser.get(), 0.03);
    std::vector<double> at(surface.axes);
    for (double& start : at) start = unit_number(random);
    double lowest = 0.0;
    (void)nlopt_optimize(optimiser.get(), at.data(), &lowest);
  }
  return flights.failed ? flights.flown : most + 1;
}

using SurfaceOf = std::function<Surface(std::uint64_t)>;

const std::vector<SurfaceOf>& surfaces() {
  static const std::vector<SurfaceOf> all{[](std::uint64_t) { return corner_surface(); },
                                          pocket_surface,
                                          [](std::uint64_t) { return border_surface(); }};
  return all;
}

/// Why the search has a model: the algorithms of NLopt that need no derivatives need more flights
/// if they look at the flights themselves. Prints the table of docs/HUNT.md.
TEST(PointSearch, NeedsFewerFlightsThanNloptByItself) {
  constexpr int kMost = 300;
  using Run = std::function<int(const Surface&, std::uint64_t)>;
  const auto by = [](nlopt_algorithm algorithm) -> Run {
    return [algorithm](const Surface& surface, std::uint64_t seed) {
      return flights_of_nlopt(surface, algorithm, seed, kMost);
    };
  };
  const std::vector<std::pair<const char*, Run>> methods{
      {"model",
       [](const Surface& surface, std::uint64_t seed) {
         return flights_to_failure(surface, SearchMethod::kModel, seed, kMost);
       }},
      {"random",
       [](const Surface& surface, std::uint64_t seed) {
         return flights_to_failure(surface, SearchMethod::kRandom, seed, kMost);
       }},
      {"COBYLA", by(NLOPT_LN_COBYLA)},
      {"BOBYQA", by(NLOPT_LN_BOBYQA)},
      {"SBPLX", by(NLOPT_LN_SBPLX)},
      {"DIRECT-L, randomised", by(NLOPT_GN_DIRECT_L_RAND)},
      {"CRS2", by(NLOPT_GN_CRS2_LM)}};
  std::vector<double> sums;
  for (const auto& [name, run] : methods) {
    double sum = 0.0;
    std::printf("%-22s", name);
    for (const SurfaceOf& surface : surfaces()) {
      std::vector<int> flights;
      for (std::uint64_t seed = 1; seed <= 100; ++seed) flights.push_back(run(surface(seed), seed));
      sum += median(flights);
      std::printf("%s%6.1f (at most %d)",
                  sum == median(flights) ? "" : ",",
                  median(flights),
                  *std::max_element(flights.begin(), flights.end()));
    }
    std::printf("\n");
    sums.push_back(sum);
  }
  EXPECT_EQ(std::min_element(sums.begin(), sums.end()), sums.begin());
}

class FindsFailures : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static Surface surface(std::uint64_t seed) { return surfaces()[GetParam()](seed); }
};

/// The requirement: at most a third of random search's flights, median over ten seeds.
TEST_P(FindsFailures, WithAThirdOfTheFlightsOfRandomSearch) {
  constexpr int kMostRandom = 500;
  constexpr int kMostModel = 60;
  const double share = failing_share(surface(1));
  EXPECT_GT(share, 0.015);
  EXPECT_LT(share, 0.05);
  std::vector<int> by_model;
  std::vector<int> by_chance;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    by_model.push_back(flights_to_failure(surface(seed), SearchMethod::kModel, seed, kMostModel));
    by_chance.push_back(
        flights_to_failure(surface(seed), SearchMethod::kRandom, seed, kMostRandom));
  }
  std::printf("%s: failing share %.3f, median flights %.1f by model, %.1f by chance\n",
              surface(1).name.c_str(),
              share,
              median(by_model),
              median(by_chance));
  EXPECT_LE(3.0 * median(by_model), median(by_chance));
  // Ten draws may be lucky: random search's median follows from the share.
  EXPECT_LE(3.0 * median(by_model), std::log(0.5) / std::log(1.0 - share));
  EXPECT_LE(*std::max_element(by_model.begin(), by_model.end()), kMostModel)
      << "each seed finds it";
}

INSTANTIATE_TEST_SUITE_P(PointSearch,
                         FindsFailures,
                         ::testing::Range(std::size_t{0}, std::size_t{3}),
                         [](const auto& test) { return surfaces()[test.param](1).name; });

/// With the whole budget the search finds a lower margin than random points.
TEST(PointSearch, FindsALowerMarginThanRandomSearch) {
  const auto lowest = [](SearchMethod method) {
    const Surface surface = pocket_surface(3);
    PointSearch search(std::vector<SearchAxis>(surface.axes), method, 1);
    double best = 1.0;
    for (int flight = 0; flight < 40; ++flight) {
      const double margin = surface.margin(search.next(1).front());
      best = std::min(best, margin);
      search.tell({margin});
    }
    return best;
  };
  EXPECT_LT(lowest(SearchMethod::kModel), -0.13);  // the lowest is about -0.17
  EXPECT_LT(lowest(SearchMethod::kModel), lowest(SearchMethod::kRandom) - 0.05);
}

TEST(PointSearch, ProposesEqualPointsForEqualValues) {
  const Surface surface = border_surface();
  PointSearch one(std::vector<SearchAxis>(surface.axes), SearchMethod::kModel, 7);
  PointSearch two(std::vector<SearchAxis>(surface.axes), SearchMethod::kModel, 7);
  PointSearch other(std::vector<SearchAxis>(surface.axes), SearchMethod::kModel, 8);
  EXPECT_NE(other.next(1), PointSearch(one).next(1));
  for (int flight = 0; flight < 12; ++flight) {
    const Points points = one.next(1);
    ASSERT_EQ(points, two.next(1)) << flight;
    ASSERT_TRUE((points[0].array() >= 0.0).all() && (points[0].array() <= 1.0).all());
    one.tell({surface.margin(points[0])});
    two.tell({surface.margin(points[0])});
  }
}

/// Points that are chosen together are different ones, and find the failure too.
TEST(PointSearch, ChoosesSeveralPointsTogether) {
  const Surface surface = corner_surface();
  PointSearch search(std::vector<SearchAxis>(surface.axes), SearchMethod::kModel, 2);
  int failures = 0;
  Points all;
  for (int batch = 0; batch < 6; ++batch) {
    const Points points = search.next(4);
    ASSERT_EQ(points.size(), 4U);
    std::vector<double> margins;
    for (const Eigen::VectorXd& point : points) {
      for (const Eigen::VectorXd& known : all) EXPECT_GT((known - point).norm(), 1e-6);
      all.push_back(point);
      margins.push_back(surface.margin(point));
      failures += margins.back() < 0.0 ? 1 : 0;
    }
    search.tell(margins);
  }
  EXPECT_GT(failures, 3);  // 24 random points: 0.6
}

/// Axes with values have as many points as combinations; each is proposed once, then none.
TEST(PointSearch, ProposesEachPointOfAGridOnce) {
  for (const SearchMethod method : {SearchMethod::kModel, SearchMethod::kRandom}) {
    PointSearch search({{3}, {4}}, method, 1);
    std::set<std::pair<double, double>> seen;
    while (true) {
      const Points points = search.next(1);
      if (points.empty()) break;
      const double x = points[0](0);
      const double y = points[0](1);
      EXPECT_DOUBLE_EQ(x * 3.0, std::floor(x * 3.0) + 0.5);
      EXPECT_DOUBLE_EQ(y * 4.0, std::floor(y * 4.0) + 0.5);
      EXPECT_TRUE(seen.emplace(x, y).second);
      search.tell({x - y});
    }
    EXPECT_EQ(seen.size(), 12U);
  }
}

/// Equal margins everywhere (the estimator never notices the axes) are no problem.
TEST(PointSearch, GoesOnWhereAllMarginsAreEqual) {
  PointSearch search({{}, {}}, SearchMethod::kModel, 1);
  Points all;
  for (int flight = 0; flight < 15; ++flight) {
    all.push_back(search.next(1).front());
    ASSERT_TRUE(all.back().allFinite());
    search.tell({1.0});
  }
  double nearest = 1.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (all[i] - all[j]).norm());
  }
  EXPECT_GT(nearest, 0.05) << "it fills the space";
}

}  // namespace
}  // namespace overfly::server::experiments
