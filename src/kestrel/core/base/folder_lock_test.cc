// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/folder_lock.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(FolderLock, ExcludesOthersUntilReleased) {
  const TestFolder test_folder;
  const std::string folder = test_folder.path();
  {
    const FolderLock lock(folder);
    EXPECT_THAT([&] { FolderLock second(folder); },
                ThrowsMessage<InputError>(HasSubstr(folder + ": another program")));
  }
  EXPECT_NO_THROW(FolderLock again(folder));
}

TEST(FolderLock, ReportsMissingFolder) {
  EXPECT_THAT([] { FolderLock lock("/no/such/folder"); },
              ThrowsMessage<InputError>(HasSubstr("/no/such/folder: cannot be locked")));
}

}  // namespace
}  // namespace kestrel
