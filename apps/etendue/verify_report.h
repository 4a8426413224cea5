// What `etendue verify` says: in words, as JSON, as a map.
#pragma once

#include "scene/scene_places.h"
#include "verify/verify.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace etendue::app {

/// A table of the estimators, and then who differs from whom, where and by how much, or how small a
/// difference would have been found.
std::string report_text(const VerifyResult& result, const Scene& scene, const ScenePlaces& places);

nlohmann::ordered_json report_json(const VerifyResult& result, const Scene& scene,
                                   const std::string& scene_file);

/// Of the pair that differs most: `Y` and `block.Y`, the signed difference of luminance in standard errors by
/// pixel and by block; `a.Y`, `b.Y` the luminances. Throws InputError where the file cannot be written.
void write_map(const std::filesystem::path& file, const VerifyResult& result);

}  // namespace etendue::app
