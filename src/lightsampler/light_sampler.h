// Which light: chosen for a receiver, by the sampler that a render picks by its name.
//
// To add one: write lightsampler/NAME.h with a class as LightSamplerModel asks for; add it to the variant
// below and a row to the table in light_sampler.cpp. tests/statistical/light_sampler_test.cpp goes through
// that table.
#pragma once

#include "lightsampler/all_lights.h"
#include "lightsampler/light_choice.h"
#include "lightsampler/power_lights.h"
#include "lightsampler/tree_lights.h"
#include "lightsampler/uniform_lights.h"
#include "scenefile/parameters.h"

#include <concepts>
#include <string_view>
#include <variant>
#include <vector>

namespace etendue {

/// Made from the lights of a scene, of which there must be one; it may not outlive them.
///   passes(): how many choices make one light sample; each of them is to be sampled, and they are added up.
///   ranks(): how many there are of LightChoice::rank.
///   choose(receiver, u, pass): a light for the receiver, in pass 0 .. passes() - 1.
///   chooses_facets: whether choices are of facets of lights; else of whole lights.
///   pmf(receiver, light, facet): the probability with which the passes choose this light, or this facet;
///     of a light that is chosen in every case, 1. Lanes that nobody asks for may hold any light that there
///     is.
template <class Sampler>
concept LightSamplerModel = std::constructible_from<Sampler, const Lights&> &&
                            requires(const Sampler& sampler, const Receiver<float>& receiver) {
                              { Sampler::chooses_facets } -> std::convertible_to<bool>;
                              { sampler.passes() } -> std::same_as<std::int32_t>;
                              { sampler.ranks() } -> std::same_as<std::int32_t>;
                              {
                                sampler.template choose<float>(receiver, 0u, 0)
                              } -> std::same_as<LightChoice<float>>;
                              { sampler.template pmf<float>(receiver, 0, 0) } -> std::same_as<float>;
                            };

/// One of the closed set, with the interface of LightSamplerModel.
class LightSampler {
 public:
  template <LightSamplerModel Sampler>
  explicit LightSampler(Sampler sampler) : sampler_(std::move(sampler)) {}

  std::int32_t passes() const {
    return std::visit([](const auto& sampler) { return sampler.passes(); }, sampler_);
  }
  std::int32_t ranks() const {
    return std::visit([](const auto& sampler) { return sampler.ranks(); }, sampler_);
  }
  template <class F>
  LightChoice<F> choose(const Receiver<F>& receiver, const UInt<F>& u, std::int32_t pass) const {
    return std::visit([&](const auto& sampler) { return sampler.template choose<F>(receiver, u, pass); },
                      sampler_);
  }
  template <class F>
  F pmf(const Receiver<F>& receiver, const Int<F>& light, const Int<F>& facet) const {
    return std::visit([&](const auto& sampler) { return sampler.template pmf<F>(receiver, light, facet); },
                      sampler_);
  }

  bool chooses_facets() const {
    return std::visit([](const auto& sampler) { return std::decay_t<decltype(sampler)>::chooses_facets; },
                      sampler_);
  }
  /// Null of the samplers that have none.
  const LightTree* tree() const {
    const auto* by_tree = std::get_if<TreeLights>(&sampler_);
    return by_tree ? &by_tree->tree() : nullptr;
  }

 private:
  std::variant<UniformLights, PowerLights, AllLights, TreeLights> sampler_;
};

const std::vector<Plugin>& light_sampler_plugins();

/// The name as it stands in the table, for as long as the program runs. Throws InputError with the known
/// names.
std::string_view known_light_sampler(std::string_view name);

/// Of all lights: how many there are for `tree` to choose among.
std::int64_t facet_count(const Lights& lights);

/// \param name of the table; `tree` of one facet is made as `uniform` \param lights at least one
LightSampler make_light_sampler(std::string_view name, const Lights& lights);

}  // namespace etendue
