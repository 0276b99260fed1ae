// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/guard_link.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kestrel/comms/guard/guard_messages.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

TEST(GuardLife, RejectsMalformedLifeMessage) {
  GuardLife life;
  life.task = GuardTask::kLand;
  std::array<std::uint8_t, sizeof(life)> bytes{};
  std::memcpy(bytes.data(), &life, sizeof(life));
  EXPECT_EQ(ReadLife(bytes)->task, GuardTask::kLand);
  EXPECT_FALSE(ReadLife(std::span(bytes).first(bytes.size() - 1)));
  bytes[0] = 77;
  EXPECT_FALSE(ReadLife(bytes));
}

TEST(GuardLink, ReportsFaults) {
  const auto error_of = [](const std::string& url, const std::string& program) {
    try {
      const GuardLink link(url, {.program = program}, "");
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(error_of("serial:///dev/no_such_line:57600", KESTREL_GUARD).find("no_such_line"),
            std::string::npos);
  EXPECT_NE(error_of("udpin://127.0.0.1:14999", "/no/guard").find("--no-guard"), std::string::npos);
  const std::string url = fmt::format("udpin://127.0.0.1:{}", FreeLoopbackPort());
  const GuardLink holder(url, {.program = KESTREL_GUARD}, "");
  EXPECT_NE(error_of(url, KESTREL_GUARD).find("in use by another program"), std::string::npos);
}

}  // namespace
}  // namespace kestrel
