#include <keeler/light/wake_model.hpp>

#include <keeler/core/linear_algebra.hpp>
#include <keeler/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace keeler::light {
namespace {

// The fitted numbers: ln H/W, ln S/W, τ_gap, φ_w. The first two stay positive by their logarithms.
using Numbers = Eigen::Vector4d;

constexpr double max_log = 7.0; // of H/W and S/W, either way
constexpr int max_steps = 300;

WakeModel model_of(const Numbers& numbers, BarSection section) {
  return {section, std::exp(numbers[0]), std::exp(numbers[1]), numbers[2], numbers[3]};
}

void keep_in_range(Numbers& numbers) {
  numbers[0] = std::clamp(numbers[0], -max_log, max_log);
  numbers[1] = std::clamp(numbers[1], -max_log, max_log);
  numbers[2] = std::max(0.0, numbers[2]);
}

class Fit {
public:
  Fit(std::span<const StarTransmission> data, BarSection section) : data_(data), section_(section) {}

  // Levenberg and Marquardt's descent from a start, each step a least-squares problem (Moré 1978); returns χ².
  double descend(Numbers& numbers) const {
    double damping = 1e-3, chi_square = residuals(numbers).squaredNorm();
    for (int step = 0; step < max_steps && damping < 1e10; ++step) {
      Numbers next = numbers - damped_step(slopes_at(numbers), residuals(numbers), damping);
      keep_in_range(next);
      const double there = residuals(next).squaredNorm();
      if (there < chi_square) {
        const bool converged = chi_square - there < 1e-12 * chi_square;
        numbers = next, chi_square = there, damping *= 0.3;
        if (converged)
          break;
      } else {
        damping *= 4.0;
      }
    }
    return chi_square;
  }

  Eigen::MatrixXd slopes_at(const Numbers& numbers) const {
    constexpr double h = 1e-5;
    Eigen::MatrixXd slopes(static_cast<Eigen::Index>(data_.size()), 4);
    for (Eigen::Index k = 0; k < 4; ++k) {
      Numbers more = numbers, less = numbers;
      more[k] += h, less[k] -= h;
      slopes.col(k) = (residuals(more) - residuals(less)) / (2.0 * h);
    }
    return slopes;
  }

private:
  // Minimises |slopes x − misses|² + Σ damping s_k² x_k², with s_k the length of the k-th column of the slopes.
  static Numbers damped_step(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& misses, double damping) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(slopes.rows() + 4, 4);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(slopes.rows() + 4);
    matrix.topRows(slopes.rows()) = slopes;
    right.head(misses.size()) = misses;
    for (Eigen::Index k = 0; k < 4; ++k)
      matrix(slopes.rows() + k, k) = std::sqrt(damping * (slopes.col(k).squaredNorm() + 1e-12));
    return least_squares(matrix, right).solution;
  }

  Eigen::VectorXd residuals(const Numbers& numbers) const {
    const WakeModel model = model_of(numbers, section_);
    Eigen::VectorXd all(static_cast<Eigen::Index>(data_.size()));
    for (std::size_t k = 0; k < data_.size(); ++k)
      all[static_cast<Eigen::Index>(k)] = (model.transmission(data_[k].star) - data_[k].transmission) / data_[k].error;
    return all;
  }

  std::span<const StarTransmission> data_;
  BarSection section_;
};

bool leave_model_open(std::span<const StarTransmission> data) {
  std::set<long> azimuths, elevations; // in units in which close ones are equal
  for (const StarTransmission& one : data) {
    azimuths.insert(std::lround(std::fmod(one.star.azimuth + 10.0 * pi, pi) * 1e4));
    elevations.insert(std::lround(std::fabs(one.star.elevation) * 1e4));
  }
  return data.size() < 5 || azimuths.size() < 2 || elevations.size() < 2;
}

} // namespace

double WakeModel::transmission(const Bearing& star) const {
  const double sine = std::fabs(std::sin(star.elevation)), cotangent = std::fabs(std::cos(star.elevation)) / sine;
  const double risen = height * std::fabs(std::sin(star.azimuth - azimuth)) * cotangent;
  const double open = section == BarSection::rectangle ? gap - risen : gap + 1.0 - std::hypot(1.0, risen);
  return std::max(0.0, open) / (gap + 1.0) * std::exp(-gap_depth / sine);
}

std::optional<FittedWakes> fit_wakes(std::span<const StarTransmission> transmissions, BarSection section) {
  if (leave_model_open(transmissions))
    return std::nullopt;
  const Fit fit(transmissions, section);
  FittedWakes best;
  best.chi_square = std::numeric_limits<double>::infinity();
  Numbers of_best = Numbers::Zero();
  for (const double height : {0.1, 0.4, 1.0})
    for (const double gap : {0.3, 1.0, 3.0})
      for (int k = 0; k < 6; ++k) {
        Numbers numbers(std::log(height), std::log(gap), 0.1, pi * k / 6.0);
        const double chi_square = fit.descend(numbers);
        if (chi_square < best.chi_square)
          best.chi_square = chi_square, of_best = numbers;
      }
  best.model = model_of(of_best, section);
  best.model.azimuth = std::fmod(best.model.azimuth, pi);
  if (best.model.azimuth < 0.0)
    best.model.azimuth += pi;
  const auto count = static_cast<Eigen::Index>(transmissions.size());
  const Eigen::MatrixXd inverse =
      least_squares(fit.slopes_at(of_best), Eigen::MatrixXd::Identity(count, count)).solution;
  best.freedom = transmissions.size() - 4;
  const double misfit = std::sqrt(std::max(1.0, best.chi_square / static_cast<double>(best.freedom)));
  const Numbers errors = misfit * inverse.rowwise().norm();
  best.errors = {section, errors[0] * best.model.height, errors[1] * best.model.gap, errors[2], errors[3]};
  return best;
}

} // namespace keeler::light
