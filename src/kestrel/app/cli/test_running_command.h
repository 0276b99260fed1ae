// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <regex>
#include <stdexcept>
#include <string>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/core/base/test_eventually.h"

namespace kestrel {

// Runs the command in the background; ends it with Ctrl-C.
class RunningCommand {
 public:
  // 'folder': for the file 'log' with its stderr.
  RunningCommand(const std::string& arguments, const TestFolder& folder)
      : log_(folder.Write("log", "")) {
    const std::string line = fmt::format("exec {} {} 2>'{}'", KESTREL_COMMAND, arguments, log_);
    process_ = fork();
    if (process_ != 0) return;
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  ~RunningCommand() { End(); }

  // Returns its stderr so far.
  std::string Log() const { return ReadFile(log_); }

  // Returns the port of its page. Throws when it serves no page.
  int Port() const {
    const std::regex url("console: http://127\\.0\\.0\\.1:([0-9]+)/");
    std::string log;
    std::smatch match;
    Eventually([&] {
      log = Log();
      return std::regex_search(log, match, url) || waitpid(process_, nullptr, WNOHANG) != 0;
    });
    if (match.empty()) throw std::runtime_error("serves no page: " + Log());
    return std::stoi(match[1]);
  }

  // Ends it. Returns its exit status; -1 when it had ended by itself.
  int End() {
    if (process_ <= 0) return -1;
    kill(process_, SIGINT);
    int status = 0;
    const bool was_there = waitpid(process_, &status, 0) == process_;
    process_ = 0;
    return was_there && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::string log_;
  pid_t process_ = 0;
};

}  // namespace kestrel
