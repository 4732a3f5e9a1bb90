// A small world and a scenario over it, for tests of the program's commands.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/support/support.hpp"

namespace overfly::testing {

/// The world is made by the program itself.
class CommandLine : public ::testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override { ASSERT_NE(folder_, nullptr); }

  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string world() { return path("world"); }
  static std::string scenario_file() { return path("small.json"); }
  /// True if EGL works on this machine.
  static bool draws() { return draws_; }

 private:
  static TemporaryFolder* folder_;
  static bool draws_;
};

#define SKIP_WITHOUT_EGL() \
  if (!draws()) GTEST_SKIP() << "no EGL on this machine"

}  // namespace overfly::testing
