#include "core/motion/time_order.hpp"

#include <algorithm>
#include <numeric>

namespace overfly {
namespace {

/// Count of the lines that match, and the first of them.
struct Found {
  std::size_t count = 0;
  int first_line = 0;

  void add(int line) {
    if (count == 0 || line < first_line) first_line = line;
    ++count;
  }
  [[nodiscard]] std::string text(const std::string& file, const std::string& what) const {
    return file + ": " + std::to_string(count) + " " + what + " (first in line " +
           std::to_string(first_line) + ")";
  }
};

Found out_of_order(const std::vector<TimedLine>& lines) {
  Found found;
  std::int64_t latest_ns = INT64_MIN;
  for (const TimedLine& line : lines) {
    if (line.t_ns < latest_ns) found.add(line.line);
    latest_ns = std::max(latest_ns, line.t_ns);
  }
  return found;
}

}  // namespace

TimeOrder order_by_time(const std::string& file,
                        const std::string& what,
                        const std::vector<TimedLine>& lines) {
  std::vector<std::size_t> sorted(lines.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
    return lines[a].t_ns < lines[b].t_ns;
  });
  TimeOrder order;
  Found repeated;
  for (const std::size_t i : sorted) {
    if (!order.kept.empty() && lines[order.kept.back()].t_ns == lines[i].t_ns) {
      repeated.add(lines[i].line);
    } else {
      order.kept.push_back(i);
    }
  }
  const Found moved = out_of_order(lines);
  if (repeated.count > 0) {
    order.warnings.push_back(repeated.text(file, what) +
                             " repeat the time of an earlier line and are ignored");
  }
  if (moved.count > 0) {
    order.warnings.push_back(moved.text(file, what) + " are out of time order: sorted by time");
  }
  return order;
}

}  // namespace overfly
