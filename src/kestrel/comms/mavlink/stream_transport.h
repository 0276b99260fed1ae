// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <sys/types.h>

#include "kestrel/comms/mavlink/file_descriptor.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/comms/mavlink/transport.h"

namespace kestrel {

// Common part of lines without datagrams. Subclasses define how a line is opened.
class StreamTransport : public Transport {
 public:
  std::size_t Receive(Duration timeout, std::span<std::uint8_t> buffer) override;
  bool Send(std::span<const std::uint8_t> frame) override;
  bool is_connected() const override { return is_connected_; }
  bool has_datagrams() const override { return false; }
  int open_error() const override { return open_error_; }
  std::array<int, 2> files() const override { return {file_.number(), listener()}; }

 protected:
  struct Line {
    FileDescriptor file;
    bool is_connecting = false;  // it is ready when it can be written to
  };

  // Returns a line, or one without a file while none can be opened. Does not block.
  virtual Line Open() = 0;
  // File on which new lines arrive by themselves; -1: lines have to be opened again.
  virtual int listener() const { return -1; }
  // As write() of the system, but never raises a signal.
  virtual ssize_t Write(int file, std::span<const std::uint8_t> bytes);

  void Use(Line line);

 private:
  void Reopen(Duration timeout);
  void AwaitConnection(Duration timeout);
  void Replace();
  void Close();
  bool Flush();

  FileDescriptor file_;  // changed only by the receiving thread, under the lock
  std::atomic<bool> is_connected_ = false;
  std::atomic<bool> is_broken_ = false;  // noticed by a sender
  std::atomic<int> open_error_ = 0;
  Time heard_{};
  Time next_attempt_{};
  Duration backoff_ = kFirstBackoff;
  std::mutex mutex_;  // guards the file against senders, and what follows
  // The part of a frame that the system did not accept: it is sent before the next frame.
  std::array<std::uint8_t, mavlink::kMaxFrame> rest_{};
  std::size_t rest_begin_ = 0;
  std::size_t rest_end_ = 0;

  static constexpr Duration kFirstBackoff = std::chrono::milliseconds(100);
};

}  // namespace kestrel
