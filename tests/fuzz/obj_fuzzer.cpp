// Bytes as an OBJ file: a sound mesh or an InputError, nothing else.
#include "base/error.h"
#include "geometry/obj_reader.h"
#include "sound_mesh.h"
#include "support/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const etendue::test::MemoryFile file(data, size);
  try {
    etendue::require_sound(etendue::read_obj(file.path(), {}));
  } catch (const etendue::InputError&) {
  }
  return 0;
}
