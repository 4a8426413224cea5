// Bytes as a scene file, read and made ready to render: a scene or an InputError, nothing else.
#include "base/error.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "support/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const etendue::test::MemoryFile file(data, size);
  try {
    etendue::SceneDesc description = etendue::read_nori_xml(file.path());
    description.directory = ETENDUE_FUZZ_FOLDER "/scene_files";
    etendue::load_scene(description);
  } catch (const etendue::InputError&) {
  }
  return 0;
}
