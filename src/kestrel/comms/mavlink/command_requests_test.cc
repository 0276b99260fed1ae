// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/command_requests.h"

#include <chrono>
#include <optional>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;

constexpr Time kStart = TimeFromNanoseconds(1'000'000'000);

mavlink::CommandLong GripperCommand() {
  mavlink::CommandLong command;
  command.command = mavlink::kCommandGripper;
  return command;
}

TEST(CommandRequests, RepeatsWhatIsNotAnswered) {
  CommandRequests requests;
  std::optional<CommandRequests::Ending> ended;
  requests.Want(GripperCommand());
  EXPECT_TRUE(requests.Next(kStart, &ended));
  EXPECT_FALSE(requests.Next(kStart + milliseconds(200), &ended));
  const auto repeated = requests.Next(kStart + milliseconds(300), &ended);
  ASSERT_TRUE(repeated);
  EXPECT_EQ(repeated->confirmation, 1);
}

// PX4 moves a gripper for a second, and rejects a repetition meanwhile.
TEST(CommandRequests, CommandInProgressIsNotRepeated) {
  CommandRequests requests;
  std::optional<CommandRequests::Ending> ended;
  requests.Want(GripperCommand());
  requests.Next(kStart, &ended);
  EXPECT_FALSE(requests.Handle({mavlink::kCommandGripper, mavlink::kResultInProgress}));
  EXPECT_FALSE(requests.Next(kStart + milliseconds(1500), &ended));
  EXPECT_TRUE(requests.IsWanted(mavlink::kCommandGripper));
  const auto ending = requests.Handle({mavlink::kCommandGripper, mavlink::kResultAccepted});
  ASSERT_TRUE(ending);
  EXPECT_TRUE(ending->is_accepted());
}

}  // namespace
}  // namespace kestrel
