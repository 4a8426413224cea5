// A shape of the scene, and what is known where a ray meets one.
#pragma once

#include <nori/frame.h>
#include <nori/luminaire.h>

NORI_NAMESPACE_BEGIN

class BSDF;

class NORI_SHARED Mesh : public NoriObject {
 public:
  /// A point uniform by area on the whole surface. \param sample uniform in the unit square
  /// \param p the point (world, m) \param n the geometric normal there (world, unit), of the front side
  virtual void samplePosition(const Point2f& sample, Point3f& p, Normal3f& n) const = 0;
  /// The density of samplePosition per area (1/m^2): one over the area of the whole surface.
  virtual float pdf() const = 0;
  /// Of which the surface is made; 0 where it is a sphere or a disk.
  virtual int getTriangleCount() const = 0;

  /// Whether it is a light.
  bool isLuminaire() const { return getLuminaire() != nullptr; }
  /// Null where it is none.
  virtual const Luminaire* getLuminaire() const = 0;
  bool isEmitter() const { return isLuminaire(); }
  const Emitter* getEmitter() const { return getLuminaire(); }
  virtual const BSDF* getBSDF() const = 0;
  /// As messages about the scene name it.
  virtual const std::string& getName() const = 0;
};

/// Where a ray met a surface.
struct Intersection {
  Point3f p;  ///< World, m; off the surface by what rounding cannot tell, towards the ray.
  float t = std::numeric_limits<float>::infinity();  ///< Along the ray.
  Point2f uv;                                        ///< Where textures are looked up.
  Frame shFrame;               ///< Around the shading normal, that of smooth meshes is interpolated.
  Frame geoFrame;              ///< Around the geometric normal.
  const Mesh* mesh = nullptr;  ///< What was met.

  // Of directions; z of a local one is along the shading normal.
  Vector3f toLocal(const Vector3f& world) const { return shFrame.toLocal(world); }
  Vector3f toWorld(const Vector3f& local) const { return shFrame.toWorld(local); }
};

NORI_NAMESPACE_END
