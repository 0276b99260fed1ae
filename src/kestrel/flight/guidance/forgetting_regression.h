// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace kestrel {

// Linear least squares over recent measurements: value = row * parameters. The prior is never
// forgotten: a parameter that the data do not determine stays at its mean.
template <int N>
class ForgettingRegression {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  ForgettingRegression() = default;
  // Prior: 'mean' of the parameters with standard deviations 'sigma'. A measurement of weight 1 has
  // the standard deviation 'noise'.
  ForgettingRegression(const Vector& mean, const Vector& sigma, double noise)
      : mean_(mean), prior_(sigma.cwiseAbs2().cwiseInverse()), noise_(noise) {}

  // Multiplies the weight of all previous measurements by 'part' (0 to 1).
  void Forget(double part) {
    information_ *= part;
    weighted_ *= part;
    squares_ *= part;
  }

  // 'weight': the number of independent measurements that this one counts as.
  void Add(const Vector& row, double value, double weight) {
    const double precision = weight / (noise_ * noise_);
    const double rest = value - row.dot(mean_);
    information_ += precision * row * row.transpose();
    weighted_ += precision * rest * row;
    squares_ += precision * rest * rest;
  }

  struct Fit {
    Vector parameters;
    Vector sigma;  // standard deviations
    double chi2;   // chi-squared of the measurements and the prior
  };
  Fit Solve() const {
    Matrix information = information_;
    information.diagonal() += prior_;
    const Eigen::LDLT<Matrix> solver(information);
    const Vector change = solver.solve(weighted_);
    const Matrix covariance = solver.solve(Matrix::Identity());
    return {mean_ + change, covariance.diagonal().cwiseMax(0).cwiseSqrt(),
            squares_ - weighted_.dot(change)};
  }

 private:
  using Matrix = Eigen::Matrix<double, N, N>;

  Vector mean_ = Vector::Zero();
  Vector prior_ = Vector::Ones();  // information of the prior, diagonal
  double noise_ = 1;
  Matrix information_ = Matrix::Zero();
  Vector weighted_ = Vector::Zero();  // weighted differences from the mean
  double squares_ = 0;
};

}  // namespace kestrel
