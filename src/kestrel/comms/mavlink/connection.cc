// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/connection.h"

#include <utility>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr std::size_t kLargestDatagram = 65536;
constexpr std::uint8_t kFirstSystem = 1;

}  // namespace

Connection::Connection(const std::string& url, const ConnectionOptions& options, Tap tap,
                       std::unique_ptr<Transport> transport)
    : url_(url),
      takes_system_(options.system_id == 0),
      component_(static_cast<std::uint8_t>(options.component_id)),
      transport_(std::move(transport)),
      tap_(std::move(tap)),
      buffer_(kLargestDatagram),
      writer_(takes_system_ ? kFirstSystem : static_cast<std::uint8_t>(options.system_id),
              component_) {
  RequireValid(options);
  if (!options.signing_key.empty()) {
    const mavlink::SigningKey key = mavlink::ReadSigningKey(options.signing_key);
    timestamp_file_ = std::make_unique<TimestampFile>(options.signing_key + ".timestamp");
    signing_.emplace(key, timestamp_file_->stored());
  }
  if (!transport_) transport_ = OpenTransport(ParseLinkUrl(url));
}

bool Connection::SendFrame(std::span<const std::uint8_t> frame,
                           std::span<std::uint8_t, mavlink::kMaxFrame> memory) {
  if (signing_) {
    frame = signing_->Sign(frame, memory, mavlink::UnixNanoseconds());
    timestamp_file_->Set(signing_->timestamp());
  }
  const bool is_sent = transport_->Send(frame);
  ++(is_sent ? sent_ : unsent_);
  if (is_sent && tap_) tap_(frame, Now());
  return is_sent;
}

bool Connection::IsTrusted(const mavlink::Packet& packet) {
  if (!signing_) return true;
  const std::lock_guard lock(send_mutex_);
  switch (signing_->Check(packet, mavlink::UnixNanoseconds())) {
    case mavlink::Signing::Verdict::kGood:
      return true;
    case mavlink::Signing::Verdict::kUnsigned:
      ++unsigned_packets_;
      return false;
    case mavlink::Signing::Verdict::kForged:
      ++forged_packets_;
      return false;
    case mavlink::Signing::Verdict::kReplayed:
      ++replayed_packets_;
      return false;
  }
  return false;
}

void Connection::Receive(Duration timeout, const Handler& handler) {
  constexpr int kMaxReads = 64;
  for (int i = 0; i < kMaxReads && ReceiveOnce(i == 0 ? timeout : Duration::zero(), handler);) ++i;
}

// True when something was received.
bool Connection::ReceiveOnce(Duration timeout, const Handler& handler) {
  const std::size_t size = transport_->Receive(timeout, buffer_);
  if (size == 0) return false;
  const Time received = Now();
  bool is_mavlink = false;
  const auto take = [&](const mavlink::Packet& packet) {
    if (!IsTrusted(packet)) return;
    is_mavlink |= packet.is_known;
    ++received_;
    if (tap_) tap_(packet.frame(), received);
    handler(packet, received);
  };
  // A reference, because a function that captures this much does not fit into std::function without
  // allocation.
  const mavlink::PacketParser::Handler reference = std::ref(take);
  parser_.Parse(std::span(buffer_).first(size), reference);
  if (transport_->has_datagrams()) parser_.EndDatagram(reference);
  if (is_mavlink) transport_->Confirm();
  bad_checksums_ = parser_.bad_checksums();
  garbage_bytes_ = parser_.skipped_bytes();
  return true;
}

void Connection::SetSystem(std::uint8_t system) {
  const std::lock_guard lock(send_mutex_);
  writer_.set_system(system);
}

std::uint8_t Connection::system() const {
  const std::lock_guard lock(send_mutex_);
  return writer_.system();
}

mavlink::Signing::Timestamp Connection::signing_timestamp() const {
  const std::lock_guard lock(send_mutex_);
  return signing_ ? signing_->timestamp() : 0;
}

ConnectionCounters Connection::counters() const {
  return {received_,         sent_,           unsent_,          bad_checksums_, garbage_bytes_,
          unsigned_packets_, forged_packets_, replayed_packets_};
}

}  // namespace kestrel
