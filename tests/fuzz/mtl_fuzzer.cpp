// Bytes as an MTL file: materials that a scene file could state or an InputError, nothing else.
#include "base/error.h"
#include "scenefile/mtl_reader.h"
#include "support/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const etendue::test::MemoryFile file(data, size);
  try {
    etendue::read_mtl({}, file.path());
  } catch (const etendue::InputError&) {
  }
  return 0;
}
