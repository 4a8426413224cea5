#include "render/optimal_weights.h"

#include "base/clock.h"
#include "render/pilot_squares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace etendue {
namespace {

constexpr int replicates = 4, samples_per_replicate = 8;
constexpr double caution = 4;  // Times the noise of a coefficient: within two standard errors of 0 it is 0.
constexpr double time_of_control = 1.04;  // Times that without it.
constexpr int pixels_a_weight_square = 2048, most_weight_squares = 2048;

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

  /// Left with that coefficient.
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
  const Clock::time_point start = Clock::now();
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  PilotSquares squares(scene, settings,
                       int(std::min(pixels / pixels_a_weight_square, double(most_weight_squares))));
  RenderSettings of_pilot = pilot_settings(settings, 0xa19ba);
  const auto render_with = [&](float alpha) {
    of_pilot.integrator = with_alpha(settings.integrator, {alpha, alpha, alpha});
    return squares.render(of_pilot, replicates, samples_per_replicate, stop);
  };
  const auto plain = render_with(0);
  if (!plain) return std::nullopt;
  double sum = 0;
  for (const Color<double>& mean : plain->means) sum += luminance(mean);
  const auto unit = float(sum / double(plain->means.size()));
  WeightPilot pilot{{0, 0, 0}, 1};
  if (unit > 0) {
    // The same samples again: the two differ by the control variate alone.
    const auto controlled = render_with(unit);
    if (!controlled) return std::nullopt;
    const auto regression_of = [&](const auto& channel, auto is_taken) {
      Regression regression;
      std::array<double, replicates> x, z;
      for (std::size_t pixel = 0; pixel * replicates < plain->means.size(); ++pixel) {
        if (!is_taken(pixel)) continue;
        for (std::size_t r = 0; r < replicates; ++r) {
          x[r] = channel(plain->means[pixel * replicates + r]);
          z[r] = (channel(controlled->means[pixel * replicates + r]) - x[r]) / double(unit);
        }
        regression.add(x, z);
      }
      return regression;
    };
    const auto alpha_of = [&](double Color<double>::*channel) {
      return float(
          regression_of([&](const Color<double>& c) { return c.*channel; }, [](std::size_t) { return true; })
              .alpha());
    };
    pilot.alpha = {alpha_of(&Color<double>::r), alpha_of(&Color<double>::g), alpha_of(&Color<double>::b)};
    // What a coefficient leaves is told by pixels that it is not from.
    const auto half = [&](std::size_t which) {
      return regression_of([](const Color<double>& c) { return luminance(c); },
                           [&](std::size_t pixel) { return pixel / PilotSquares::pixels % 2 == which; });
    };
    const Regression halves[]{half(0), half(1)};
    const double without = halves[0].variance(0) + halves[1].variance(0),
                 with = halves[0].variance(halves[1].alpha()) + halves[1].variance(halves[0].alpha());
    pilot.variance_ratio = with / without;
    const bool pays = pilot.variance_ratio * time_of_control < 1;  // Not a number where nothing varies.
    if (!pays || pilot.alpha == Colorf{0, 0, 0}) pilot.alpha = {0, 0, 0}, pilot.variance_ratio = 1;
  }
  pilot.seconds = seconds_since(start);
  return pilot;
}

}  // namespace etendue
