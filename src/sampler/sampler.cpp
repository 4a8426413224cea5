#include "sampler/sampler.h"

namespace etendue {

const std::vector<Plugin>& sampler_plugins() {
  static const Parameter sample_count{"sampleCount", Parameter::Type::integer, "16", "",
                                      "Samples a pixel, in all"};
  static const std::vector<Plugin> plugins{
      {"sampler", "independent", "Uncorrelated random numbers.", {sample_count}, {}},
      {"sampler", "sobol", "Owen-scrambled Sobol points.", {sample_count}, {}}};
  return plugins;
}

SamplerKind sampler_from_name(std::string_view name) {
  if (name == "independent") return SamplerKind::independent;
  if (name == "sobol") return SamplerKind::sobol;
  throw unknown_plugin("sampler", name, sampler_plugins());
}

std::string_view sampler_name(SamplerKind kind) {
  return kind == SamplerKind::sobol ? "sobol" : "independent";
}

}  // namespace etendue
