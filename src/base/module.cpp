#include "base/module.h"

#include "base/error.h"

#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>

namespace etendue {

void* module_entry(const std::string& name, const char* entry) {
  Dl_info info;
  if (!dladdr(reinterpret_cast<const void*>(&module_entry), &info))
    throw InputError("cannot find the folder of the Etendue library");
  const std::filesystem::path file =
      std::filesystem::path(info.dli_fname).parent_path() / fmt::format("libetendue_{}.so", name);
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) throw InputError(fmt::format("cannot load a part of the program: {}", dlerror()));
  void* const function = dlsym(module, entry);
  if (!function) throw InputError(fmt::format("{} is not that part: {}", file.string(), dlerror()));
  return function;
}

}  // namespace etendue
