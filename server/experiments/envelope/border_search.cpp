#include "server/experiments/envelope/border_search.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace overfly::server::experiments {
namespace {

using Index = std::ptrdiff_t;

std::size_t distance(const GridLine& a, const GridLine& b) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < a.at.size(); ++i) {
    sum += a.at[i] > b.at[i] ? a.at[i] - b.at[i] : b.at[i] - a.at[i];
  }
  return sum;
}

/// One line, with its outcomes in the direction in which survival ends: place 0 is the one that
/// survives most easily.
class Line {
 public:
  Line(std::size_t line, Index count, bool reversed, const AskPlaces& ask)
      : line_(line), count_(count), reversed_(reversed), ask_(ask) {}

  Status ask(const std::vector<Index>& places) {
    std::vector<GridPlace> unknown;
    std::vector<Index> order;
    for (const Index place : places) {
      const bool wanted = std::find(order.begin(), order.end(), place) == order.end();
      if (known_.count(place) > 0 || !wanted) continue;
      unknown.push_back({line_, value_of(place)});
      order.push_back(place);
    }
    if (unknown.empty()) return {};
    const Result<std::vector<bool>> answers = ask_(unknown);
    if (!answers) return answers.error();
    for (std::size_t i = 0; i < order.size(); ++i) known_[order[i]] = (*answers)[i];
    return {};
  }
  [[nodiscard]] bool survives(Index place) const { return known_.at(place); }
  [[nodiscard]] std::size_t asked() const { return known_.size(); }
  void reverse() {
    std::map<Index, bool> turned;
    for (const auto& [place, outcome] : known_) turned[count_ - 1 - place] = outcome;
    known_ = std::move(turned);
    reversed_ = !reversed_;
  }

  /// @pre `low` is -1 or survives; `high` is count or fails; low < high
  Status bisect(Index low, Index high) {
    while (high - low > 1) {
      const Index middle = low + (high - low) / 2;
      if (Status status = ask({middle}); !status) return status;
      (survives(middle) ? low : high) = middle;
    }
    low_ = low;
    high_ = high;
    return {};
  }
  /// From the border of another line: its last survivor, -1 to count - 1.
  Status follow(Index guess) {
    std::vector<Index> first;
    for (const Index place : {guess, guess + 1}) {
      if (place >= 0 && place < count_) first.push_back(place);
    }
    if (Status status = ask(first); !status) return status;
    const bool low_survives = guess < 0 || survives(guess);
    const bool high_fails = guess + 1 >= count_ || !survives(guess + 1);
    if (low_survives && high_fails) return bisect(guess, guess + 1);
    if (low_survives) return climb(guess + 1);
    if (high_fails) return descend(guess);
    return climb(guess + 1);  // irregular
  }
  [[nodiscard]] LineBorder border() const {
    LineBorder border;
    if (low_ >= 0) border.survives = value_of(low_);
    if (high_ < count_) border.fails = value_of(high_);
    border.irregular = std::any_of(known_.begin(), known_.end(), [this](const auto& entry) {
      return entry.second != (entry.first <= low_);
    });
    return border;
  }
  [[nodiscard]] Index low() const { return low_; }

 private:
  [[nodiscard]] std::size_t value_of(Index place) const {
    return static_cast<std::size_t>(reversed_ ? count_ - 1 - place : place);
  }
  /// @pre `low` survives
  Status climb(Index low) {
    for (Index step = 1; low + 1 < count_; step *= 2) {
      const Index next = std::min(low + step, count_ - 1);
      if (Status status = ask({next}); !status) return status;
      if (!survives(next)) return bisect(low, next);
      low = next;
    }
    return bisect(low, count_);
  }
  /// @pre `high` fails
  Status descend(Index high) {
    for (Index step = 1; high > 0; step *= 2) {
      const Index next = std::max<Index>(high - step, 0);
      if (Status status = ask({next}); !status) return status;
      if (survives(next)) return bisect(next, high);
      high = next;
    }
    return bisect(-1, high);
  }

  std::size_t line_;
  Index count_;
  bool reversed_;
  const AskPlaces& ask_;
  std::map<Index, bool> known_;
  Index low_ = -1;
  Index high_ = 0;
};

}  // namespace

Result<Borders> find_borders(const std::vector<GridLine>& lines,
                             std::size_t values,
                             const AskPlaces& ask) {
  Borders found;
  found.lines.resize(lines.size());
  const auto count = static_cast<Index>(values);
  // Until a line has both outcomes it is not known at which end survival is easier.
  std::optional<bool> reversed;
  std::vector<Index> guesses(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Line line(i, count, reversed.value_or(false), ask);
    Status status;
    if (reversed) {
      const auto nearest = std::min_element(
          lines.begin(), lines.begin() + static_cast<Index>(i), [&](const auto& a, const auto& b) {
            return distance(a, lines[i]) < distance(b, lines[i]);
          });
      status = line.follow(guesses[static_cast<std::size_t>(nearest - lines.begin())]);
    } else {
      status = line.ask({0, count - 1});
      if (status && line.survives(0) != line.survives(count - 1)) {
        reversed = !line.survives(0);
        if (*reversed) {
          line.reverse();
          // Lines before have no border: their ends are those of the other direction.
          for (std::size_t j = 0; j < i; ++j) {
            guesses[j] = guesses[j] < 0 ? -1 : count - 1;
            if (found.lines[j].survives) found.lines[j].survives = 0;
            if (found.lines[j].fails) found.lines[j].fails = values - 1;
          }
        }
        status = line.bisect(0, count - 1);
      } else if (status) {
        status = line.survives(0) ? line.bisect(count - 1, count) : line.bisect(-1, 0);
      }
    }
    if (!status) return status.error();
    guesses[i] = line.low();
    found.lines[i] = line.border();
    found.asked += line.asked();
  }
  return found;
}

}  // namespace overfly::server::experiments
