// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/evaluate_follow.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "kestrel/app/evaluation/flight_truth.h"
#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/tables/csv_columns.h"
#include "kestrel/io/recording/tables/follow_csv.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// A thing is visible when at least this part of it is, and hidden when less than that.
constexpr double kVisibleShare = 0.5, kHiddenShare = 0.1;

// The truth about a row.
enum class FollowVerdict {
  kNotSeen,    // coasting or lost
  kOn,         // the middle of the box is in the true one, and something of it is visible
  kLookalike,  // it is in that of another thing
  kElsewhere,
  kHidden,  // "seen" in the place of a hidden thing
};

struct ComparedFollow {
  FollowRow row;
  TrueRegion truth;
  FollowVerdict verdict = FollowVerdict::kNotSeen;
  double overlap = 0;                         // intersection of the boxes by their union
  std::optional<double> place_error_m, nees;  // with 2 degrees of freedom
};

bool HasMiddleIn(const cv::Rect2d& box, const cv::Rect2d& truth) {
  return truth.contains({box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1)});
}

const TrueRegion* Find(const std::vector<TrueRegion>& regions, Time time) {
  const auto found = std::lower_bound(regions.begin(), regions.end(), time,
                                      [](const TrueRegion& r, Time t) { return r.time < t; });
  return found == regions.end() || found->time != time ? nullptr : &*found;
}

using Lookalikes = std::vector<std::vector<TrueRegion>>;

FollowVerdict VerdictOf(const FollowRow& row, const TrueRegion& truth,
                        const Lookalikes& lookalikes) {
  if (!row.is_following || !row.box) return FollowVerdict::kNotSeen;
  if (HasMiddleIn(*row.box, truth.box_px)) {
    return truth.visible_fraction < kHiddenShare ? FollowVerdict::kHidden : FollowVerdict::kOn;
  }
  const bool is_other = std::ranges::any_of(lookalikes, [&](const auto& regions) {
    const TrueRegion* other = Find(regions, row.time);
    return other != nullptr && HasMiddleIn(*row.box, other->box_px);
  });
  return is_other ? FollowVerdict::kLookalike : FollowVerdict::kElsewhere;
}

// Compares a place with the truth; 'eye': from where it was seen.
void ComparePlace(const FollowRow::Place& place, const Eigen::Vector2d& eye,
                  ComparedFollow* compared) {
  const Eigen::Vector2d error =
      place.in_world - Eigen::Vector2d(compared->truth.place_in_world.head<2>());
  const Eigen::Vector2d along = (place.in_world - eye).normalized();
  const double across_m = along.x() * error.y() - along.y() * error.x();
  compared->place_error_m = error.norm();
  compared->nees = std::pow(along.dot(error) / place.sigma_along_m, 2) +
                   std::pow(across_m / place.sigma_across_m, 2);
}

std::vector<ComparedFollow> Compare(const FlightTruth& flight, const std::vector<FollowRow>& rows,
                                    const std::vector<TrueRegion>& truths,
                                    const Lookalikes& lookalikes, const std::string& file) {
  std::vector<ComparedFollow> all;
  for (const FollowRow& row : rows) {
    flight.RequireFrame(row.time, file);
    const TrueRegion* truth = Find(truths, row.time);
    if (truth == nullptr) continue;
    ComparedFollow compared{row, *truth, VerdictOf(row, *truth, lookalikes), 0, {}, {}};
    if (compared.verdict == FollowVerdict::kOn) {
      const double both = (*row.box & truth->box_px).area();
      compared.overlap = both / (row.box->area() + truth->box_px.area() - both);
      const auto camera = flight.WorldFromCamera(row.time);
      if (row.place && camera) ComparePlace(*row.place, camera->translation.head<2>(), &compared);
    }
    all.push_back(compared);
  }
  return all;
}

ReportTable ImageTable(const std::vector<ComparedFollow>& all) {
  const auto count = [&](const auto& wanted) {
    return std::to_string(std::ranges::count_if(all, wanted));
  };
  const auto with = [&](FollowVerdict verdict) {
    return count([=](const ComparedFollow& c) { return c.verdict == verdict; });
  };
  std::vector<double> overlaps;
  for (const ComparedFollow& c : all) {
    if (c.verdict == FollowVerdict::kOn) overlaps.push_back(c.overlap);
  }
  const auto is_visible = [](const ComparedFollow& c) {
    return c.truth.visible_fraction >= kVisibleShare;
  };
  return {"follow",
          "On target",
          "",
          {"images", "visible", "of these on target", "on a look-alike", "elsewhere",
           "\"seen\" while hidden", "median overlap of the boxes"},
          {{std::to_string(all.size()), count(is_visible), count([&](const ComparedFollow& c) {
              return is_visible(c) && c.verdict == FollowVerdict::kOn;
            }),
            with(FollowVerdict::kLookalike), with(FollowVerdict::kElsewhere),
            with(FollowVerdict::kHidden), FormatFixed(Median(overlaps), 2)}}};
}

