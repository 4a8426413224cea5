#include "integrator/integrator.h"

#include <array>
#include <optional>

namespace etendue {

namespace {

struct Entry {
  std::string_view name;
  IntegratorKind kind;
};
constexpr std::array table{
    Entry{"light", IntegratorKind::light},   Entry{"area", IntegratorKind::light},
    Entry{"direct", IntegratorKind::direct}, Entry{"average", IntegratorKind::average},
    Entry{"mis", IntegratorKind::mis},
};

std::optional<IntegratorKind> find(std::string_view name) {
  for (const Entry& entry : table)
    if (entry.name == name) return entry.kind;
  return std::nullopt;
}

const Plugin& plugin_named(std::string_view name) {
  for (const Plugin& plugin : integrator_plugins())
    if (plugin.name == name) return plugin;
  throw unknown_plugin("integrator", name, integrator_plugins());
}

}  // namespace

const std::vector<Plugin>& integrator_plugins() {
  static const std::vector<Plugin> plugins{
      {"integrator", "light", "Area sampling: each sample takes one point on one light.", {}, {}},
      {"integrator", "area", "Another name of light.", {}, {}},
      {"integrator", "direct", "BRDF sampling: each sample takes one direction from the BSDF.", {}, {}},
      {"integrator", "average", "Half of a light sample plus half of a BSDF sample.", {}, {}},
      {"integrator",
       "mis",
       "A light sample and a BSDF sample, combined by multiple importance sampling.",
       {{"heuristic", Parameter::Type::text, "balance", "", "balance or power (exponent 2)"}},
       {}}};
  return plugins;
}

std::string_view integrator_name(IntegratorKind kind) {
  for (const Entry& entry : table)
    if (entry.kind == kind) return entry.name;
  return {};
}

std::string_view heuristic_name(Combination heuristic) {
  return heuristic == Combination::power ? "power" : "balance";
}

IntegratorSettings make_integrator(const Object& description, std::vector<UnreadKey>& unread) {
  const std::optional<IntegratorKind> kind = find(description.type);
  if (!kind) throw unknown_plugin(description, integrator_plugins());
  const Parameters parameters(description, plugin_named(description.type), unread);
  IntegratorSettings settings{*kind, Combination::balance};
  if (*kind == IntegratorKind::mis) {
    const std::string heuristic = parameters.text("heuristic");
    if (heuristic != "balance" && heuristic != "power")
      throw InputError(parameters.location("heuristic"), "unknown heuristic '" + heuristic + "'",
                       known_names(heuristic, {"balance", "power"}));
    settings.heuristic = heuristic == "power" ? Combination::power : Combination::balance;
  }
  return settings;
}

IntegratorSettings integrator_from_name(std::string_view name) {
  const std::optional<IntegratorKind> kind = find(name);
  if (!kind) throw unknown_plugin("integrator", name, integrator_plugins());
  return {*kind, Combination::balance};
}

}  // namespace etendue
