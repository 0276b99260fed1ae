// SPDX-License-Identifier: BSD-3-Clause
// For any input of a link, the parser, the signatures, the autopilot behind it and the camera for
// ground stations neither crash nor throw, and their results are finite. The first byte selects how
// the bytes are cut into datagrams. Each packet is also given to the autopilot as if its checksum
// and its sender were right, and to the camera as a command to it, so that the contents of messages
// need not pass these checks.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/camera_component.h"
#include "kestrel/comms/mavlink/message_table.h"
#include "kestrel/comms/mavlink/signing.h"

namespace {

using kestrel::mavlink::Packet;

void RequireFinite(const kestrel::PoseSample& pose) {
  if (!pose.world_from_body.translation.allFinite() ||
      !pose.world_from_body.rotation.coeffs().allFinite()) {
    std::abort();
  }
}

void RequireMiddleInImage(int /*request*/, const kestrel::ImageRegion& region, kestrel::Time) {
  const double x = 0.5 * (region.left + region.right), y = 0.5 * (region.top + region.bottom);
  if (!(x > -1e-6 && x < 1 + 1e-6 && y > -1e-6 && y < 1 + 1e-6)) std::abort();
}

kestrel::Connection& Line() {
  static kestrel::Connection line("udpout://127.0.0.1:9", {});
  return line;
}

Packet FromAutopilot(const Packet& packet) {
  Packet forged = packet;
  forged.system = 1;
  forged.component = 1;
  const auto known = kestrel::mavlink::KnownMessages();
  forged.id = known[packet.id % known.size()].id;
  return forged;
}

Packet ToCamera(const Packet& packet) {
  using kestrel::mavlink::CommandLong;
  auto command = kestrel::mavlink::ReadPayload<CommandLong>(packet.payload());
  command.target_system = 1;
  command.target_component = 100;
  Packet forged = packet;
  forged.id = CommandLong::kId;
  forged.header_size = kestrel::mavlink::kHeaderSize2;
  forged.payload_size = kestrel::mavlink::WritePayload(
      command, std::span<std::uint8_t, kestrel::mavlink::kMaxPayload>(
                   forged.bytes.data() + forged.header_size, kestrel::mavlink::kMaxPayload));
  return forged;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  kestrel::Autopilot autopilot({}, &Line(), {RequireFinite, RequireFinite, {}, {}});
  kestrel::CameraComponent camera(
      {.width_px = 640, .height_px = 480, .stream_uri = "rtsp://127.0.0.1:8554/kestrel"},
      {[](const auto&) {}, RequireMiddleInImage, [] {}, [](const auto&, bool) {}});
  kestrel::mavlink::Signing signing({1, 2, 3}, 0);
  const auto parser = std::make_unique<kestrel::mavlink::PacketParser>();
  kestrel::Time now = kestrel::TimeFromNanoseconds(1'000'000'000);
  const auto handle = [&](const Packet& packet) {
    autopilot.Tick(now);
    signing.Check(packet, 1'700'000'000'000'000'000);
    autopilot.Handle(packet, now);
    autopilot.Handle(FromAutopilot(packet), now);
    camera.Handle(packet, 1, now);
    camera.Handle(ToCamera(packet), 1, now);
    camera.Tick(now, {});
  };
  const std::size_t chunk = 1 + data[0];
  std::span<const std::uint8_t> bytes(data + 1, size - 1);
  while (!bytes.empty()) {
    const std::size_t count = std::min(chunk, bytes.size());
    parser->Parse(bytes.first(count), handle);
    if (chunk % 2 == 0) parser->EndDatagram(handle);
    bytes = bytes.subspan(count);
    now += std::chrono::milliseconds(20);
  }
  return 0;
}
