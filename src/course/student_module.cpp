#include "course/student_module.h"

#include "base/content_hash.h"
#include "base/error.h"
#include "scenefile/whole_file.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace etendue {

namespace {

std::string identity_of(const std::filesystem::path& file) {
  const std::shared_ptr<const SourceFile> source = read_whole_file(file, "a plugin");
  ContentHash hash;
  hash.add(source->text.data(), source->text.size());
  return fmt::format("{} {:016x}", file.filename().string(), hash.digest());
}

}  // namespace

StudentModule::StudentModule(const std::filesystem::path& file) : file_(file.string()) {
  // With a folder in its name, or it would be looked for where the system's libraries are.
  void* const library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw InputError(fmt::format("cannot load the plugin {}: {}", file_, dlerror()));
  void* const entry = dlsym(library, "etendue_course_module");
  if (!entry)
    throw InputError(
        fmt::format("{} is no plugin: it registers no integrator\n"
                    "  write NORI_REGISTER_CLASS(ClassName, \"name\"); below the class",
                    file_));
  const nori::Module module = reinterpret_cast<decltype(&etendue_course_module)>(entry)();
  if (module.version != nori::Module::current_version)
    throw InputError(
        fmt::format("{} was compiled with headers of version {}, and this program has {}\n"
                    "  compile it again, with the headers that came with this program",
                    file_, module.version, nori::Module::current_version));
  if (module.count == 0)
    throw InputError(
        fmt::format("{} registers no integrator\n"
                    "  write NORI_REGISTER_CLASS(ClassName, \"name\"); below the class",
                    file_));
  identity_ = identity_of(file);
  classes_ = {module.classes, std::size_t(module.count)};
}

const nori::ClassOfModule& StudentModule::find(std::string_view name) const {
  if (name.empty() && classes_.size() == 1) return classes_.front();
  std::vector<std::string> names;
  for (const nori::ClassOfModule& one : classes_) {
    if (one.name == name) return one;
    names.emplace_back(one.name);
  }
  if (name.empty())
    throw InputError({}, fmt::format("{} has several integrators; name one", file_),
                     known_names(name, names));
  throw InputError({}, fmt::format("{} has no integrator '{}'", file_, name), known_names(name, names));
}

}  // namespace etendue
