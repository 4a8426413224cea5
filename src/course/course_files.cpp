#include "course/course_files.h"

#include "base/error.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace etendue {

namespace fs = std::filesystem;

namespace {

/// Of what is installed below the library's own prefix, or else of the source that it was built from.
fs::path file_of_program(const char* installed, const char* in_source) {
  Dl_info info;
  if (dladdr(reinterpret_cast<const void*>(&course_headers), &info)) {
    const fs::path place = fs::weakly_canonical(info.dli_fname).parent_path().parent_path() / installed;
    if (fs::exists(place)) return place;
  }
  return fs::path(ETENDUE_SOURCE_DIR) / in_source;
}

}  // namespace

fs::path course_headers() {
  const fs::path place = file_of_program("include/etendue/course", "include/etendue/course");
  if (!fs::exists(place / "nori/integrator.h"))
    throw InputError(
        fmt::format("the headers of the course kit are not where they should be, in {}\n"
                    "  install Etendue again (cmake --install)",
                    place.string()));
  return place;
}

fs::path lab_page_file() {
  const fs::path place = file_of_program("share/etendue/course/lab/page.html", "course/lab/page.html");
  if (!fs::exists(place))
    throw InputError(
        fmt::format("the page of the lab is not where it should be, in {}\n"
                    "  install Etendue again (cmake --install)",
                    place.string()));
  return place;
}

Exercise exercise_named(const std::string& name) {
  if (name != "ex3")
    throw InputError({}, fmt::format("unknown exercise '{}'", name), known_names(name, {"ex3"}));
  const Exercise exercise{file_of_program("share/etendue/course/ex3", "course/ex3"),
                          file_of_program("share/etendue/scenes/ex3", "scenes/ex3")};
  if (!fs::exists(exercise.files) || !fs::exists(exercise.scenes))
    throw InputError(
        fmt::format("the files of the exercise are not where they should be, in {} and {}\n"
                    "  install Etendue again (cmake --install)",
                    exercise.files.string(), exercise.scenes.string()));
  return exercise;
}

std::vector<fs::path> start_exercise(const std::string& name, const fs::path& folder) {
  const Exercise exercise = exercise_named(name);
  std::vector<fs::path> kept;
  const auto copy = [&](const fs::path& from, const fs::path& to) {
    fs::create_directories(to);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(from)) {
      const fs::path target = to / entry.path().lexically_relative(from);
      if (entry.is_directory())
        fs::create_directories(target);
      else if (fs::exists(fs::symlink_status(target)))
        kept.push_back(target);
      else if (entry.path().extension() != ".py")  // what made the scenes
        fs::copy_file(entry.path(), target);
    }
  };
  try {
    copy(exercise.files, folder);
    copy(exercise.scenes, folder / "scenes" / name);
  } catch (const fs::filesystem_error& error) {
    throw InputError(fmt::format("cannot write {}: {}", folder.string(), error.code().message()));
  }
  return kept;
}

}  // namespace etendue
