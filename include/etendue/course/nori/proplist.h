// The parameters that a scene file states for an object.
#pragma once

#include <nori/color.h>
#include <nori/vector.h>
#include <optional>

NORI_NAMESPACE_BEGIN

/// By itself, none.
class NORI_SHARED PropertyList {
 public:
  virtual ~PropertyList() = default;

  // Each throws NoriException where the file does not state the parameter.
  bool getBoolean(const std::string& name) const { return stated(boolean(name), name); }
  int getInteger(const std::string& name) const { return stated(integer(name), name); }
  float getFloat(const std::string& name) const { return stated(real(name), name); }
  std::string getString(const std::string& name) const { return stated(text(name), name); }
  Color3f getColor(const std::string& name) const { return stated(color(name), name); }
  Point3f getPoint(const std::string& name) const { return stated(vector(name), name); }
  Vector3f getVector(const std::string& name) const { return stated(vector(name), name); }

  // Each gives `other` there.
  bool getBoolean(const std::string& name, bool other) const { return boolean(name).value_or(other); }
  int getInteger(const std::string& name, int other) const { return integer(name).value_or(other); }
  float getFloat(const std::string& name, float other) const { return real(name).value_or(other); }
  std::string getString(const std::string& name, const std::string& other) const {
    return text(name).value_or(other);
  }
  Color3f getColor(const std::string& name, const Color3f& other) const {
    return color(name).value_or(other);
  }
  Point3f getPoint(const std::string& name, const Point3f& other) const {
    return vector(name).value_or(other);
  }
  Vector3f getVector(const std::string& name, const Vector3f& other) const {
    return vector(name).value_or(other);
  }

 protected:
  virtual std::optional<bool> boolean(const std::string& /*name*/) const { return {}; }
  virtual std::optional<int> integer(const std::string& /*name*/) const { return {}; }
  virtual std::optional<float> real(const std::string& /*name*/) const { return {}; }
  virtual std::optional<std::string> text(const std::string& /*name*/) const { return {}; }
  virtual std::optional<Color3f> color(const std::string& /*name*/) const { return {}; }
  virtual std::optional<Vector3f> vector(const std::string& /*name*/) const { return {}; }

 private:
  template <class T>
  static T stated(const std::optional<T>& value, const std::string& name) {
    if (!value) throw NoriException("the scene file states no '" + name + "' for this object");
    return *value;
  }
};

NORI_NAMESPACE_END
