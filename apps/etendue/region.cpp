#include "region.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <string_view>

namespace etendue::app {

namespace {

ImageRegion region_from_text(const std::string& text) {
  const auto fail = [&] {
    throw InputError(
        fmt::format("--region {}: not of the form NAME=X0,Y0,X1,Y1, such as shadow=10,20,30,40 for pixels 10 "
                    "to 29 of rows "
                    "20 to 39",
                    text));
  };
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) fail();
  std::array<int, 4> ends{};
  const char *at = text.data() + equals + 1, *end = text.data() + text.size();
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const auto [after, error] = std::from_chars(at, end, ends[k]);
    if (error != std::errc{} || (k + 1 < ends.size() ? after == end || *after != ',' : after != end)) fail();
    at = after + 1;
  }
  return {text.substr(0, equals), {ends[0], ends[1], ends[2], ends[3]}};
}

}  // namespace

std::vector<ImageRegion> regions_of(const std::vector<std::string>& texts, int width_px, int height_px) {
  std::vector<ImageRegion> regions;
  for (const std::string& text : texts) {
    const ImageRegion region = region_from_text(text);
    const PixelRectangle& pixels = region.pixels;
    if (pixels.x_begin < 0 || pixels.y_begin < 0 || pixels.x_end > width_px || pixels.y_end > height_px)
      throw InputError(fmt::format("--region {}: it reaches out of the image of {} x {} pixels", text,
                                   width_px, height_px));
    // Not their differences, which may be too large.
    if (pixels.x_end <= pixels.x_begin || pixels.y_end <= pixels.y_begin)
      throw InputError(
          fmt::format("--region {}: no pixel is in it; X1 and Y1 are one beyond the last", text));
    const bool is_taken = std::any_of(regions.begin(), regions.end(),
                                      [&](const ImageRegion& other) { return other.name == region.name; });
    if (is_taken || region.name == "image")
      throw InputError(fmt::format("--region {}: '{}' is the name of {}", text, region.name,
                                   is_taken ? "another region" : "the whole image"));
    regions.push_back(region);
  }
  return regions;
}

}  // namespace etendue::app
