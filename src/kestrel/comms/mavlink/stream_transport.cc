// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/stream_transport.h"

#include <algorithm>
#include <cerrno>
#include <sys/socket.h>
#include <utility>

#include "kestrel/comms/mavlink/wait_readable.h"

namespace kestrel {
namespace {

bool IsTemporary(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

void StreamTransport::Use(Line line) {
  const std::lock_guard lock(mutex_);
  file_ = std::move(line.file);
  rest_begin_ = rest_end_ = 0;
  is_broken_ = false;
  is_connected_ = file_.is_open() && !line.is_connecting;
  if (is_connected_) open_error_ = 0;
  heard_ = Now();
}

void StreamTransport::Close() {
  Use({});
  next_attempt_ = Now() + backoff_;
  constexpr Duration kLongestBackoff = std::chrono::seconds(2);
  backoff_ = std::min(2 * backoff_, kLongestBackoff);
}

std::size_t StreamTransport::Receive(Duration timeout, std::span<std::uint8_t> buffer) {
  if (is_broken_) Close();
  if (!file_.is_open()) {
    Reopen(timeout);
    return 0;
  }
  if (!is_connected_) {
    AwaitConnection(timeout);
    return 0;
  }
  std::array<pollfd, 3> files = {
      {{file_.number(), POLLIN, 0}, {listener(), POLLIN, 0}, {bell().file(), POLLIN, 0}}};
  if (WaitForAny(files, timeout) <= 0) return 0;
  if (files[2].revents != 0) bell().Silence();
  if (files[1].revents != 0) Replace();
  if (files[0].revents == 0 || !file_.is_open()) return 0;
  const ssize_t size = read(file_.number(), buffer.data(), buffer.size());
  if (size > 0) {
    heard_ = Now();
    backoff_ = kFirstBackoff;
    return static_cast<std::size_t>(size);
  }
  if (size == 0 || !IsTemporary(errno)) Close();
  return 0;
}

void StreamTransport::Reopen(Duration timeout) {
  if (listener() >= 0) {
    if (WaitReadable(listener(), timeout)) Use(Open());
    return;
  }
  const Duration wait = next_attempt_ - Now();
  if (wait > Duration::zero()) {
    WaitForAny({}, std::min(wait, timeout));
    return;
  }
  Line line = Open();
  if (line.file.is_open()) {
    Use(std::move(line));
  } else {
    open_error_ = errno;
    Close();
  }
}

void StreamTransport::AwaitConnection(Duration timeout) {
  constexpr Duration kPatience = std::chrono::seconds(5);
  pollfd entry = {file_.number(), POLLOUT, 0};
  if (WaitForAny({&entry, 1}, timeout) <= 0) {
    if (Now() - heard_ <= kPatience) return;
    open_error_ = ETIMEDOUT;
    return Close();
  }
  int error = 0;
  socklen_t size = sizeof(error);
  if (getsockopt(file_.number(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
  open_error_ = error;
  is_connected_ = error == 0;
  if (error != 0) Close();
}

// Somebody else has connected. It is an autopilot that was cut off without closing the line, unless
// the present one is still sending.
void StreamTransport::Replace() {
  constexpr Duration kSilence = std::chrono::seconds(2);
  Line line = Open();
  if (line.file.is_open() && Now() - heard_ > kSilence) Use(std::move(line));
}

ssize_t StreamTransport::Write(int file, std::span<const std::uint8_t> bytes) {
  return send(file, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

// Sends the rest of the previous frame; true when nothing is left.
bool StreamTransport::Flush() {
  while (rest_begin_ < rest_end_) {
    const ssize_t size =
        Write(file_.number(), {rest_.data() + rest_begin_, rest_end_ - rest_begin_});
    if (size <= 0) {
      if (size < 0 && !IsTemporary(errno)) is_broken_ = true;
      return false;
    }
    rest_begin_ += static_cast<std::size_t>(size);
  }
  return true;
}

bool StreamTransport::Send(std::span<const std::uint8_t> frame) {
  const std::lock_guard lock(mutex_);
  if (!is_connected_ || is_broken_ || frame.size() > rest_.size() || !Flush()) return false;
  std::copy(frame.begin(), frame.end(), rest_.begin());
  rest_begin_ = 0;
  rest_end_ = frame.size();
  if (Flush()) return true;
  const bool is_begun = rest_begin_ > 0 && !is_broken_;
  if (!is_begun) rest_end_ = 0;
  return is_begun;
}

}  // namespace kestrel
