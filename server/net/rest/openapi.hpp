// The description of the REST interface that the server serves (server/net/rest/openapi.json).
#pragma once

#include <string>

namespace overfly::net {

[[nodiscard]] const std::string& openapi_text();

}  // namespace overfly::net
