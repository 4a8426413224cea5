// A shared library that a student's file was compiled to, and the integrators in it.
#pragma once

#include <filesystem>
#include <nori/integrator.h>
#include <span>
#include <string>
#include <string_view>

namespace etendue {

class StudentModule {
 public:
  /// Loads it; it stays loaded. Throws InputError where it cannot be, or was compiled for another version of
  /// the headers, or registers no class.
  explicit StudentModule(const std::filesystem::path& file);

  std::span<const nori::ClassOfModule> classes() const { return classes_; }
  /// The class of this name; of an empty name the only one. Throws InputError with the names that there are.
  const nori::ClassOfModule& find(std::string_view name) const;
  const std::string& file() const { return file_; }
  /// Its name and a hash of its content: for what is said of an image.
  const std::string& identity() const { return identity_; }

 private:
  std::string file_, identity_;
  std::span<const nori::ClassOfModule> classes_;
};

}  // namespace etendue
