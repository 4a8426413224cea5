// What a scene is made of, the parameters that a scene file states for it, and how a module tells the program
// of its classes.
#pragma once

#include <nori/proplist.h>

NORI_NAMESPACE_BEGIN

/// Any part of a scene.
class NORI_SHARED NoriObject {
 public:
  virtual ~NoriObject() = default;
  virtual std::string toString() const { return {}; }
};

class Integrator;

/// A class of a module: made from the parameters that the scene file has for it.
struct ClassOfModule {
  const char* name;   ///< By which --integrator and scene files call it.
  const char* group;  ///< The file's GROUP_NUMBER; "GROUP_NUMBER" where it has none.
  Integrator* (*make)(const PropertyList&);
};

/// What a module tells the program; changes in its meaning change `version`.
struct Module {
  static constexpr int current_version = 1;
  int version;
  const ClassOfModule* classes;
  int count;
};

/// Of this module alone: hidden, so that modules in one program do not share it.
[[gnu::visibility("hidden")]] inline std::vector<ClassOfModule>& classes_of_module() {
  static std::vector<ClassOfModule> classes;
  return classes;
}

struct [[gnu::visibility("hidden")]] AddClass {
  explicit AddClass(const ClassOfModule& added) { classes_of_module().push_back(added); }
};

#define ETENDUE_TEXT_OF(x) #x
#define ETENDUE_TEXT(x) ETENDUE_TEXT_OF(x)

/// Makes an integrator known by a name; stands once for each class, outside of it.
#define NORI_REGISTER_CLASS(cls, name)               \
  static const ::nori::AddClass etendue_class_##cls( \
      {name, ETENDUE_TEXT(GROUP_NUMBER),             \
       [](const ::nori::PropertyList& properties) -> ::nori::Integrator* { return new cls(properties); }});

NORI_NAMESPACE_END

/// What the program asks a module for.
extern "C" NORI_SHARED __attribute__((used)) inline nori::Module etendue_course_module() {
  const std::vector<nori::ClassOfModule>& classes = nori::classes_of_module();
  return {nori::Module::current_version, classes.data(), int(classes.size())};
}
