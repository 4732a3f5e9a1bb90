// Messages that announce more than they hold.
#include "middleware/lcm/lengths.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <vector>

#include "middleware/lcm/messages.hpp"

namespace overfly::lcm {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <typename Message>
Bytes encoded(const Message& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  return bytes;
}

overfly_lcm::pose_t pose() {
  overfly_lcm::pose_t message{};
  message.counters = {{"features", 120.0}, {"inliers", 80.0}};
  message.ncounters = 2;
  message.timings_ms = {{"track", 3.5}};
  message.ntimings_ms = 1;
  return message;
}

overfly_lcm::debug_t debug() {
  overfly_lcm::debug_t message{};
  message.width = message.height = 1;
  message.data = {1, 2, 3};
  message.size = 3;
  message.points = {{1.0F, 2.0F, 3.0F}};
  message.npoints = 1;
  return message;
}

overfly_lcm::status_t status() {
  overfly_lcm::status_t message{};
  message.name = "shift";
  message.parameters = {{"features", "1000"}};
  message.nparameters = 1;
  message.lines = {"ready", ""};
  message.nlines = 2;
  return message;
}

/// Where the big-endian number stands last.
std::size_t place_of(const Bytes& bytes, std::uint8_t number) {
  const Bytes digits{0, 0, 0, number};
  const auto found = std::find_end(bytes.begin(), bytes.end(), digits.begin(), digits.end());
  EXPECT_NE(found, bytes.end());
  return static_cast<std::size_t>(found - bytes.begin());
}

Bytes announcing(Bytes bytes, std::size_t place, std::uint32_t number) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes.at(place + i) = static_cast<std::uint8_t>(number >> (24 - 8 * i));
  }
  return bytes;
}

long peak_memory_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

template <typename Message>
void expect_every_cut_refused(const Message& message) {
  const Bytes bytes = encoded(message);
  EXPECT_TRUE(decode_message<Message>(bytes).has_value());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_FALSE(decode_message<Message>(std::span(bytes).first(length)).has_value()) << length;
  }
}

TEST(LcmLengths, WholeMessagesAreTakenAndShorterOnesRefused) {
  expect_every_cut_refused(pose());
  expect_every_cut_refused(debug());
  expect_every_cut_refused(status());
}

TEST(LcmLengths, WhatAMessageAnnouncesTakesNoMemoryBeforeItIsThere) {
  constexpr std::uint32_t kTenMillion = 10'000'000;  // 400 MB of named numbers
  const Bytes bytes = encoded(pose());
  const Bytes points = encoded(debug());
  const long before_kb = peak_memory_kb();
  // The counters' number, the first 2 from the end; the points' number, the last 1.
  EXPECT_FALSE(
      decode_message<overfly_lcm::pose_t>(announcing(bytes, place_of(bytes, 2), kTenMillion))
          .has_value());
  EXPECT_FALSE(
      decode_message<overfly_lcm::debug_t>(announcing(points, place_of(points, 1), kTenMillion))
          .has_value());
  EXPECT_LT(peak_memory_kb() - before_kb, 50'000);
}

TEST(LcmLengths, NegativeNumbersAreRefused) {
  const Bytes bytes = encoded(debug());
  EXPECT_FALSE(
      decode_message<overfly_lcm::debug_t>(announcing(bytes, place_of(bytes, 1), 0xFFFFFFFFU))
          .has_value());
}

}  // namespace
}  // namespace overfly::lcm
