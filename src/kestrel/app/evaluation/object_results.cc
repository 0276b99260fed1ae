// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/object_results.h"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

#include "kestrel/io/recording/tables/csv_columns.h"

namespace kestrel {
namespace {

std::optional<Eigen::Vector3d> ParseIfThere(const VectorColumns& columns, std::size_t row) {
  if (columns.IsEmpty(row)) return std::nullopt;
  return columns.Parse(row);
}

// The columns 'shape', 'digit' and 'digit_probability'.
class ShapeColumns {
 public:
  ShapeColumns(const CsvTable& table, std::span<const char* const> shapes)
      : table_(table),
        shapes_(shapes),
        shape_(table.Column("shape")),
        digit_(table.Column("digit")),
        probability_(table.Column("digit_probability")) {}

  std::string ParseShape(std::size_t row) const {
    std::string shape(table_.Text(row, shape_));
    if (std::ranges::find(shapes_, shape) == shapes_.end()) {
      table_.Fail(row, fmt::format("shape '{}', expected {}", shape, fmt::join(shapes_, ", ")));
    }
    return shape;
  }
  std::optional<ReportedDigit> ParseDigit(std::size_t row) const {
    if (table_.IsEmpty(row, digit_)) return std::nullopt;
    return ReportedDigit{static_cast<int>(table_.Integer(row, digit_)),
                         table_.Number(row, probability_)};
  }

 private:
  const CsvTable& table_;
  std::span<const char* const> shapes_;
  std::size_t shape_;
  std::size_t digit_;
  std::size_t probability_;
};

constexpr std::array kShapes = {"disc", "cuboid", "bar", "merged"};
constexpr std::size_t kMappedShapes = 3;  // merged objects are never in a map

}  // namespace

ObjectRows ParseObjectRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp_ns", TimeOrder::kNotDecreasing);
  const std::size_t u = table.Column("u_px");
  const std::size_t v = table.Column("v_px");
  const std::size_t semi_major = table.Column("semi_major_px");
  const std::size_t class_name = table.Column("class");
  const std::size_t probability = table.Column("class_probability");
  const ShapeColumns shapes(table, kShapes);
  const VectorColumns in_camera(table, "p_CO_C_", "_m");
  const VectorColumns in_world(table, "p_WO_W_", "_m");
  ObjectRows rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (rows.frames.empty() || times[row] > rows.frames.back()) rows.frames.push_back(times[row]);
    if (table.IsEmpty(row, u)) continue;
    const std::string shape = shapes.ParseShape(row);
    if (shape != "merged" && in_camera.IsEmpty(row)) {
      table.Fail(row, fmt::format("a {} without a position", shape));
    }
    rows.objects.push_back({times[row],
                            {table.Number(row, u), table.Number(row, v)},
                            table.Number(row, semi_major),
                            std::string(table.Text(row, class_name)),
                            table.Number(row, probability),
                            shape,
                            shapes.ParseDigit(row),
                            ParseIfThere(in_camera, row),
                            ParseIfThere(in_world, row)});
  }
  return rows;
}

std::vector<MapRow> ParseMapRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::size_t id = table.Column("id");
  const std::size_t class_name = table.Column("class");
  const ShapeColumns shapes(table, std::span(kShapes).first(kMappedShapes));
  const VectorColumns position(table, "p_", "_m");
  const VectorColumns velocity(table, "v_", "_mps");
  const std::size_t last_seen = table.Column("last_seen_ns");
  std::vector<MapRow> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    rows.push_back({static_cast<int>(table.Integer(row, id)),
                    std::string(table.Text(row, class_name)), shapes.ParseShape(row),
                    shapes.ParseDigit(row), position.Parse(row),
                    velocity.IsEmpty(row) ? Eigen::Vector3d::Zero() : velocity.Parse(row),
                    TimeFromNanoseconds(table.Integer(row, last_seen))});
  }
  return rows;
}

}  // namespace kestrel
