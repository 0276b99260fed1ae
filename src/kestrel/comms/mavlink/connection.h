// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/connection_counters.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/comms/mavlink/signing.h"
#include "kestrel/comms/mavlink/timestamp_file.h"
#include "kestrel/comms/mavlink/transport.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

struct ConnectionOptions {
  int system_id = 0;
  int component_id = 191;
  int camera_id = mavlink::kComponentCamera;
  std::string signing_key;

  static void Visit(auto& self, auto&& visit) {
    visit("system_id", self.system_id, Range{0, 255},
          "MAVLink system of this program; 0: the autopilot's");
    visit("component_id", self.component_id, Range{1, 255},
          "MAVLink component of this program; 191 is an on-board computer");
    visit("camera_id", self.camera_id, Range{7, 255},
          "MAVLink component of the camera in which a ground station marks what is followed");
    visit("signing_key", self.signing_key,
          "file with the key of signed packets (mode 0600); empty: not signed");
  }
};

// A line to an autopilot that carries messages: transport, parser, writer and signing. It
// reconnects by itself. One thread calls Receive; other threads may call Send meanwhile. Neither
// waits for the other end, throws, or allocates.
class Connection {
 public:
  using Handler = std::function<void(const mavlink::Packet&, Time received)>;
  // Receives every frame on the line, in the thread that sends or receives it.
  using Tap = std::function<void(std::span<const std::uint8_t> frame, Time time)>;

  // 'transport': the line to 'url'; null: it is opened. Throws InputError as ParseLinkUrl,
  // OpenTransport and ReadSigningKey do.
  Connection(const std::string& url, const ConnectionOptions& options, Tap tap = {},
             std::unique_ptr<Transport> transport = nullptr);

  // False when it was not sent: see ConnectionCounters::unsent.
  template <class Message>
  bool Send(const Message& message) {
    const std::lock_guard lock(send_mutex_);
    return SendFrame(message, &writer_);
  }
  // Sends by the writer of another component of this system.
  template <class Message>
  bool SendBy(mavlink::PacketWriter* writer, const Message& message) {
    const std::lock_guard lock(send_mutex_);
    writer->set_system(writer_.system());
    return SendFrame(message, writer);
  }

  // Waits at most 'timeout' for data from the other end or for Wake, and passes the packets to
  // 'handler'.
  // However much comes in, it returns soon after 'timeout'.
  void Receive(Duration timeout, const Handler& handler);

  // Ends the present wait of Receive, or else the next one. Any thread.
  void Wake() { transport_->Wake(); }

  // Sets the system id of this program (see ConnectionOptions::system_id).
  void SetSystem(std::uint8_t system);
  bool takes_system_of_autopilot() const { return takes_system_; }
  std::uint8_t system() const;
  std::uint8_t component() const { return component_; }
  // Timestamp of the newest signed packet; 0: nothing is signed.
  mavlink::Signing::Timestamp signing_timestamp() const;

  bool is_connected() const { return transport_->is_connected(); }
  // See Transport.
  int open_error() const { return transport_->open_error(); }
  const std::string& url() const { return url_; }
  ConnectionCounters counters() const;

 private:
  template <class Message>
  bool SendFrame(const Message& message, mavlink::PacketWriter* writer) {
    return SendFrame(writer->Write(message, signing_.has_value()), writer->memory());
  }
  bool SendFrame(std::span<const std::uint8_t> frame,
                 std::span<std::uint8_t, mavlink::kMaxFrame> memory);
  bool IsTrusted(const mavlink::Packet& packet);
  bool ReceiveOnce(Duration timeout, const Handler& handler);

  std::string url_;
  bool takes_system_;
  std::uint8_t component_;
  std::unique_ptr<Transport> transport_;
  Tap tap_;
  std::vector<std::uint8_t> buffer_;
  mavlink::PacketParser parser_;
  mutable std::mutex send_mutex_;  // guards the writer and the signing
  mavlink::PacketWriter writer_;
  std::unique_ptr<TimestampFile> timestamp_file_;
  std::optional<mavlink::Signing> signing_;

  std::atomic<std::uint64_t> received_ = 0;
  std::atomic<std::uint64_t> sent_ = 0;
  std::atomic<std::uint64_t> unsent_ = 0;
  std::atomic<std::uint64_t> bad_checksums_ = 0;
  std::atomic<std::uint64_t> garbage_bytes_ = 0;
  std::atomic<std::uint64_t> unsigned_packets_ = 0;
  std::atomic<std::uint64_t> forged_packets_ = 0;
  std::atomic<std::uint64_t> replayed_packets_ = 0;
};

}  // namespace kestrel
