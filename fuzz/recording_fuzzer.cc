// SPDX-License-Identifier: BSD-3-Clause
// For any content of a recording's CSV files, the readers give rows in order of time or refuse
// them.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"

namespace {

template <class Row>
void RequireOrder(const std::vector<Row>& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].time <= rows[i - 1].time) std::abort();
  }
}

void ReadImageRows(std::string_view text) {
  const auto rows = kestrel::ParseImageRows(text, "cam0/data.csv");
  RequireOrder(rows);
  for (const kestrel::ImageRow& row : rows) {
    if (row.filename.empty()) std::abort();
  }
}

void ReadPoseRows(std::string_view text) {
  const auto samples = kestrel::ParsePoseRows(text, "nav0/data.csv");
  RequireOrder(samples);
  for (const kestrel::PoseSample& sample : samples) {
    const kestrel::RigidTransform& pose = sample.world_from_body;
    if (!pose.translation.allFinite() || std::abs(pose.rotation.norm() - 1) > 1e-9) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto read : {ReadImageRows, ReadPoseRows}) {
    try {
      read(text);
    } catch (const kestrel::InputError&) {
    }
  }
  return 0;
}
