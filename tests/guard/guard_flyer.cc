// SPDX-License-Identifier: BSD-3-Clause
// A program that flies through a guard, for its tests: fast, down and straight ahead as soon as the
// pilot gives it the mode, until it is killed. `guard_flyer URL KEY_FILE`; SIGUSR1: it crashes;
// SIGINT: it ends in order once the mode was left.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <signal.h>

#include "kestrel/comms/guard/guard_link.h"
#include "kestrel/comms/guard/life_of.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/set_point_message.h"

namespace kestrel {
namespace {

std::atomic<bool> is_interrupted = false;

class Flyer {
 public:
  Flyer(const char* url, const char* key) {
    auto guard = std::make_unique<GuardLink>(url, GuardOptions{}, key);
    guard_ = guard.get();
    ConnectionOptions link;
    link.signing_key = key;
    connection_ = std::make_unique<Connection>(url, link, Connection::Tap{}, std::move(guard));
    AutopilotOptions options;
    options.mode_rate_hz = 20;
    autopilot_ = std::make_unique<Autopilot>(options, connection_.get(), AutopilotListener{});
  }

  // Returns the guard's state at the end.
  GuardState Run() {
    while (!is_interrupted && guard_->state() != GuardState::kTookOver) {
      connection_->Receive(std::chrono::milliseconds(2),
                           [this](const mavlink::Packet& packet, Time received) {
                             autopilot_->Handle(packet, received);
                           });
      const Time now = Now();
      autopilot_->Tick(now);
      Fly(now);
      const GuardTask task = is_flying_ ? GuardTask::kStop : GuardTask::kNothing;
      guard_->SendLife(LifeOf(task, *autopilot_, *connection_), now);
    }
    return guard_->state();
  }

 private:
  void Fly(Time now) {
    if (now < due_ || !autopilot_->is_here()) return;
    due_ = now + std::chrono::milliseconds(20);
    is_flying_ = autopilot_->is_guided_mode() && autopilot_->is_armed();
    has_flown_ |= is_flying_;
    SetPoint set_point;
    if (is_flying_) set_point.velocity = {4.2, 0, -1};
    // PX4 gets them before it gives the mode, and never after it was left.
    if (is_flying_ || !has_flown_) SendSetPoint(set_point, *autopilot_, now, connection_.get());
  }

  GuardLink* guard_;
  std::unique_ptr<Connection> connection_;
  std::unique_ptr<Autopilot> autopilot_;
  Time due_{};
  bool is_flying_ = false;
  bool has_flown_ = false;
};

}  // namespace
}  // namespace kestrel

int main(int /*argc*/, char** argv) {
  signal(SIGUSR1, [](int) {
    signal(SIGSEGV, SIG_DFL);
    raise(SIGSEGV);
  });
  signal(SIGINT, [](int) { kestrel::is_interrupted = true; });
  try {
    return static_cast<int>(kestrel::Flyer(argv[1], argv[2]).Run());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 10;
  }
}
