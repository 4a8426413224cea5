// Wavefront MTL, the materials of OBJ files -> BSDFs and emitters, as a scene file would have them.
#pragma once

#include "scenefile/scene_desc.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// One `newmtl`. Properties and places of the objects are those of the MTL file.
struct MtlMaterial {
  std::string name;
  Object bsdf;                    ///< `diffuse` or `phong`
  std::optional<Object> emitter;  ///< `area`, where Ke is not black.
};

struct MtlLibrary {
  std::vector<MtlMaterial> materials;  ///< As the file has them; the first of two of one name counts.
  std::vector<std::string> warnings;   ///< Of what is not rendered as the file has it; complete messages.
};

/// Reads directory / name. Kd is the diffuse reflectance, Ks and Ns are a Phong lobe (where `illum` is not 0
/// or 1), Ke is radiance in W/(m^2 sr); map_Kd takes the place of Kd. Kd and Ks are scaled down where their
/// sum exceeds 1, and a material with a texture has no lobe. What lets light through is opaque. Each such
/// thing, and each statement that is passed over, is in `warnings`, once a file; Ka and Ni mean nothing here.
///
/// Textures are named by paths of the kind of `name`: relative to `directory`, or absolute.
///
/// Throws InputError, with line and column, for: a file that is missing, no text or of another format,
/// a malformed number, a colour that is negative or no RGB, an Ns below 0 or above 1e6, a statement before
/// the first newmtl, a texture that is not there.
MtlLibrary read_mtl(const std::filesystem::path& directory, const std::filesystem::path& name);

}  // namespace etendue
