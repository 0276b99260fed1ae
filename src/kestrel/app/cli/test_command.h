// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {

// Exit status and output of a run of the command.
struct Outcome {
  int status;
  std::string out;
  std::string err;
};

inline auto Lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

// Runs the binary `kestrel` as a user does, with a folder for each test.
class CommandTest : public ::testing::Test {
 protected:
  // 'input': text for its stdin.
  Outcome Run(const std::string& arguments, const std::string& input = "") const {
    const std::string out = folder_ / "stdout";
    const std::string err = folder_ / "stderr";
    const std::string in = input.empty() ? "/dev/null" : folder_.Write("stdin", input);
    const int status = std::system(
        fmt::format("{} {} >'{}' 2>'{}' <'{}'", KESTREL_COMMAND, arguments, out, err, in).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadFile(out), ReadFile(err)};
  }
  // The same, and expects exit status 0.
  Outcome Succeed(const std::string& arguments) const {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 0) << arguments << "\n" << outcome.err;
    return outcome;
  }
  // Simulates a flight or a hunt that renders quickly. 'arguments': more of `kestrel simulate`.
  // Returns its folder.
  std::string Simulate(const std::string& what, const std::string& arguments) const {
    Succeed(
        fmt::format("simulate {} --output {} --set ground.map_px=256"
                    " --set shutter.rays_per_pixel=4 {}",
                    what, folder_ / what, arguments));
    return folder_ / what;
  }
  // Expects exit status 1 and one line on stderr that contains 'words'.
  void ExpectInputError(const std::string& arguments, const std::string& words) const {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 1) << arguments;
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(words)) << arguments;
    EXPECT_EQ(Lines(outcome.err), 1) << outcome.err;
  }

  TestFolder folder_;
};

}  // namespace kestrel
