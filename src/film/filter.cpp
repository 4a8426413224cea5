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

double positive(const Parameters& parameters, std::string_view name) {
  const double value = parameters.real(name);
  if (value <= 0)
    throw InputError(parameters.location(name), fmt::format("'{}' is {}; it must be positive", name, value),
                     "give a size in pixels, for example 0.5");
  return value;
}

}  // namespace

const std::vector<Plugin>& filter_plugins() {
  static const std::vector<Plugin> plugins{box_plugin, tent_plugin, gaussian_plugin};
  return plugins;
}

template <class Cumulative>
PixelFilter::PixelFilter(double radius_px, const Cumulative& cumulative) {
  const double total = cumulative(radius_px);
  offset_px_.push_back(float(-radius_px));
  for (int i = 1; i < intervals; ++i) {
    const double t = double(i) / intervals;
    double low = -radius_px, high = 0;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (cumulative(middle) < 0.5 * t * t * total ? low : high) = middle;
    }
    offset_px_.push_back(float(0.5 * (low + high)));
  }
  offset_px_.insert(offset_px_.end(), 2, 0.0f);
}

PixelFilter PixelFilter::box(double radius_px) {
  PixelFilter filter(radius_px, [=](double x) { return x + radius_px; });
  filter.is_box_ = true;
  return filter;
}

PixelFilter PixelFilter::tent(double radius_px) {
  return {radius_px, [=](double x) {
            const double t = 1 - std::abs(x) / radius_px;
            return x < 0 ? 0.5 * t * t : 1 - 0.5 * t * t;
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

PixelFilter make_filter(const Object& description, std::vector<UnreadKey>& unread) {
  if (description.type == "box")
    return PixelFilter::box(positive({description, box_plugin, unread}, "radius"));
  if (description.type == "tent")
    return PixelFilter::tent(positive({description, tent_plugin, unread}, "radius"));
  if (description.type == "gaussian") {
    const Parameters parameters(description, gaussian_plugin, unread);
    return PixelFilter::gaussian(positive(parameters, "radius"), positive(parameters, "stddev"));
  }
  throw unknown_plugin(description, filter_plugins());
}

}  // namespace etendue
