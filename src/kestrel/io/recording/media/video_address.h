// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// True for a camera whose images come over a network, late: an address (rtsp://, rtsps://, rtp://,
// udp://), or a GStreamer pipeline that begins with rtspsrc or udpsrc.
bool IsNetworkVideo(std::string_view camera);

// True for one of these addresses.
bool IsVideoAddress(std::string_view camera);

// Returns a text for people, in which each address rtsp://USER:PASSWORD@HOST is without user and
// password, "rtsp://***@HOST", and each password of a query or of GStreamer's rtspsrc is hidden:
// "?user=admin&password=***", "user-pw=***".
std::string WithoutPassword(std::string text);

// Returns the first elements of GStreamer's pipeline for an address: they deliver the encoded
// video without buffering more than it needs to put packets in order. Throws InputError when the
// address is not valid.
std::string NetworkVideoText(const std::string& address);

}  // namespace kestrel
