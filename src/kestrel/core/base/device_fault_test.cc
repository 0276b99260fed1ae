// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/device_fault.h"

#include <cerrno>
#include <csignal>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/test_eventually.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(DeviceFaultTest, DescribesCauseAndRemedyOfEachError) {
  EXPECT_THAT(DeviceFault("/dev/video987", ENOENT), StartsWith("there is no /dev/video987, "));
  EXPECT_THAT(DeviceFault("/dev/ttyTHS9", ENOENT), StartsWith("there is no /dev/ttyTHS9, "));
  EXPECT_THAT(DeviceFault("/dev/video987", EACCES),
              AllOf(StartsWith("/dev/video987: no permission"), HasSubstr("-aG video $USER")));
  EXPECT_THAT(DeviceFault("/dev/ttyAMA9", EACCES), HasSubstr("-aG dialout $USER"));
  EXPECT_THAT(DeviceFault("/dev/serial9", EPERM), HasSubstr("-aG dialout $USER"));
  EXPECT_THAT(DeviceFault("/dev/ttyACM9", EBUSY), HasSubstr("in use by another program"));
  EXPECT_THAT(DeviceFault("/dev/ttyACM9", ENXIO), HasSubstr("does not answer"));
}

TEST(DeviceFaultTest, NamesProgramThatUsesDevice) {
  const TestFolder folder;
  const std::string device = folder.Write("video5", "");
  const pid_t other = fork();
  if (other == 0) {
    execl("/bin/sh", "sh", "-c", ("exec sleep 60 <'" + device + "'").c_str(), nullptr);
    _exit(127);
  }
  std::string users;
  Eventually([&] {
    users = UsersOf(device);
    return users.find("sleep") != std::string::npos;
  });
  EXPECT_EQ(users, "sleep (process " + std::to_string(other) + ")");
  EXPECT_EQ(DeviceFault(device, EBUSY), device + ": in use by " + users);
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  EXPECT_EQ(UsersOf(device), "");
}

}  // namespace
}  // namespace kestrel
