// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "kestrel/app/foxglove/foxglove_file.h"
#include "kestrel/app/foxglove/observation_writer.h"

namespace kestrel {

// Writes the messages of ObservationWriter into an MCAP file. All functions throw InputError when
// the file cannot be written.
class ObservationFile {
 public:
  // 'view': view of a landing or of a hunt. The file must not exist unless 'replace' is set.
  ObservationFile(const std::string& path, bool replace, const CameraIntrinsics& camera,
                  TaskView view);
  // Finishes the file as Close does, without errors; a file without messages is removed.
  ~ObservationFile();
  ObservationFile(const ObservationFile&) = delete;
  ObservationFile& operator=(const ObservationFile&) = delete;

  ObservationWriter& writer() { return writer_; }
  // The same as in ObservationWriter.
  template <class Seen>
  void Write(const Frame& frame, const Seen& seen, std::optional<Duration> latency = std::nullopt) {
    writer_.Write(frame, seen, latency);
  }

  // Writes the messages that still wait for their second to be complete.
  void Flush() { file_.Flush(); }

  // Finishes the file; nothing can be written after it.
  void Close();

 private:
  std::string path_;
  FoxgloveFile file_;
  ObservationWriter writer_;
  bool is_closed_ = false;
};

}  // namespace kestrel
