// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "kestrel/app/foxglove/foxglove_file.h"
#include "kestrel/app/foxglove/observation_writer.h"

namespace kestrel {

// What ObservationWriter writes, as an MCAP file. All calls throw InputError when it cannot be
// written.
class ObservationFile {
 public:
  // 'view': what is looked for. The file must not be there unless 'replace' is set.
  ObservationFile(const std::string& path, bool replace, const CameraIntrinsics& camera,
                  std::variant<LandingView, HuntView> view);
  // What was written stays, as after Close; a file without a message is removed.
  ~ObservationFile();
  ObservationFile(const ObservationFile&) = delete;
  ObservationFile& operator=(const ObservationFile&) = delete;

  ObservationWriter& writer() { return writer_; }
  // As those of the writer.
  template <class Seen>
  void Write(const Frame& frame, const Seen& seen, std::optional<Duration> latency = std::nullopt) {
    writer_.Write(frame, seen, latency);
  }

  // Writes what waits for more of its second.
  void Flush() { file_.Flush(); }

  // Nothing is written after it.
  void Close();

 private:
  std::string path_;
  FoxgloveFile file_;
  ObservationWriter writer_;
  bool is_closed_ = false;
};

}  // namespace kestrel
