#include "film/filter.h"

#include <fmt/format.h>

namespace etendue {

namespace {

using Type = Parameter::Type;

const Plugin box_plugin{"rfilter",
                        "box",
                        "Constant within its radius.",
                        {{"radius", Type::real, "0.5", "px", "Half the width"}},
                        {}};
const Plugin tent_plugin{"rfilter",
                         "tent",
                         "Falls linearly to 0 at its radius.",
                         {{"radius", Type::real, "1", "px", "Half the width"}},
                         {}};
const Plugin gaussian_plugin{"rfilter",
                             "gaussian",
                             "A Gaussian minus its value at the radius.",
                             {{"radius", Type::real, "2", "px", "Half the width"},
                              {"stddev", Type::real, "0.5", "px", "Standard deviation"}},
                             {}};

const Plugin mitchell_plugin{"rfilter",
                             "mitchell",
                             "The cubic of Mitchell and Netravali, with negative lobes where C is above 0.",
                             {{"radius", Type::real, "2", "px", "Half the width"},
                              {"B", Type::real, "0.333333333333333333", "", "Blur, 0 to 1"},
                              {"C", Type::real, "0.333333333333333333", "", "Ringing, 0 to 1"}},
                             {}};

double positive_length(const Parameters& parameters, std::string_view name) {
  const double value = parameters.real(name);
  if (value <= 0)
    throw InputError(parameters.location(name), fmt::format("'{}' is {}; it must be positive", name, value),
                     "give a size in pixels, for example 0.5");
  return value;
}

double unit_interval(const Parameters& parameters, std::string_view name) {
  const double value = parameters.real(name);
  if (!(value >= 0 && value <= 1))
    throw InputError(parameters.location(name),
                     fmt::format("'{}' is {}; it must be from 0 to 1", name, value),
                     "Mitchell and Netravali recommend B = C = 1/3");
  return value;
}

/// The filter over s = 2 |x| / radius in [0, 2], where its integral is 1/2.
struct MitchellCubic {
  double b, c;
  /// Where the sign changes, in [1, 2]; 2 where it does not.
  double root() const { return c > 0 ? (2 * b + 6 * c) / (b + 6 * c) : 2; }
  /// The integral from s to 2.
  double tail(double s) const {
    return s < 1 ? inner(1) - inner(s) + outer(2) - outer(1) : outer(2) - outer(s);
  }

 private:
  double inner(double s) const {
    return ((12 - 9 * b - 6 * c) * s * s * s * s / 4 + (-18 + 12 * b + 6 * c) * s * s * s / 3 +
            (6 - 2 * b) * s) /
           6;
  }
  double outer(double s) const {
    return ((-b - 6 * c) * s * s * s * s / 4 + (6 * b + 30 * c) * s * s * s / 3 +
            (-12 * b - 48 * c) * s * s / 2 + (8 * b + 24 * c) * s) /
           6;
  }
};

}  // namespace

const std::vector<Plugin>& filter_plugins() {
  static const std::vector<Plugin> plugins{box_plugin, tent_plugin, gaussian_plugin, mitchell_plugin};
  return plugins;
}

template <class Cumulative>
PixelFilter::PixelFilter(double radius_px, const Cumulative& cumulative) {
  add_quantiles(-radius_px, 0, cumulative);
}

template <class Cumulative>
void PixelFilter::add_quantiles(double from_px, double to_px, const Cumulative& cumulative) {
  const double below = cumulative(from_px), mass = cumulative(to_px) - below;
  offset_px_.push_back(float(from_px));
  for (int i = 1; i < intervals; ++i) {
    const double t = double(i) / intervals;
    double low = from_px, high = to_px;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (cumulative(middle) - below < t * t * mass ? low : high) = middle;
    }
    offset_px_.push_back(float(0.5 * (low + high)));
  }
  offset_px_.insert(offset_px_.end(), 2, float(to_px));
}

PixelFilter PixelFilter::box(double radius_px) {
  PixelFilter filter(radius_px, [=](double x) { return x + radius_px; });
  filter.is_box_ = true;
  return filter;
}

PixelFilter PixelFilter::tent(double radius_px) {
  return {radius_px, [=](double x) {
            const double t = 1 + x / radius_px;
            return t * t;
          }};
}

PixelFilter PixelFilter::gaussian(double radius_px, double stddev_px) {
  const double edge = std::exp(-0.5 * radius_px * radius_px / (stddev_px * stddev_px));
  const double scale = stddev_px * std::sqrt(std::acos(0.0));  // sigma sqrt(pi / 2)
  const auto integral = [=](double x) {
    return scale * std::erf(x / (stddev_px * std::sqrt(2.0))) - edge * x;
  };
  return {radius_px, [=](double x) { return integral(x) - integral(-radius_px); }};
}

PixelFilter PixelFilter::mitchell(double radius_px, double b, double c) {
  const MitchellCubic cubic{b, c};
  const auto tail = [=](double x) { return cubic.tail(-2 * x / radius_px); };
  const double root = cubic.root(), root_px = -0.5 * root * radius_px;
  const double negative = -cubic.tail(root), positive = cubic.tail(0) + negative;
  if (!(negative > 0)) return {radius_px, tail};
  PixelFilter filter;
  filter.add_quantiles(-radius_px, root_px, [=](double x) { return -tail(x); });
  filter.add_quantiles(root_px, 0, tail);
  filter.negative_tail_ = float(0.5 * negative / (positive + negative));
  const double absolute_over_signed = (positive + negative) / (positive - negative);
  filter.weight_ = float(absolute_over_signed * absolute_over_signed);
  return filter;
}

PixelFilter make_filter(const Object& description, std::vector<UnreadKey>& unread) {
  if (description.type == "box")
    return PixelFilter::box(positive_length({description, box_plugin, unread}, "radius"));
  if (description.type == "tent")
    return PixelFilter::tent(positive_length({description, tent_plugin, unread}, "radius"));
  if (description.type == "gaussian") {
    const Parameters parameters(description, gaussian_plugin, unread);
    return PixelFilter::gaussian(positive_length(parameters, "radius"),
                                 positive_length(parameters, "stddev"));
  }
  if (description.type == "mitchell") {
    const Parameters parameters(description, mitchell_plugin, unread);
    return PixelFilter::mitchell(positive_length(parameters, "radius"), unit_interval(parameters, "B"),
                                 unit_interval(parameters, "C"));
  }
  throw unknown_plugin(description, filter_plugins());
}

}  // namespace etendue