ReportTable PlaceTable(const std::vector<ComparedFollow>& all) {
  std::vector<double> errors, nees;
  for (const ComparedFollow& c : all) {
    if (!c.nees) continue;
    errors.push_back(*c.place_error_m);
    nees.push_back(*c.nees);
  }
  ReportTable table{"place",
                    "Place on the ground",
                    "The mean NEES is 2 when the standard deviations are right.",
                    {"images", "error RMS, m", "95 %, m", "mean NEES"},
                    {}};
  if (errors.empty()) return table;
  table.rows.push_back({std::to_string(errors.size()), FormatFixed(RootMeanSquare(errors), 3),
                        FormatFixed(Quantile(errors, 0.95), 3), FormatFixed(Mean(nees), 2)});
  return table;
}

// Each time that it was hidden, or out of the image: how long, and when it was followed again after
// it was visible again; nothing: never.
ReportTable FoundAgainTable(const std::vector<ComparedFollow>& all) {
  ReportTable table{"found_again", "Found again", "", {"hidden, s", "found again after, s"}, {}};
  std::optional<Time> hidden, visible;
  const auto finish = [&](const std::string& found) {
    if (hidden && visible) {
      table.rows.push_back({FormatFixed(ToSeconds(*visible - *hidden), 2), found});
    }
    hidden.reset();
    visible.reset();
  };
  for (const ComparedFollow& c : all) {
    const Time time = c.row.time;
    if (c.truth.visible_fraction < kHiddenShare) {
      if (visible) finish(kUnknownCell);
      if (!hidden) hidden = time;
    } else if (hidden) {
      if (!visible && c.truth.visible_fraction >= kVisibleShare) visible = time;
      if (c.verdict == FollowVerdict::kOn) {
        if (!visible) visible = time;
        finish(FormatFixed(ToSeconds(time - *visible), 2));
      }
    }
  }
  finish(kUnknownCell);
  return table;
}

Lookalikes ReadLookalikes(const fs::path& root) {
  Lookalikes lookalikes;
  for (std::size_t i = 1;; ++i) {
    const std::string file = (root / RegionTruthFile(i)).string();
    if (!fs::exists(file)) return lookalikes;
    lookalikes.push_back(ParseTrueRegions(ReadFile(file), file));
  }
}

}  // namespace

std::vector<FollowRow> ParseFollowRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp_ns");
  const std::size_t state = table.Column("state"), x = table.Column("x_px");
  const std::size_t y = table.Column("y_px"), width = table.Column("width_px");
  const std::size_t height = table.Column("height_px");
  const std::size_t place_x = table.Column("p_WR_W_x_m"), place_y = table.Column("p_WR_W_y_m");
  const std::size_t along = table.Column("sigma_along_m"), across = table.Column("sigma_across_m");
  std::vector<FollowRow> rows;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    if (table.Text(i, state) == "unreadable") continue;
    FollowRow row{times[i], table.Text(i, state) == "following", {}, {}};
    if (!table.IsEmpty(i, x)) {
      row.box = cv::Rect2d(table.Number(i, x), table.Number(i, y), table.Number(i, width),
                           table.Number(i, height));
    }
    if (!table.IsEmpty(i, place_x)) {
      row.place = FollowRow::Place{{table.Number(i, place_x), table.Number(i, place_y)},
                                   table.Number(i, along),
                                   table.Number(i, across)};
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<TrueRegion> ParseTrueRegions(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp [ns]");
  const std::size_t x = table.Column("x [px]"), y = table.Column("y [px]");
  const std::size_t width = table.Column("width [px]"), height = table.Column("height [px]");
  const VectorColumns place(table, "p_WR_W_", " [m]");
  const VectorColumns velocity(table, "v_WR_W_", " [m s^-1]");
  const std::size_t visible = table.Column("visible_fraction []");
  std::vector<TrueRegion> regions;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    regions.push_back(
        {times[i],
         {table.Number(i, x), table.Number(i, y), table.Number(i, width), table.Number(i, height)},
         place.Parse(i),
         velocity.Parse(i),
         table.Number(i, visible)});
  }
  return regions;
}

Report EvaluateFollow(const std::string& recording, const std::string& output) {
  const FlightTruth flight(recording);
  const std::string truth_file = (fs::path(flight.root()) / RegionTruthFile(0)).string();
  const auto truths = ParseTrueRegions(ReadFile(truth_file), truth_file);
  const std::string file = (fs::path(output) / kFollowTable).string();
  const auto rows = ParseFollowRows(ReadFile(file), file);
  if (rows.empty()) throw InputError(file + ": no rows, expected one for every image");
  const auto all = Compare(flight, rows, truths, ReadLookalikes(flight.root()), file);
  Report report;
  report.title = fmt::format("Follow: {}", fs::path(recording).lexically_normal().string());
  report.tables = {ImageTable(all), PlaceTable(all), FoundAgainTable(all)};
  return report;
}

}  // namespace kestrel
