// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/landing_truth.h"

#include <algorithm>

#include <fmt/format.h>

#include "kestrel/io/recording/tables/csv_columns.h"

namespace kestrel {
namespace {

constexpr Duration kMaxPatternGap = std::chrono::milliseconds(500);

auto FirstNotBefore(const std::vector<TruePattern>& patterns, Time time) {
  return std::lower_bound(patterns.begin(), patterns.end(), time,
                          [](const TruePattern& row, Time t) { return row.time < t; });
}

// Cubic Hermite interpolation; 's' is the fraction (0 to 1) of the time between the rows.
TrueMotion Interpolate(const TruePattern& from, const TruePattern& to, double s) {
  const double span_s = ToSeconds(to.time - from.time);
  const Eigen::Vector3d p0 = from.world_from_pattern.translation;
  const Eigen::Vector3d p1 = to.world_from_pattern.translation;
  const Eigen::Vector3d m0 = span_s * from.velocity_in_world;
  const Eigen::Vector3d m1 = span_s * to.velocity_in_world;
  const Eigen::Vector3d a = 2 * (p0 - p1) + m0 + m1;
  const Eigen::Vector3d b = 3 * (p1 - p0) - 2 * m0 - m1;
  return {((a * s + b) * s + m0) * s + p0, ((3 * a * s + 2 * b) * s + m0) / span_s};
}

}  // namespace

std::vector<TruePattern> ParseTruePatterns(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp [ns]");
  const PoseColumns pose(table, "WP");
  const VectorColumns velocity(table, "v_WP_W_", " [m s^-1]");
  const std::size_t u = table.Column("u [px]");
  const std::size_t v = table.Column("v [px]");
  const std::size_t altitude = table.Column("altitude [m]");
  const std::size_t visible = table.Column("visible_fraction []");
  std::vector<TruePattern> patterns;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    TruePattern pattern{times[row],
                        pose.Parse(row),
                        velocity.Parse(row),
                        {table.Number(row, u), table.Number(row, v)},
                        table.Number(row, altitude),
                        table.Number(row, visible)};
    if (pattern.visible_fraction < 0 || pattern.visible_fraction > 1) {
      table.Fail(row,
                 fmt::format("visible_fraction is {}, expected 0 to 1", pattern.visible_fraction));
    }
    patterns.push_back(pattern);
  }
  return patterns;
}

const TruePattern* FindTruePattern(const std::vector<TruePattern>& patterns, Time time) {
  const auto found = FirstNotBefore(patterns, time);
  return found == patterns.end() || found->time != time ? nullptr : &*found;
}

std::optional<TrueMotion> TrueMotionAt(const std::vector<TruePattern>& patterns, Time time) {
  const auto to = FirstNotBefore(patterns, time);
  if (to == patterns.end()) return std::nullopt;
  if (to->time == time)
    return TrueMotion{to->world_from_pattern.translation, to->velocity_in_world};
  if (to == patterns.begin() || to->time - (to - 1)->time > kMaxPatternGap) return std::nullopt;
  const TruePattern& from = *(to - 1);
  return Interpolate(from, *to, ToSeconds(time - from.time) / ToSeconds(to->time - from.time));
}

}  // namespace kestrel
