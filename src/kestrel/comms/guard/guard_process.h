// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "kestrel/comms/guard/flight_guard.h"
#include "kestrel/comms/guard/guard_messages.h"
#include "kestrel/comms/mavlink/file_descriptor.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/comms/mavlink/signing.h"
#include "kestrel/comms/mavlink/transport.h"

namespace kestrel {

// The guard's process: holds the line of the autopilot, forwards bytes both ways, and does what
// FlightGuard decides. One thread. After Run has begun it neither allocates, locks nor throws.
class GuardProcess {
 public:
  // 'program': the socket to the program that flies. 'signing_key': file with the key; empty:
  // nothing is signed. Waits while the guard of an earlier flight works on the line, and reports
  // that to the program. Throws InputError when the line or the key cannot be opened.
  GuardProcess(int program, const std::string& url, Duration patience,
               const std::string& signing_key);

  // Returns when there is nothing more to do. True: it had taken over.
  bool Run();

 private:
  void OpenLine();
  void Wait() const;
  void ForwardFromLine();
  void ForwardFromProgram();
  void TakeFromProgram(GuardMessage kind, std::span<const std::uint8_t> bytes);
  void TakeLife(const GuardLife& life);
  void Read(const mavlink::Packet& packet);
  void Act(const GuardAction& action);
  void Report(const char* text);
  template <class Message>
  void Send(const Message& message);

  int program_;
  LinkUrl url_;
  std::unique_ptr<Transport> line_;
  FlightGuard guard_;
  GuardLife life_;  // the newest
  bool has_program_ = true;
  bool was_mavlink_ = false;
  bool works_ = false;        // it has taken over
  FileDescriptor work_mark_;  // shows the guard of the next flight that this one still works
  mavlink::PacketParser parser_;
  mavlink::PacketParser::Handler read_;
  mavlink::PacketWriter writer_{0, 0};  // with the ids of the program, once it has taken over
  std::optional<mavlink::Signing> signing_;
  std::array<std::uint8_t, 65536> buffer_{};
};

}  // namespace kestrel
