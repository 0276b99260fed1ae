// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace kestrel {

// Properties of a video file's container by the sizes in its outermost boxes: its duration and rate
// are estimates, its sizes are not.
struct VideoContainer {
  // Name of GStreamer's element for it; empty when another element may be needed.
  std::string demuxer;
  std::uint64_t file_bytes = 0;
  // Bytes that a whole file has at least; more than file_bytes when the file is cut off. Zero where
  // the container does not have it (MPEG streams, recordings that were not closed).
  std::uint64_t expected_bytes = 0;

  bool is_cut_off() const { return file_bytes < expected_bytes; }
};

// Reads AVI, MP4 and QuickTime, Matroska and WebM; of other files only the size. A file that cannot
// be opened has no bytes.
VideoContainer ReadVideoContainer(const std::string& path);

}  // namespace kestrel
