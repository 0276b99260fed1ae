// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/csv_columns.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace kestrel {
namespace {

// 127 years. Differences and clock offsets then stay within 64 bits.
constexpr std::int64_t kMaxTimestampNs = 4'000'000'000'000'000'000;

Time ParseTime(const CsvTable& table, std::size_t row, std::size_t column) {
  const std::int64_t ns = table.Integer(row, column);
  if (ns < 0 || ns > kMaxTimestampNs) {
    table.Fail(row, fmt::format("timestamp {}, expected 0 to {}", ns, kMaxTimestampNs));
  }
  return TimeFromNanoseconds(ns);
}

}  // namespace

std::vector<Time> ParseTimes(const CsvTable& table, std::string_view name, TimeOrder order) {
  const std::size_t column = table.Column(name);
  std::vector<Time> times;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Time time = ParseTime(table, row, column);
    if (row > 0 &&
        (time < times.back() || (time == times.back() && order == TimeOrder::kIncreasing))) {
      table.Fail(row, fmt::format("timestamp {} out of order, expected {} {}", ToNanoseconds(time),
                                  order == TimeOrder::kIncreasing ? "more than" : "at least",
                                  ToNanoseconds(times.back())));
    }
    times.push_back(time);
  }
  return times;
}

VectorColumns::VectorColumns(const CsvTable& table, const std::string& before,
                             const std::string& after)
    : table_(&table),
      x_(table.Column(before + "x" + after)),
      y_(table.Column(before + "y" + after)),
      z_(table.Column(before + "z" + after)) {}

Eigen::Vector3d VectorColumns::Parse(std::size_t row) const {
  return {table_->Number(row, x_), table_->Number(row, y_), table_->Number(row, z_)};
}

QuaternionColumns::QuaternionColumns(const CsvTable& table, const std::string& name)
    : table_(&table),
      name_(name),
      w_(table.Column(name + "_w []")),
      imaginary_(table, name + "_", " []") {}

Eigen::Quaterniond QuaternionColumns::Parse(std::size_t row) const {
  const Eigen::Vector3d imaginary = imaginary_.Parse(row);
  const Eigen::Quaterniond rotation(table_->Number(row, w_), imaginary.x(), imaginary.y(),
                                    imaginary.z());
  if (!(std::abs(rotation.norm() - 1) < 0.01)) {
    table_->Fail(row, fmt::format("the quaternion {} has the length {:.4g}, expected 1", name_,
                                  rotation.norm()));
  }
  return rotation.normalized();
}

PoseColumns::PoseColumns(const CsvTable& table, const std::string& frames)
    : position_(table, fmt::format("p_{}_{}_", frames, frames.substr(0, 1)), " [m]"),
      rotation_(table, "q_" + frames) {}

RigidTransform PoseColumns::Parse(std::size_t row) const {
  const Eigen::Quaterniond rotation = rotation_.Parse(row);
  return {rotation, position_.Parse(row)};
}

}  // namespace kestrel
