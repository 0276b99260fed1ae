// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <sys/types.h>

#include "kestrel/comms/guard/guard_messages.h"
#include "kestrel/comms/guard/guard_options.h"
#include "kestrel/comms/mavlink/file_descriptor.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/transport.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

enum class GuardState {
  kWaits,     // the guard of an earlier flight still works on the line
  kWatches,   // the guard holds the line
  kGone,      // it has died: this program has the line itself
  kTookOver,  // it took this program for dead: this program does not reach the autopilot any more
  kFailed,    // it could not open the line
};

// The line to an autopilot through a guard, a process of its own that lives on when this one dies.
// Guard dead, or without an answer for 0.5 s: this program opens the line itself, at once.
class GuardLink : public Transport {
 public:
  // Starts the guard. 'signing_key': file with the key of signed packets; empty: none. Throws
  // InputError as OpenTransport does, and when the guard's program is not there.
  GuardLink(const std::string& url, const GuardOptions& options, const std::string& signing_key);
  // Sends goodbye, and waits for the line to be free unless the guard has taken over.
  ~GuardLink() override;
  GuardLink(const GuardLink&) = delete;
  GuardLink& operator=(const GuardLink&) = delete;

  // A sign of life, by the thread that sends set-points; sent on 50 times a second. 'life.sent_ns'
  // is filled in.
  void SendLife(GuardLife life, Time now);
  // The program ends: no sign of life comes any more. The guard ends, too, unless by the last
  // sign of life guidance flies.
  void SendGoodbye();

  GuardState state() const { return state_; }
  // Reason in words, where the state is kGone or kFailed. Called by the receiving thread.
  const std::string& error() const { return error_; }

  std::size_t Receive(Duration timeout, std::span<std::uint8_t> buffer) override;
  void Confirm() override;
  bool Send(std::span<const std::uint8_t> frame) override;
  bool is_connected() const override;
  bool has_datagrams() const override;
  int open_error() const override { return open_error_; }
  std::array<int, 2> files() const override;

 private:
  void Start(const GuardOptions& options, const std::string& signing_key);
  void AwaitStart();
  std::size_t Take(const ReceivedDatagram& datagram);
  void TakeEnd();
  void OpenLine();
  void CheckGuard(Time now);

  LinkUrl url_;
  FileDescriptor guard_;
  pid_t process_ = 0;
  std::atomic<GuardState> state_{GuardState::kWaits};
  std::string error_;
  std::atomic<bool> is_connected_{false};
  std::atomic<int> open_error_{0};
  bool has_guard_ = true;   // its process lives
  bool has_ended_ = false;  // goodbye was sent
  Time life_due_{};
  Time attempt_due_{};  // to open the line
  Time checked_{};
  std::optional<Time> unanswered_;              // the first sign of life without an answer
  std::unique_ptr<Transport> line_;             // once the guard is gone
  std::atomic<Transport*> open_line_{nullptr};  // the same, for senders
};

}  // namespace kestrel
