#include "render/optimal_weights.h"

#include "render/pilot_squares.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>

namespace etendue {
namespace {

constexpr int replicates = 4, samples_per_replicate = 8;
constexpr double caution = 4;  // Times the noise of a coefficient: within two standard errors of 0 it is 0.
constexpr int pixels_a_square = 2048, most_squares = 2048;

/// A linear regression of one channel on the control variate, within pixels.
class Regression {
 public:
  /// \param x of the replicates of one pixel \param z the same of the control variate, in units of alpha
  void add(std::span<const double, replicates> x, std::span<const double, replicates> z) {
    Pixel sums;
    double x_mean = 0, z_mean = 0;
    for (int r = 0; r < replicates; ++r) x_mean += x[r] / replicates, z_mean += z[r] / replicates;
    for (int r = 0; r < replicates; ++r) {
      sums.xz += (x[r] - x_mean) * (z[r] - z_mean);
      sums.zz += (z[r] - z_mean) * (z[r] - z_mean);
      xx_ += (x[r] - x_mean) * (x[r] - x_mean);
    }
    xz_ += sums.xz;
    zz_ += sums.zz;
    pixels_.push_back(sums);
  }

  /// Its own variance is estimated from how pixels differ.
  double alpha() const {
    if (zz_ == 0) return 0;
    const double alpha = -xz_ / zz_;
    double noise = 0;
    for (const Pixel& pixel : pixels_) {
      const double residual = pixel.xz + alpha * pixel.zz;
      noise += residual * residual;
    }
    noise /= zz_ * zz_;
    return alpha * std::max(0.0, 1 - caution * noise / (alpha * alpha));
  }

  double variance(double alpha) const { return xx_ + alpha * (2 * xz_ + alpha * zz_); }

 private:
  struct Pixel {
    double xz = 0, zz = 0;
  };
  double xx_ = 0, xz_ = 0, zz_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace

bool needs_weight_pilot(const Scene& scene, const RenderSettings& settings) {
  return heuristic_name(settings.integrator) == "optimal" && !scene.medium &&
         double(scene.camera.width_px) * scene.camera.height_px >= fewest_pixels_for_pilots;
}

std::optional<WeightPilot> optimal_alpha_for(const Scene& scene, const RenderSettings& settings,
                                             const StopRequest* stop) {
  const auto start = std::chrono::steady_clock::now();
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  PilotSquares squares(scene, settings, int(std::min(pixels / pixels_a_square, double(most_squares))));
  RenderSettings of_pilot = pilot_settings(settings, 0xa19ba);
  const auto render_with = [&](float alpha) {
    of_pilot.integrator = with_alpha(settings.integrator, {alpha, alpha, alpha});
    return squares.render(of_pilot, replicates, samples_per_replicate, stop);
  };
  const auto plain = render_with(0);
  if (!plain) return std::nullopt;
  double sum = 0;
  for (const Color<double>& mean : *plain) sum += luminance(mean);
  const auto unit = float(sum / double(plain->size()));
  WeightPilot pilot{{0, 0, 0}, 1};
  if (unit > 0) {
    // The same samples again: the two differ by the control variate alone.
    const auto controlled = render_with(unit);
    if (!controlled) return std::nullopt;
    const auto regression_of = [&](const auto& channel) {
      Regression regression;
      std::array<double, replicates> x, z;
      for (std::size_t first = 0; first < plain->size(); first += replicates) {
        for (std::size_t r = 0; r < replicates; ++r) {
          x[r] = channel((*plain)[first + r]);
          z[r] = (channel((*controlled)[first + r]) - x[r]) / double(unit);
        }
        regression.add(x, z);
      }
      return regression;
    };
    const auto alpha_of = [&](double Color<double>::*channel) {
      return float(regression_of([&](const Color<double>& c) { return c.*channel; }).alpha());
    };
    pilot.alpha = {alpha_of(&Color<double>::r), alpha_of(&Color<double>::g), alpha_of(&Color<double>::b)};
    const Regression of_luminance = regression_of([](const Color<double>& c) { return luminance(c); });
    const double without = of_luminance.variance(0);
    if (without > 0) pilot.variance_ratio = of_luminance.variance(double(luminance(pilot.alpha))) / without;
  }
  pilot.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return pilot;
}

}  // namespace etendue
