// Messages of a WebSocket client.
#include "server/net/stream/client_message.hpp"
#include "tests/fuzz/input_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)overfly::net::parse_client_message(std::string(overfly::fuzz::text_of(data, size)));
  return 0;
}
