// Reads the XML of the Nori family into a SceneDesc.
#pragma once

#include "scenefile/dialect.h"
#include "scenefile/scene_desc.h"

#include <filesystem>
#include <optional>

namespace etendue {

/// Reads a scene or test file (UTF-8, UTF-16, UTF-32 or declared ISO-8859-1; at most 256 MiB; 64 elements
/// deep). The dialect is, first of these: `dialect`; the attribute `dialect="..."` of the root; what
/// an etendue.json says (folder_settings.h); what the names in the file tell (recognize_dialect). Children of
/// a scene that have no part in its image (evaluators, previewers, denoisers) are left out, with a warning.
/// Meshes are split by the materials of their OBJ files where they ask for them (split_by_materials). Throws
/// InputError for anything that is not well-formed or not of the format.
SceneDesc read_nori_xml(const std::filesystem::path& file, std::optional<Dialect> dialect = std::nullopt);

}  // namespace etendue
