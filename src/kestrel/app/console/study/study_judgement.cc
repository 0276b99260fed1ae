// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study/study_judgement.h"

#include <algorithm>

#include <fmt/format.h>

namespace kestrel {
namespace {

// _MIN_RECORDINGS and the words of python/kestrel/study, verdict.py and comparison.py.
constexpr std::size_t kLeastRecordings = 8;

std::string Of(std::int64_t count, std::int64_t whole) {
  if (count < whole) return fmt::format("{} of {}", count, whole);
  if (whole == 1) return "the one recording";
  return whole == 2 ? "both" : fmt::format("all {}", whole);
}

std::string Tendency(const std::vector<std::int64_t>& changes) {
  const auto whole = static_cast<std::int64_t>(changes.size());
  const auto worse = std::ranges::count_if(changes, [](auto change) { return change < 0; });
  const auto better = std::ranges::count_if(changes, [](auto change) { return change > 0; });
  if (worse > 0 && better > 0) {
    return fmt::format("Worse in {} and better in {}", Of(worse, whole), Of(better, whole));
  }
  if (worse > 0) return "Worse in " + Of(worse, whole);
  return better > 0 ? "Better in " + Of(better, whole) : "No difference";
}

}  // namespace

std::string StudyJudgement(const std::vector<std::int64_t>& changes) {
  if (changes.empty()) return "";
  const std::size_t count = changes.size();
  if (count >= kLeastRecordings) {
    return Tendency(changes) + "; kestrel study report judges whether that is chance";
  }
  return fmt::format("{}, too few to prove ({} {}, {} are the least)", Tendency(changes), count,
                     count == 1 ? "recording" : "recordings", kLeastRecordings);
}

}  // namespace kestrel
