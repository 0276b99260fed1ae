// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/guard_link.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "kestrel/comms/guard/guard_start.h"
#include "kestrel/comms/mavlink/wait_readable.h"
#include "kestrel/core/base/error.h"

extern char** environ;

namespace kestrel {
namespace {

constexpr Duration kLifePeriod = std::chrono::milliseconds(20);
constexpr Duration kLate = std::chrono::milliseconds(100);
constexpr Duration kAnswerPatience = std::chrono::milliseconds(500);
constexpr Duration kStartPatience = std::chrono::seconds(10);
constexpr Duration kEndPatience = std::chrono::milliseconds(500);
constexpr char kName[] = "kestrel-guard";

// The guard's program: the option's, the one beside this program, or a name that PATH has.
std::string ProgramOf(const GuardOptions& options) {
  if (!options.program.empty()) return options.program;
  std::error_code error;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = own.parent_path() / kName;
  return !error && std::filesystem::exists(beside, error) ? beside.string() : kName;
}

// Starts the guard in a session of its own, so that what ends this program's does not end it.
int Spawn(const std::string& program, char* const* arguments, int socket, pid_t* process) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, socket, kGuardFile);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  const int error = posix_spawnp(process, program.c_str(), &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

}  // namespace

GuardLink::GuardLink(const std::string& url, const GuardOptions& options,
                     const std::string& signing_key)
    : url_(ParseLinkUrl(url)) {
  Start(options, signing_key);
  AwaitStart();
}

GuardLink::~GuardLink() {
  SendGoodbye();
  // The line is free for another program when this one has ended.
  std::array<std::uint8_t, 4096> rest;
  for (const Time end = Now() + kEndPatience; has_guard_ && Now() < end;) {
    WaitReadable(guard_.number(), end - Now());
    const ReceivedDatagram datagram = ReceiveFrom(guard_.number(), rest);
    if (datagram.is_end || datagram.kind == GuardMessage::kTakenOver) break;
  }
  if (has_guard_) waitpid(process_, nullptr, WNOHANG);
}

void GuardLink::Start(const GuardOptions& options, const std::string& signing_key) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw InputError("the guard cannot be started: " + std::generic_category().message(errno));
  }
  guard_ = FileDescriptor(ends[0]);
  const FileDescriptor other(ends[1]);
  const std::string program = ProgramOf(options);
  std::string name = kName, url = url_.text, key = signing_key;
  std::string patience_ms = fmt::format("{}", std::lround(1e3 * options.silence_s));
  const std::array<char*, 5> arguments = {name.data(), url.data(), patience_ms.data(), key.data(),
                                          nullptr};
  const int error = Spawn(program, arguments.data(), other.number(), &process_);
  if (error != 0) {
    throw InputError(fmt::format(
        "the guard's program {} cannot be started: {}; guidance does not fly without it, unless "
        "--no-guard is for that",
        program, std::generic_category().message(error)));
  }
}

void GuardLink::AwaitStart() {
  std::array<std::uint8_t, 1024> buffer{};
  for (const Time end = Now() + kStartPatience; Now() < end;) {
    WaitReadable(guard_.number(), end - Now());
    const ReceivedDatagram datagram = ReceiveFrom(guard_.number(), buffer);
    if (datagram.kind == GuardMessage::kWaits) return;
    Take(datagram);
    if (state_ == GuardState::kWatches) return;
    if (state_ == GuardState::kFailed) throw InputError(error_);
    if (datagram.is_end) break;
  }
  throw InputError("the guard has not opened the line in 10 s");
}

void GuardLink::SendLife(GuardLife life, Time now) {
  if (state_ != GuardState::kWatches || has_ended_) return;
  CheckGuard(now);
  if (now < life_due_) return;
  life_due_ = now + kLifePeriod;
  life.sent_ns = ToNanoseconds(now);
  SendTo(guard_.number(), GuardMessage::kLife,
         {reinterpret_cast<const std::uint8_t*>(&life), sizeof(life)});
  if (!unanswered_) unanswered_ = now;
}

// A guard that hangs would hold the line for good: it is killed. Where this program was late itself
// the answers are still to be read.
void GuardLink::CheckGuard(Time now) {
  const bool was_late = now - checked_ > kLate;
  checked_ = now;
  if (was_late) unanswered_.reset();
  if (unanswered_ && now - *unanswered_ > kAnswerPatience) kill(process_, SIGKILL);
}

