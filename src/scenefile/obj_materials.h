// A mesh that asks for the materials of its OBJ file -> one mesh for each of them.
#pragma once

#include "scenefile/scene_desc.h"

namespace etendue {

/// Puts, in the place of each mesh of type `obj` whose `materials` is true, as many meshes as its file has
/// materials with faces: of one material each (`usemtl`), with the BSDF and the emitter of the libraries that
/// the file names. Faces without a material, and those of one that no library has (with a warning), keep the
/// BSDF and the emitter of the mesh. What is read is added to `scene.material_libraries`. A mesh whose keys
/// are not as they should be is left for its reader to refuse.
///
/// Throws InputError where the OBJ file cannot be read or names no library, and as read_mtl() does.
void split_by_materials(SceneDesc& scene);

}  // namespace etendue
