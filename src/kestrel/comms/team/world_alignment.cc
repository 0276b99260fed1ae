// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/world_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

struct Landmark {
  const MappedObject* object;
  std::size_t color;
};
using Landmarks = std::vector<Landmark>;
constexpr std::size_t kMaxObjects = 40;
constexpr std::size_t kMaxMatches = 150;
constexpr double kGate = 16.3;        // squared Mahalanobis distance, 3 degrees of freedom
constexpr double kSlack_m = 0.1;      // allowed beside the covariance of a position: bias of a pass
constexpr double kMaxShift_m = 0.3;   // by an error of the yaw
constexpr double kMinBaseline_m = 3;  // between two objects that determine the yaw

// A possible match: one object in both worlds.
struct Match {
  const MappedObject* object;
  const MappedObject* reference;
};

// Returns the best known of the standing objects.
Landmarks FindLandmarks(const std::vector<MappedObject>& objects) {
  std::vector<std::pair<double, const MappedObject*>> standing;
  for (const MappedObject& object : objects) {
    if (!object.may_move) standing.emplace_back(object.sigma_m(), &object);
  }
  std::stable_sort(standing.begin(), standing.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  standing.resize(std::min(standing.size(), kMaxObjects));
  Landmarks landmarks;
  for (const auto& [sigma_m, object] : standing) {
    landmarks.push_back({object, object->color_index()});
  }
  return landmarks;
}

WorldAlignment UnknownAlignmentOf(const Landmarks& landmarks, const Eigen::Matrix4d& covariance) {
  WorldAlignment unknown;
  for (const Landmark& landmark : landmarks) unknown.pivot += landmark.object->position();
  if (!landmarks.empty()) unknown.pivot /= static_cast<double>(landmarks.size());
  unknown.covariance = covariance;
  return unknown;
}

Eigen::Matrix3d Turn(double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// Returns the derivative of a moved point of the first world by translation and yaw.
Eigen::Matrix<double, 3, 4> JacobianAt(const WorldAlignment& alignment,
                                       const Eigen::Vector3d& point) {
  const Eigen::Vector3d lever = Turn(alignment.yaw) * (point - alignment.pivot);
  Eigen::Matrix<double, 3, 4> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ().cross(lever);
  return jacobian;
}

Eigen::Matrix4d PriorCovariance(const WorldPrior& prior) {
  Eigen::Vector4d variances;
  variances << Eigen::Vector3d::Constant(std::pow(prior.translation_sigma_m, 2)),
      std::pow(prior.yaw_sigma, 2);
  return variances.asDiagonal();
}

// Returns the covariance of the difference of a match's two positions.
Eigen::Matrix3d Noise(const Match& match) {
  Eigen::Matrix3d noise = match.object->covariance.topLeftCorner<3, 3>() +
                          match.reference->covariance.topLeftCorner<3, 3>();
  noise.diagonal().array() += kSlack_m * kSlack_m;
  return noise;
}

// Returns the squared Mahalanobis distance, if it is within the gate.
std::optional<double> GatedDistance(const Eigen::Vector3d& residual, const Eigen::Matrix3d& noise) {
  // No variance along any direction is above the trace: most cases need no solver.
  if (residual.squaredNorm() > kGate * noise.trace()) return std::nullopt;
  const double distance = residual.dot(noise.llt().solve(residual));
  return distance <= kGate ? std::optional(distance) : std::nullopt;
}

Eigen::Vector3d Residual(const WorldAlignment& alignment, const Match& match) {
  return match.reference->position() - alignment * match.object->position();
}

// Returns the pairs that may match by the prior, the nearest first.
std::vector<Match> PossibleMatches(const Landmarks& objects, const Landmarks& reference,
                                   const WorldAlignment& unknown) {
  std::vector<std::pair<double, Match>> found;
  for (const auto& [a, color] : objects) {
    const auto jacobian = JacobianAt(unknown, a->position());
    const Eigen::Matrix3d shift = jacobian * unknown.covariance * jacobian.transpose();
    for (const auto& [b, other_color] : reference) {
      if (color != other_color || a->shape != b->shape) continue;
      const Match match{a, b};
      const auto distance = GatedDistance(Residual(unknown, match), shift + Noise(match));
      if (distance) found.emplace_back(*distance, match);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  found.resize(std::min(found.size(), kMaxMatches));
  std::vector<Match> matches;
  for (const auto& [distance, match] : found) matches.push_back(match);
  return matches;
}

// Returns the alignment that maps one pair of objects onto another, if their distances agree.
std::optional<WorldAlignment> AlignmentOf(const Match& a, const Match& b,
                                          const WorldAlignment& unknown) {
  if (a.object == b.object || a.reference == b.reference) return std::nullopt;
  const Eigen::Vector3d from = b.object->position() - a.object->position();
  const Eigen::Vector3d to = b.reference->position() - a.reference->position();
  const double length = from.head<2>().norm();
  if (length < kMinBaseline_m) return std::nullopt;
  const double sigma = std::sqrt((Noise(a).trace() + Noise(b).trace()) / 3);
  if ((std::abs(length - to.head<2>().norm())) > 3 * sigma) return std::nullopt;
  WorldAlignment alignment = unknown;
  alignment.yaw =
      std::remainder(std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x()), 2 * kPi);
  if (std::abs(alignment.yaw) > 3 * std::sqrt(unknown.covariance(3, 3)) + sigma / length) {
    return std::nullopt;
  }
  alignment.translation = (Residual(alignment, a) + Residual(alignment, b)) / 2;
  const Eigen::Vector2d variances(std::pow(sigma, 2) / 2, std::pow(sigma / length, 2));
  alignment.covariance.setZero();
  alignment.covariance.diagonal() << variances[0], variances[0], variances[0], variances[1];
  return alignment;
}

// Returns the matches that agree with the alignment, each object in only one of them.
std::vector<Match> Agreeing(const std::vector<Match>& matches, const WorldAlignment& alignment) {
  std::vector<std::pair<double, Match>> near;
  for (const Match& match : matches) {
    const Eigen::Vector3d residual = Residual(alignment, match);
    // The yaw from two near objects is uncertain far away; a match that is only loosely near does
    // not count.
    const double lever = (match.object->position() - alignment.pivot).head<2>().norm();
    const double shift_m = std::min(std::sqrt(alignment.covariance(3, 3)) * lever, kMaxShift_m);
    Eigen::Matrix3d noise = Noise(match) + alignment.covariance.topLeftCorner<3, 3>();
    noise.topLeftCorner<2, 2>().diagonal().array() += shift_m * shift_m;
    if (const auto distance = GatedDistance(residual, noise)) near.emplace_back(*distance, match);
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Match> agreeing;
  for (const auto& candidate : near) {
    const Match& match = candidate.second;
    const bool is_taken = std::any_of(agreeing.begin(), agreeing.end(), [&](const Match& other) {
      return other.object == match.object || other.reference == match.reference;
    });
    if (!is_taken) agreeing.push_back(match);
  }
  return agreeing;
}

// Returns the least squares solution over the matches, from 'alignment' on, with the prior as a
// measurement.
WorldAlignment Refined(const std::vector<Match>& matches, const WorldPrior& prior,
                       WorldAlignment alignment) {
  const Eigen::Matrix4d prior_information = PriorCovariance(prior).inverse();
  for (int i = 0; i < 3; ++i) {
    Eigen::Matrix4d information = prior_information;
    Eigen::Vector4d state;
    state << alignment.translation, alignment.yaw;
    Eigen::Vector4d gradient = -prior_information * state;
    for (const Match& match : matches) {
      const auto jacobian = JacobianAt(alignment, match.object->position());
      const Eigen::Matrix3d weight = Noise(match).inverse();
      information += jacobian.transpose() * weight * jacobian;
      gradient += jacobian.transpose() * weight * Residual(alignment, match);
    }
    alignment.covariance = information.inverse();
    const Eigen::Vector4d step = alignment.covariance * gradient;
    alignment.translation += step.head<3>();
    alignment.yaw += step[3];
  }
  return alignment;
}

bool Contains(const std::vector<Match>& matches, const Match& match) {
  return std::any_of(matches.begin(), matches.end(), [&](const Match& other) {
    return other.object == match.object && other.reference == match.reference;
  });
}

// An alignment and the matches that agree with it.
struct Consensus {
  WorldAlignment alignment;
  std::vector<Match> matches;
};

// Iterates from a pair's alignment to the least squares over all that agree, whose number may grow.
Consensus Grow(const std::vector<Match>& matches, const WorldPrior& prior, Consensus from) {
  constexpr int kMaxRounds = 4;
  for (int i = 0; i < kMaxRounds; ++i) {
    const std::size_t before = from.matches.size();
    from.alignment = Refined(from.matches, prior, from.alignment);
    from.matches = Agreeing(matches, from.alignment);
    if (from.matches.size() <= before) break;
  }
  from.alignment = Refined(from.matches, prior, from.alignment);
  return from;
}

// True when one alignment stands out: 'best' matches agree on it, 'rival' of the other matches
// agree on another one, and the difference is more than equal patterns and chance explain.
bool StandsOut(std::size_t best, std::size_t rival) {
  return 2 * best >= 3 * rival && 2 * (best - rival) * (best - rival) >= 3 * rival;
}

// Returns the alignment on which most matches agree; nothing where it does not stand out from
// others, which pair the objects differently.
std::optional<Consensus> FindConsensus(const std::vector<Match>& matches,
                                       const WorldAlignment& unknown, const WorldPrior& prior) {
  Consensus best;
  std::vector<char> is_in_best(matches.size());
  std::vector<std::vector<Match>> votes;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    for (std::size_t k = i + 1; k < matches.size(); ++k) {
      // A pair from the best consensus would give the same alignment.
      if (is_in_best[i] && is_in_best[k]) continue;
      const auto alignment = AlignmentOf(matches[i], matches[k], unknown);
      if (!alignment) continue;
      votes.push_back(Agreeing(matches, *alignment));
      if (votes.back().size() <= best.matches.size()) continue;
      Consensus grown = Grow(matches, prior, {*alignment, votes.back()});
      if (grown.matches.size() <= best.matches.size()) continue;
      best = std::move(grown);
      for (std::size_t m = 0; m < matches.size(); ++m) {
        is_in_best[m] = Contains(best.matches, matches[m]);
      }
      // All the other matches together are too few for a rival.
      if (StandsOut(best.matches.size(), matches.size() - best.matches.size())) return best;
    }
  }
  for (const std::vector<Match>& vote : votes) {
    const auto others = std::count_if(vote.begin(), vote.end(), [&](const Match& match) {
      return !Contains(best.matches, match);
    });
    if (!StandsOut(best.matches.size(), static_cast<std::size_t>(others))) return std::nullopt;
  }
  return best;
}

bool IsSure(const WorldAlignment& alignment) {
  constexpr double kSigma_m = 0.3;
  return alignment.covariance.diagonal().head<3>().maxCoeff() < kSigma_m * kSigma_m &&
         alignment.covariance(3, 3) < std::pow(Radians(1), 2);
}

}  // namespace

Eigen::Vector3d WorldAlignment::operator*(const Eigen::Vector3d& point) const {
  return pivot + translation + Turn(yaw) * (point - pivot);
}

WorldAlignment WorldAlignment::Inverse() const {
  return {pivot + translation, -translation, -yaw, covariance};
}

WorldAlignment WorldAlignment::operator*(const WorldAlignment& first) const {
  const Eigen::Vector3d on_the_way = first * first.pivot;
  WorldAlignment both;
  both.pivot = first.pivot;
  both.translation = *this * on_the_way - first.pivot;
  both.yaw = yaw + first.yaw;
  Eigen::Matrix4d by_own = Eigen::Matrix4d::Identity();
  by_own.topRows<3>() = JacobianAt(*this, on_the_way);
  Eigen::Matrix4d by_first = Eigen::Matrix4d::Identity();
  by_first.topLeftCorner<3, 3>() = Turn(yaw);
  both.covariance =
      by_own * covariance * by_own.transpose() + by_first * first.covariance * by_first.transpose();
  return both;
}

bool WorldAlignment::operator==(const WorldAlignment& other) const {
  return pivot == other.pivot && translation == other.translation && yaw == other.yaw &&
         covariance == other.covariance;
}

void MoveToWorld(const WorldAlignment& alignment, MappedObject* object) {
  const auto jacobian = JacobianAt(alignment, object->position());
  const Eigen::Matrix3d turn = Turn(alignment.yaw);
  const Eigen::Vector3d position = alignment * Eigen::Vector3d(object->position());
  const int size = object->may_move ? MappedObject::kStateSize : 3;  // the rest is zero
  for (int i = 0; i < size; i += 3) {
    object->state.segment<3>(i) = (turn * object->state.segment<3>(i)).eval();
    for (int k = 0; k < size; k += 3) {
      auto block = object->covariance.block<3, 3>(i, k);
      block = (turn * block * turn.transpose()).eval();
    }
  }
  object->state.head<3>() = position;
  object->covariance.topLeftCorner<3, 3>() +=
      jacobian * alignment.covariance * jacobian.transpose();
}

WorldAlignment UnknownAlignment(const std::vector<MappedObject>& objects, const WorldPrior& prior) {
  return UnknownAlignmentOf(FindLandmarks(objects), PriorCovariance(prior));
}

std::optional<FoundAlignment> EstimateAlignment(const std::vector<MappedObject>& objects,
                                                const std::vector<MappedObject>& reference,
                                                const WorldPrior& prior) {
  const Landmarks landmarks = FindLandmarks(objects);
  const WorldAlignment unknown = UnknownAlignmentOf(landmarks, PriorCovariance(prior));
  const auto consensus =
      FindConsensus(PossibleMatches(landmarks, FindLandmarks(reference), unknown), unknown, prior);
  constexpr std::size_t kMinMatches = 3;
  if (!consensus || consensus->matches.size() < kMinMatches || !IsSure(consensus->alignment)) {
    return std::nullopt;
  }
  return FoundAlignment{consensus->alignment, consensus->matches.size()};
}

}  // namespace kestrel
