// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// Returns the type of ROS that a message of Foxglove is read as: "sensor_msgs/CompressedImage" for
// "foxglove.CompressedImage"; nothing for types that are not read.
std::optional<std::string_view> RosTypeOfFoxglove(std::string_view type);

// Parse a message of Foxglove (docs.foxglove.dev/docs/sdk/schemas) in protobuf's wire format as the
// message of ROS that it corresponds to. Lists of bytes point into 'bytes'. A header is that of
// either image. Throw InputError with 'name' when the bytes are broken.
void ParseFoxglove(std::string_view bytes, const std::string& name, HeaderMessage* message);
void ParseFoxglove(std::string_view bytes, const std::string& name, ImageMessage* message);
void ParseFoxglove(std::string_view bytes, const std::string& name,
                   CompressedImageMessage* message);
void ParseFoxglove(std::string_view bytes, const std::string& name, CameraInfoMessage* message);
void ParseFoxglove(std::string_view bytes, const std::string& name, PoseStampedMessage* message);
void ParseFoxglove(std::string_view bytes, const std::string& name, TfMessage* message);

template <class Message>
concept HasFoxgloveForm = requires(Message message, std::string name) {
  ParseFoxglove(std::string_view(), name, &message);
};

}  // namespace kestrel
