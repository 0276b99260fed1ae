// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/service_manager.h"

#include <array>
#include <cstdlib>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

class ServiceManagerTest : public ::testing::Test {
 protected:
  ~ServiceManagerTest() override { unsetenv("NOTIFY_SOCKET"); }

  TestFolder folder_;
};

TEST_F(ServiceManagerTest, ReceivesState) {
  const std::string path = folder_ / "notify";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof(address.sun_path));
  path.copy(address.sun_path, path.size());
  const int file = socket(AF_UNIX, SOCK_DGRAM, 0);
  ASSERT_EQ(bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  EXPECT_TRUE(ServiceManager().Notify("READY=1"));
  std::array<char, 64> text{};
  const ssize_t size = recv(file, text.data(), text.size(), MSG_DONTWAIT);
  EXPECT_EQ(std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))),
            "READY=1");
  close(file);
  EXPECT_FALSE(ServiceManager().Notify("WATCHDOG=1"));  // it is gone
}

TEST_F(ServiceManagerTest, WorksWithoutServiceManager) {
  unsetenv("NOTIFY_SOCKET");
  EXPECT_FALSE(ServiceManager().Notify("READY=1"));
}

}  // namespace
}  // namespace kestrel
