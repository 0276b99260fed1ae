// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <pty.h>
#include <string>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/core/base/test_eventually.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// A flight in a terminal of its own, as in an ssh session.
class FlyTerminalTest : public CommandTest {
 protected:
  void Start(const std::string& arguments) {
    const std::string line = fmt::format("exec {} {}", KESTREL_COMMAND, arguments);
    process_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (process_ == 0) {
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(127);
    }
  }
  ~FlyTerminalTest() override {
    if (process_ > 0) kill(process_, SIGKILL);
    if (terminal_ >= 0) close(terminal_);
  }

  // Reads the terminal until it has shown 'words'. False: it was closed before.
  bool Await(const std::string& words) {
    std::string shown;
    char buffer[1024];
    while (shown.find(words) == std::string::npos) {
      const ssize_t size = read(terminal_, buffer, sizeof(buffer));
      if (size <= 0) return false;
      shown.append(buffer, static_cast<std::size_t>(size));
    }
    return true;
  }
  // As Ctrl-S does: whoever writes to the terminal waits.
  void StopOutput() const {
    const int own = open(ptsname(terminal_), O_RDWR | O_NOCTTY);
    ASSERT_EQ(tcflow(own, TCOOFF), 0);
    close(own);
  }
  void CloseTerminal() {
    close(terminal_);
    terminal_ = -1;
  }
  // Waits for a signal's effect or the flight's own end. Returns the exit status; -1: killed.
  int End() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string Flight() const {
    return Simulate("landing", "--scenario calm --seed 2 --set frames=30 --set rate_hz=10");
  }

  int terminal_ = -1;
  pid_t process_ = 0;
};

TEST_F(FlyTerminalTest, FlightSurvivesClosedTerminal) {
  Start("fly " + Flight() + " --output " + folder_ / "out");
  ASSERT_TRUE(Await("goes on when its terminal closes"));
  CloseTerminal();
  EXPECT_EQ(End(), 0);
  EXPECT_THAT(ReadFile(folder_ / "out/flight_end.csv"), HasSubstr("source ended"));
  EXPECT_EQ(Lines(ReadFile(folder_ / "out/landing_detections.csv")), 31);
}

TEST_F(FlyTerminalTest, FlightSurvivesStalledTerminal) {
  Start("fly " + Flight() + " --output " + folder_ / "out");
  ASSERT_TRUE(Await("goes on when its terminal closes"));
  StopOutput();
  EXPECT_EQ(End(), 0);
  EXPECT_EQ(Lines(ReadFile(folder_ / "out/landing_detections.csv")), 31);
}

TEST_F(FlyTerminalTest, SigtermEndsFlightWithCompleteFiles) {
  Start("fly " + Flight() + " --loop --output " + folder_ / "out");
  ASSERT_TRUE(Await("goes on when its terminal closes"));
  CloseTerminal();
  ASSERT_TRUE(
      Eventually([&] { return Lines(ReadFile(folder_ / "out/landing_detections.csv")) >= 3; }));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/flight_end.csv")) << "not before the end";
  kill(process_, SIGTERM);
  EXPECT_EQ(End(), 0);
  EXPECT_THAT(ReadFile(folder_ / "out/flight_end.csv"), HasSubstr("ended by the user"));
}

}  // namespace
}  // namespace kestrel
