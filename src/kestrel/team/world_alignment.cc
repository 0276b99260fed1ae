// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/team/world_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/geometry/angles.h"

namespace kestrel {
namespace {

using Objects = std::vector<const MappedObject*>;
constexpr std::size_t kMaxObjects = 40;
constexpr std::size_t kMaxMatches = 150;
constexpr double kGate = 16.3;        // squared Mahalanobis distance, 3 degrees of freedom
constexpr double kSlack_m = 0.1;      // of a position beside its covariance: bias of a pass
constexpr double kMaxShift_m = 0.3;   // by an error of the yaw
constexpr double kMinBaseline_m = 3;  // between two objects that tell the yaw

// One object in both worlds, perhaps.
struct Match {
  const MappedObject* object;
  const MappedObject* reference;
};

// The best known of those that stand.
Objects Landmarks(const std::vector<MappedObject>& objects) {
  Objects landmarks;
  for (const MappedObject& object : objects) {
    if (!object.may_move) landmarks.push_back(&object);
  }
  std::stable_sort(landmarks.begin(), landmarks.end(),
                   [](auto* a, auto* b) { return a->sigma_m() < b->sigma_m(); });
  landmarks.resize(std::min(landmarks.size(), kMaxObjects));
  return landmarks;
}

template <class Range>
Eigen::Vector3d Middle(const Range& objects) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const MappedObject* object : objects) sum += object->position();
  return objects.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(objects.size()));
}

Eigen::Matrix3d Turn(double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// How a point of the first world moves with translation and yaw.
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

// Covariance of the difference of a match's two positions.
Eigen::Matrix3d Noise(const Match& match) {
  Eigen::Matrix3d noise = match.object->covariance.topLeftCorner<3, 3>() +
                          match.reference->covariance.topLeftCorner<3, 3>();
  noise.diagonal().array() += kSlack_m * kSlack_m;
  return noise;
}

Eigen::Vector3d Residual(const WorldAlignment& alignment, const Match& match) {
  return match.reference->position() - alignment * match.object->position();
}

// Those that may be the same by the prior, the nearest first.
std::vector<Match> PossibleMatches(const Objects& objects, const Objects& reference,
                                   const WorldAlignment& unknown) {
  std::vector<std::pair<double, Match>> found;
  for (const MappedObject* a : objects) {
    const auto jacobian = JacobianAt(unknown, a->position());
    const Eigen::Matrix3d shift = jacobian * unknown.covariance * jacobian.transpose();
    for (const MappedObject* b : reference) {
      if (a->shape != b->shape || a->color_index() != b->color_index()) continue;
      const Match match{a, b};
      const Eigen::Vector3d residual = Residual(unknown, match);
      const double distance = residual.dot((shift + Noise(match)).llt().solve(residual));
      if (distance <= kGate) found.emplace_back(distance, match);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  found.resize(std::min(found.size(), kMaxMatches));
  std::vector<Match> matches;
  for (const auto& [distance, match] : found) matches.push_back(match);
  return matches;
}

// The alignment that lays one pair of objects onto another, if their distances agree.
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

// The matches that agree with the alignment, each object in one of them only.
std::vector<Match> Agreeing(const std::vector<Match>& matches, const WorldAlignment& alignment) {
  std::vector<std::pair<double, Match>> near;
  for (const Match& match : matches) {
    const Eigen::Vector3d residual = Residual(alignment, match);
    // The yaw of two near objects says little far away; what is only loosely near does not count.
    const double lever = (match.object->position() - alignment.pivot).head<2>().norm();
    const double shift_m = std::min(std::sqrt(alignment.covariance(3, 3)) * lever, kMaxShift_m);
    Eigen::Matrix3d noise = Noise(match) + alignment.covariance.topLeftCorner<3, 3>();
    noise.topLeftCorner<2, 2>().diagonal().array() += shift_m * shift_m;
    const double distance = residual.dot(noise.llt().solve(residual));
    if (distance <= kGate) near.emplace_back(distance, match);
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

// Least squares over the matches, from the alignment on, with the prior as a measurement.
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

// How many of the matches pair objects otherwise than the others do.
std::size_t CountOther(const std::vector<Match>& matches, const std::vector<Match>& others) {
  return static_cast<std::size_t>(
      std::count_if(matches.begin(), matches.end(), [&](const Match& match) {
        return std::none_of(others.begin(), others.end(), [&](const Match& other) {
          return other.object == match.object && other.reference == match.reference;
        });
      }));
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

void MoveToWorld(const WorldAlignment& alignment, MappedObject* object) {
  const auto jacobian = JacobianAt(alignment, object->position());
  const Eigen::Matrix3d turn = Turn(alignment.yaw);
  const Eigen::Vector3d position = alignment * Eigen::Vector3d(object->position());
  Eigen::Matrix<double, 9, 9> turns = Eigen::Matrix<double, 9, 9>::Zero();
  for (int i = 0; i < 9; i += 3) turns.block<3, 3>(i, i) = turn;
  object->state = (turns * object->state).eval();
  object->state.head<3>() = position;
  object->covariance = (turns * object->covariance * turns.transpose()).eval();
  object->covariance.topLeftCorner<3, 3>() +=
      jacobian * alignment.covariance * jacobian.transpose();
}

WorldAlignment UnknownAlignment(const std::vector<MappedObject>& objects, const WorldPrior& prior) {
  WorldAlignment unknown;
  unknown.pivot = Middle(Landmarks(objects));
  unknown.covariance = PriorCovariance(prior);
  return unknown;
}

std::optional<WorldAlignment> EstimateAlignment(const std::vector<MappedObject>& objects,
                                                const std::vector<MappedObject>& reference,
                                                const WorldPrior& prior) {
  const WorldAlignment unknown = UnknownAlignment(objects, prior);
  const std::vector<Match> matches =
      PossibleMatches(Landmarks(objects), Landmarks(reference), unknown);
  struct Vote {
    std::vector<Match> matches;
    WorldAlignment alignment;
  };
  std::vector<Vote> votes;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    for (std::size_t k = i + 1; k < matches.size(); ++k) {
      const auto alignment = AlignmentOf(matches[i], matches[k], unknown);
      if (alignment) votes.push_back({Agreeing(matches, *alignment), *alignment});
    }
  }
  if (votes.empty()) return std::nullopt;
  const auto best = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
    return a.matches.size() < b.matches.size();
  });
  WorldAlignment alignment = Refined(best->matches, prior, best->alignment);
  const std::vector<Match> agreeing = Agreeing(matches, alignment);
  alignment = Refined(agreeing, prior, alignment);
  std::size_t rival = 0;
  for (const Vote& vote : votes) rival = std::max(rival, CountOther(vote.matches, agreeing));
  constexpr std::size_t kMinMatches = 3;
  const bool is_unrivalled = 2 * agreeing.size() >= 3 * rival;
  if (agreeing.size() < kMinMatches || !is_unrivalled || !IsSure(alignment)) return std::nullopt;
  return alignment;
}

}  // namespace kestrel
