#include "flight/mavlink/vehicle/exchange.hpp"

#include "core/text/number_text.hpp"

namespace overfly::flight::mavlink {

Error no_answer(const Exchange& exchange, const std::string& what, const Patience& patience) {
  const double seconds = static_cast<double>(patience.answer.count()) * 1e-3;
  return {ErrorCode::kIo,
          what + ": " + exchange.target().name() + " did not answer " +
              std::to_string(patience.attempts) + " requests within " + number_text(seconds) +
              " s each"};
}

}  // namespace overfly::flight::mavlink
