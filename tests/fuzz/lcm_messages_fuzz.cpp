// What an estimator publishes on LCM channels, and the URL of a network.
//
// The first byte chooses: a pose, a debug message, a status, a URL.
#include "middleware/lcm/messages.hpp"
#include "middleware/lcm/url.hpp"
#include "tests/fuzz/input_folder.hpp"
#include "vo_bridges/lcm/lcm_answers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly;
  if (size == 0) return 0;
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  if (data[0] == 'p') {
    if (const auto pose = lcm::decode_message<overfly_lcm::pose_t>(bytes))
      (void)estimate_from(*pose);
  } else if (data[0] == 'd') {
    const auto debug = lcm::decode_message<overfly_lcm::debug_t>(bytes);
    if (debug) (void)debug_view_from(*debug, 64, 48);
  } else if (data[0] == 's') {
    (void)lcm::decode_message<overfly_lcm::status_t>(bytes);
  } else {
    const auto url = lcm::parse_url(std::string(fuzz::text_of(data + 1, size - 1)));
    if (url) (void)lcm::with_receive_buffer(*url).text();
  }
  return 0;
}