void GuardLink::SendGoodbye() {
  if (has_ended_) return;
  has_ended_ = true;
  SendTo(guard_.number(), GuardMessage::kGoodbye);
}

std::size_t GuardLink::Receive(Duration timeout, std::span<std::uint8_t> buffer) {
  if (line_) return line_->Receive(timeout, buffer);
  const Time end = Now() + timeout;
  if (!has_guard_) {
    if (state_ == GuardState::kGone) OpenLine();
    std::this_thread::sleep_for(timeout);
    return 0;
  }
  do {
    std::array<pollfd, 2> files = {{{guard_.number(), POLLIN, 0}, {bell().file(), POLLIN, 0}}};
    WaitForAny(files, end - Now());
    if (files[1].revents != 0) {
      bell().Silence();
      if (files[0].revents == 0) return 0;
    }
    const ReceivedDatagram datagram = ReceiveFrom(guard_.number(), buffer);
    if (const std::size_t size = Take(datagram); size > 0) return size;
    if (datagram.is_end) TakeEnd();
  } while (has_guard_ && Now() < end);
  return 0;
}

// Returns the number of bytes of the line in it.
std::size_t GuardLink::Take(const ReceivedDatagram& datagram) {
  if (!datagram.kind) return 0;
  switch (*datagram.kind) {
    case GuardMessage::kBytes:
      return datagram.bytes.size();
    case GuardMessage::kReady:
      state_ = GuardState::kWatches;
      break;
    case GuardMessage::kAnswer:
      unanswered_.reset();
      is_connected_ = !datagram.bytes.empty() && datagram.bytes[0] != 0;
      open_error_ = datagram.bytes.size() > 1 ? datagram.bytes[1] : 0;
      break;
    case GuardMessage::kTakenOver:
      unanswered_.reset();
      state_ = GuardState::kTookOver;
      break;
    case GuardMessage::kFailed:
      error_.assign(datagram.bytes.begin(), datagram.bytes.end());
      state_ = GuardState::kFailed;
      break;
    default:
      break;
  }
  return 0;
}

// The guard's process has ended. Its status shows whether it had taken over: its last message may
// not have fitted into the socket.
void GuardLink::TakeEnd() {
  has_guard_ = is_connected_ = false;
  int status = 0;
  const bool is_known = waitpid(process_, &status, 0) == process_;
  if (has_ended_ || state_ == GuardState::kTookOver || state_ == GuardState::kFailed) return;
  if (is_known && WIFEXITED(status) && WEXITSTATUS(status) == kGuardTookOver) {
    state_ = GuardState::kTookOver;
    return;
  }
  error_ = is_known && WIFSIGNALED(status) ? fmt::format("killed by signal {}", WTERMSIG(status))
                                           : std::string("ended by itself");
  state_ = GuardState::kGone;
  OpenLine();
}

// The line is free as soon as the guard is gone.
void GuardLink::OpenLine() {
  constexpr Duration kAttemptPeriod = std::chrono::milliseconds(100);
  if (Now() < attempt_due_) return;
  attempt_due_ = Now() + kAttemptPeriod;
  try {
    line_ = OpenTransport(url_);
    open_line_ = line_.get();
  } catch (const InputError&) {
    // Another program has it, or the device is gone: a later Receive tries again.
    line_ = nullptr;
  }
}

void GuardLink::Confirm() {
  if (line_) line_->Confirm();
}

bool GuardLink::Send(std::span<const std::uint8_t> frame) {
  if (Transport* const line = open_line_) return line->Send(frame);
  return state_ == GuardState::kWatches && SendTo(guard_.number(), GuardMessage::kBytes, frame);
}

bool GuardLink::is_connected() const {
  const Transport* const line = open_line_;
  return line != nullptr ? line->is_connected() : is_connected_.load();
}

bool GuardLink::has_datagrams() const {
  return url_.scheme == LinkScheme::kUdpIn || url_.scheme == LinkScheme::kUdpOut;
}

std::array<int, 2> GuardLink::files() const {
  return line_ ? line_->files() : std::array<int, 2>{guard_.number(), -1};
}

}  // namespace kestrel
