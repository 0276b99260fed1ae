// SPDX-License-Identifier: BSD-3-Clause
// For any bytes of a message, each type is parsed or refused. The first byte selects the
// serialization.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "kestrel/core/base/error.h"
#include "kestrel/io/ros_messages/camera_info.h"
#include "kestrel/io/ros_messages/image_message.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace {

const std::string kName = "message";

template <class Message, class Use>
void Read(std::string_view bytes, kestrel::WireFormat format, const Use& use) {
  try {
    use(kestrel::ParseMessage<Message>(bytes, format, kName));
  } catch (const kestrel::InputError&) {
  }
}

template <class Message>
void ReadOnly(std::string_view bytes, kestrel::WireFormat format) {
  Read<Message>(bytes, format, [](const Message&) {});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array kFormats = {kestrel::WireFormat::kRos1, kestrel::WireFormat::kCdr,
                                   kestrel::WireFormat::kProtobuf};
  const kestrel::WireFormat format = kFormats[data[0] % kFormats.size()];
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto decode = [](const auto& image) {
    if (kestrel::DecodeImage(image, kestrel::PixelFormat::kBgr, kName).empty()) std::abort();
  };
  Read<kestrel::ImageMessage>(bytes, format, decode);
  Read<kestrel::CompressedImageMessage>(bytes, format, decode);
  Read<kestrel::CameraInfoMessage>(bytes, format, [](const kestrel::CameraInfoMessage& info) {
    const auto calibration = kestrel::CalibrationOf(info, /*is_rectified=*/false, kName);
    if (!calibration.intrinsics.Validate().empty()) std::abort();
  });
  ReadOnly<kestrel::HeaderMessage>(bytes, format);
  ReadOnly<kestrel::PoseStampedMessage>(bytes, format);
  ReadOnly<kestrel::TfMessage>(bytes, format);
  if (format == kestrel::WireFormat::kProtobuf) return 0;  // the others have no form there
  ReadOnly<kestrel::PoseWithCovarianceStampedMessage>(bytes, format);
  ReadOnly<kestrel::TransformStampedMessage>(bytes, format);
  ReadOnly<kestrel::OdometryMessage>(bytes, format);
  return 0;
}
