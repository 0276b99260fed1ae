// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {

// Required order of a table's times: one row per time, or several.
enum class TimeOrder { kIncreasing, kNotDecreasing };

// Returns the times (ns, 0 to 127 years) in the column 'name'. Throws InputError with the line of
// the first that is out of range or not in order.
std::vector<Time> ParseTimes(const CsvTable& table, std::string_view name,
                             TimeOrder order = TimeOrder::kIncreasing);

// Three neighbouring columns whose names differ in x, y, z only: 'before' + "x" + 'after', ... The
// table must outlive it.
class VectorColumns {
 public:
  VectorColumns(const CsvTable& table, const std::string& before, const std::string& after);
  Eigen::Vector3d Parse(std::size_t row) const;  // throws InputError unless all are finite
  bool IsEmpty(std::size_t row) const { return table_->IsEmpty(row, x_); }

 private:
  const CsvTable* table_;
  std::size_t x_, y_, z_;
};

// A rotation in four columns: 'name' + "_w []", ... The table must outlive it.
class QuaternionColumns {
 public:
  QuaternionColumns(const CsvTable& table, const std::string& name);
  // Throws InputError unless all numbers are finite and the length is 1 (to 1 %).
  Eigen::Quaterniond Parse(std::size_t row) const;

 private:
  const CsvTable* table_;
  std::string name_;
  std::size_t w_;
  VectorColumns imaginary_;
};

// The pose of frame B in A in EuRoC's columns, for 'frames' "AB": p_AB_A_x [m], ..., q_AB_w [], ...
// The table must outlive it.
class PoseColumns {
 public:
  PoseColumns(const CsvTable& table, const std::string& frames);
  // Throws InputError unless all numbers are finite and the quaternion has unit length (to 1 %).
  RigidTransform Parse(std::size_t row) const;

 private:
  VectorColumns position_;
  QuaternionColumns rotation_;
};

}  // namespace kestrel
