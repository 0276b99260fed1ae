// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/guard_process.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <sys/un.h>
#include <thread>
#include <utility>

#include "kestrel/comms/guard/guard_exchange.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/parameter_reader.h"
#include "kestrel/comms/mavlink/wait_readable.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(5);

// Binds the name by which guards that work on this line know each other: it is in no file system,
// and gone with the process. Nothing open: another guard has it.
FileDescriptor MarkWork(std::string_view url) {
  constexpr std::string_view kPrefix = "kestrel-guard ";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  char* const name = address.sun_path + 1;  // the zero before it: no file
  const std::size_t room = sizeof(address.sun_path) - 1;
  const std::size_t size = std::min(url.size(), room - kPrefix.size());
  kPrefix.copy(name, kPrefix.size());
  url.copy(name + kPrefix.size(), size);
  FileDescriptor mark(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const auto length =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + kPrefix.size() + size);
  if (bind(mark.number(), reinterpret_cast<const sockaddr*>(&address), length) != 0) mark.Close();
  return mark;
}

}  // namespace

GuardProcess::GuardProcess(int program, const std::string& url, Duration patience,
                           const std::string& signing_key)
    : program_(program),
      url_(ParseLinkUrl(url)),
      guard_(patience),
      read_([this](const mavlink::Packet& packet) { Read(packet); }) {
  if (!signing_key.empty()) signing_.emplace(mavlink::ReadSigningKey(signing_key), 0);
  OpenLine();
  SendTo(program_, GuardMessage::kReady);
}

void GuardProcess::OpenLine() {
  for (bool has_reported = false; !line_;) {
    try {
      line_ = OpenTransport(url_);
    } catch (const InputError&) {
      if (MarkWork(url_.text).is_open()) throw;
      if (!std::exchange(has_reported, true)) SendTo(program_, GuardMessage::kWaits);
      if (ReceiveFrom(program_, buffer_).is_end) throw;
      std::this_thread::sleep_for(kTick);
    }
  }
}

bool GuardProcess::Run() {
  while (!guard_.is_done()) {
    Wait();
    ForwardFromLine();
    if (has_program_) ForwardFromProgram();
    Act(guard_.Update(Now()));
  }
  return guard_.has_taken_over();
}

void GuardProcess::Wait() const {
  const std::array<int, 2> line = line_->files();
  std::array<pollfd, 3> files = {
      {{line[0], POLLIN, 0}, {line[1], POLLIN, 0}, {has_program_ ? program_ : -1, POLLIN, 0}}};
  WaitForAny(files, kTick);
}

// Also opens a broken line again.
void GuardProcess::ForwardFromLine() {
  constexpr int kMostReads = 16;
  for (int i = 0; i < kMostReads; ++i) {
    const std::size_t size = line_->Receive(Duration::zero(), buffer_);
    if (size == 0) return;
    const auto bytes = std::span(buffer_).first(size);
    if (has_program_) SendTo(program_, GuardMessage::kBytes, bytes);
    was_mavlink_ = false;
    parser_.Parse(bytes, read_);
    if (line_->has_datagrams()) parser_.EndDatagram(read_);
    if (was_mavlink_) line_->Confirm();
  }
}

// All that waits is read before the program is judged: the guard may have been late itself.
void GuardProcess::ForwardFromProgram() {
  constexpr int kMostReads = 2048;
  for (int i = 0; i < kMostReads; ++i) {
    const ReceivedDatagram datagram = ReceiveFrom(program_, buffer_);
    if (datagram.is_end) {
      has_program_ = false;
      guard_.TakeEnd();
    }
    if (!datagram.kind) return;
    TakeFromProgram(*datagram.kind, datagram.bytes);
  }
}

void GuardProcess::TakeFromProgram(GuardMessage kind, std::span<const std::uint8_t> bytes) {
  if (guard_.has_taken_over()) {
    SendTo(program_, GuardMessage::kTakenOver);
    return;
  }
  if (kind == GuardMessage::kBytes) {
    line_->Send(bytes);
  } else if (kind == GuardMessage::kGoodbye) {
    guard_.TakeEnd();
  } else if (const auto life = ReadLife(bytes); life && kind == GuardMessage::kLife) {
    TakeLife(*life);
  }
}

void GuardProcess::TakeLife(const GuardLife& life) {
  life_ = life;
  guard_.TakeLife(life.task, life.kind, std::min(TimeFromNanoseconds(life.sent_ns), Now()));
  const std::array<std::uint8_t, 2> answer = {
      line_->is_connected() ? std::uint8_t{1} : std::uint8_t{0},
      static_cast<std::uint8_t>(line_->open_error())};
  SendTo(program_, GuardMessage::kAnswer, answer);
}

// Reads a packet of the line: the state of the autopilot.
void GuardProcess::Read(const mavlink::Packet& packet) {
  was_mavlink_ |= packet.is_known;
  if (packet.system != life_.autopilot_system || packet.component != life_.autopilot_component) {
    return;
  }
  if (signing_ &&
      signing_->Check(packet, mavlink::UnixNanoseconds()) != mavlink::Signing::Verdict::kGood) {
    return;
  }
  TakePacket(packet, life_, Now(), &guard_);
}

void GuardProcess::Act(const GuardAction& action) {
  if (guard_.has_taken_over() && !std::exchange(works_, true)) {
    work_mark_ = MarkWork(url_.text);
    writer_ = mavlink::PacketWriter(life_.system, life_.component);
    if (signing_) signing_->Continue(life_.signing_timestamp);
    SendTo(program_, GuardMessage::kTakenOver);
  }
  SendAction(action, life_, [this](const auto& message) { Send(message); });
  if (action.text != nullptr) Report(action.text);
}

void GuardProcess::Report(const char* text) {
  mavlink::Statustext message;
  message.severity = mavlink::kSeverityCritical;
  SetText(text, message.text);
  Send(message);
}

template <class Message>
void GuardProcess::Send(const Message& message) {
  std::span<const std::uint8_t> frame = writer_.Write(message, signing_.has_value());
  if (signing_) frame = signing_->Sign(frame, writer_.memory(), mavlink::UnixNanoseconds());
  line_->Send(frame);
}

}  // namespace kestrel
