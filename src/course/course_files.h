// The files of the course kit that come with the program: headers, exercises, scenes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// Where <nori/...> is found. Throws InputError where the headers are not there.
std::filesystem::path course_headers();

/// The page of the lab, with @DATA@ where its pictures go. Throws InputError where it is not there.
std::filesystem::path lab_page_file();

/// What a student's folder starts with.
struct Exercise {
  std::filesystem::path files;   ///< A folder: the student's file, its README, what is to be filled in.
  std::filesystem::path scenes;  ///< A folder.
};
/// Throws InputError with the exercises that there are.
Exercise exercise_named(const std::string& name);

/// Copies all of an exercise into a folder, which is made where it is not there. What is there already stays.
/// \return what was there, by its path. Throws InputError where it cannot be written.
std::vector<std::filesystem::path> start_exercise(const std::string& name,
                                                  const std::filesystem::path& folder);

}  // namespace etendue
