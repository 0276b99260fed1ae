// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/euroc_recording.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/read_file.h"
#include "kestrel/recording/csv_table.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// 127 years: differences and clock offsets stay within 64 bits.
constexpr std::int64_t kMaxTimestampNs = 4'000'000'000'000'000'000;

Time ParseTime(const CsvTable& table, std::size_t row, std::size_t column) {
  const std::int64_t ns = table.Integer(row, column);
  if (ns < 0 || ns > kMaxTimestampNs) {
    table.Fail(row, fmt::format("timestamp {}, expected 0 to {}", ns, kMaxTimestampNs));
  }
  return TimeFromNanoseconds(ns);
}

// The times of the column 'timestamp [ns]', each later than the one before.
std::vector<Time> ParseTimes(const CsvTable& table) {
  const std::size_t column = table.Column("timestamp [ns]");
  std::vector<Time> times;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Time time = ParseTime(table, row, column);
    if (row > 0 && time <= times.back()) {
      table.Fail(row, fmt::format("timestamp {} out of order, expected more than {}",
                                  ToNanoseconds(time), ToNanoseconds(times.back())));
    }
    times.push_back(time);
  }
  return times;
}

struct PoseColumns {
  explicit PoseColumns(const CsvTable& table)
      : x(table.Column("p_WB_W_x [m]")),
        y(table.Column("p_WB_W_y [m]")),
        z(table.Column("p_WB_W_z [m]")),
        qw(table.Column("q_WB_w []")),
        qx(table.Column("q_WB_x []")),
        qy(table.Column("q_WB_y []")),
        qz(table.Column("q_WB_z []")) {}

  std::size_t x, y, z, qw, qx, qy, qz;
};

RigidTransform ParsePose(const CsvTable& table, const PoseColumns& at, std::size_t row) {
  const Eigen::Quaterniond rotation(table.Number(row, at.qw), table.Number(row, at.qx),
                                    table.Number(row, at.qy), table.Number(row, at.qz));
  if (!(std::abs(rotation.norm() - 1) < 0.01)) {
    table.Fail(
        row, fmt::format("the quaternion q_WB has the length {:.4g}, expected 1", rotation.norm()));
  }
  return {rotation.normalized(),
          {table.Number(row, at.x), table.Number(row, at.y), table.Number(row, at.z)}};
}

}  // namespace

std::vector<ImageRow> ParseImageRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table);
  const std::size_t filename = table.Column("filename");
  std::vector<ImageRow> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    rows.push_back({times[row], std::string(table.Text(row, filename))});
  }
  return rows;
}

std::vector<PoseSample> ParsePoseRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table);
  const PoseColumns columns(table);
  std::vector<PoseSample> samples;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    samples.push_back({times[row], ParsePose(table, columns, row)});
  }
  return samples;
}

std::optional<std::string> FindEurocRoot(const std::string& folder) {
  for (const fs::path& root : {fs::path(folder), fs::path(folder) / "mav0"}) {
    std::error_code ignored;
    if (fs::is_directory(root / "cam0", ignored)) return root.string();
  }
  return std::nullopt;
}

ImageSequence OpenEurocRecording(const std::string& folder) {
  const std::optional<std::string> root = FindEurocRoot(folder);
  if (!root) throw InputError(folder + ": no recording, expected a folder cam0 or mav0/cam0 in it");
  const fs::path camera = fs::path(*root) / "cam0";
  const std::string list = (camera / "data.csv").string();
  std::vector<ImageSequence::Item> items;
  for (const ImageRow& row : ParseImageRows(ReadFile(list), list)) {
    const fs::path path = camera / "data" / row.filename;
    items.push_back({path.lexically_relative(folder).string(), path.string(), row.time});
  }
  if (items.empty()) throw InputError(list + ": no rows, expected one for every image");

  const fs::path calibration = camera / "sensor.yaml";
  const std::string navigation = (fs::path(*root) / "nav0" / "data.csv").string();
  std::vector<PoseSample> poses;
  if (fs::exists(navigation)) poses = ParsePoseRows(ReadFile(navigation), navigation);
  return ImageSequence(std::move(items), fs::exists(calibration) ? calibration.string() : "",
                       std::move(poses));
}

}  // namespace kestrel
