#include "course/lab_page.h"

#include "course/course_files.h"
#include "course/html_text.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using nlohmann::json;

/// Three digits: no more are known.
json rounded(const LabNoise& noise) {
  json plates = json::array();
  for (const std::vector<double>& lights : noise.relative) {
    json row = json::array();
    for (const double one : lights) {
      const double unit = one > 0 ? std::pow(10.0, std::floor(std::log10(one)) - 2) : 1;
      row.push_back(std::isfinite(one) ? json(std::round(one / unit) * unit) : json());
    }
    plates.push_back(row);
  }
  return plates;
}

}  // namespace

std::string lab_page(const LabGrid& grid, const Lab& lab) {
  json data{{"exponents", grid.exponent_factors},
            {"sizes", grid.size_factors},
            {"samples", grid.samples},
            {"methods", lab_methods},
            {"width", grid.width},
            {"height", grid.height}};
  for (const Image& picture : lab.pictures) data["pictures"].push_back(png_data_uri(grey_png(picture)));
  for (const LabNoise& noise : lab.noise) data["noise"].push_back(rounded(noise));

  std::ifstream file(lab_page_file());
  std::string page{std::istreambuf_iterator<char>(file), {}};
  constexpr std::string_view place = "@DATA@";
  page.replace(page.find(place), place.size(), data.dump());
  return page;
}

}  // namespace etendue
