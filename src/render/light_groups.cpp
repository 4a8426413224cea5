#include "render/light_groups.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace etendue {
namespace {

std::string layer_name(std::string name) {
  constexpr std::size_t longest = 200;  // Of 255 bytes of an EXR channel's name.
  std::replace(name.begin(), name.end(), '.', '_');
  return name.substr(0, longest);
}

}  // namespace

LightGroups light_groups(const Lights& lights, int most) {
  LightGroups groups;
  std::map<std::string, std::int32_t> numbers;
  std::vector<double> powers;
  for (std::int32_t light = 0; light < lights.count(); ++light) {
    const std::string name = layer_name(lights.name(light));
    const auto [place, is_new] = numbers.try_emplace(name, std::int32_t(groups.names.size()));
    if (is_new) {
      groups.names.push_back(name);
      powers.push_back(0);
    }
    groups.of_light.push_back(place->second);
    powers[std::size_t(place->second)] += lights.power(light);
  }
  if (int(groups.names.size()) <= most) return groups;

  std::vector<std::int32_t> kept(powers.size());
  std::iota(kept.begin(), kept.end(), 0);
  std::stable_sort(kept.begin(), kept.end(), [&](std::int32_t a, std::int32_t b) {
    return powers[std::size_t(a)] > powers[std::size_t(b)];
  });
  kept.resize(std::size_t(most - 1));
  std::sort(kept.begin(), kept.end());
  std::vector<std::int32_t> new_numbers(powers.size(), most - 1);
  std::vector<std::string> names;
  for (const std::int32_t group : kept) {
    new_numbers[std::size_t(group)] = std::int32_t(names.size());
    names.push_back(groups.names[std::size_t(group)]);
  }
  groups.others = int(groups.names.size() - kept.size());
  names.emplace_back("others");
  groups.names = names;
  for (std::int32_t& group : groups.of_light) group = new_numbers[std::size_t(group)];
  return groups;
}

}  // namespace etendue
