// Health answers while every worker of the server is busy.
#include <gtest/gtest.h>

#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

HttpRequest get(const std::string& target) {
  HttpRequest request;
  request.method = "GET";
  request.target = target;
  return request;
}

TEST(QuickRoutes, HealthAloneWaitsForNothing) {
  RestRouter router;
  add_service_routes(&router);
  EXPECT_TRUE(router.is_quick(get("/api/v1/health")));
  EXPECT_TRUE(router.is_quick(get("/api/v1/health?x=1")));
  EXPECT_FALSE(router.is_quick(get("/api/v1/runs")));
  EXPECT_FALSE(router.is_quick(get("/api/v1/openapi.json")));
}

}  // namespace
}  // namespace overfly::net
