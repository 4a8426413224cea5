// Small scenes on which a check looks at single samples of a light integrator.
#pragma once

#include "base/color.h"
#include "base/vec.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

struct LoadedScene;

/// What a probe is about.
enum class ProbeOf { unshadowed, back_faces, horizon, shadows, emission };

struct ProbeRay {
  Vec3f origin, direction;  ///< World; unit. Nothing but what it is meant to meet lies on its way.
};

struct Probe {
  std::string name;  ///< "several_lights", of its files too.
  std::string what;  ///< What is in it, for the reader of a report.
  ProbeOf of;
  bool has_blockers;                                       ///< Something lies between lights and receivers.
  std::string scene_xml;                                   ///< All of the scene file.
  std::vector<std::pair<std::string, std::string>> files;  ///< Beside it: name and text.
  std::vector<ProbeRay> rays;
};

/// Other geometry, powers and places for each seed; the same kinds of scenes.
std::vector<Probe> make_probes(std::uint64_t seed);

/// Writes the probe's files to a folder that exists, and reads them. Throws InputError where they cannot be
/// written.
LoadedScene load_probe(const Probe& probe, const std::filesystem::path& folder);

}  // namespace etendue
