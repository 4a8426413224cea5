// What shines: a mesh has a luminaire where its surface is a light.
#pragma once

#include <nori/color.h>
#include <nori/object.h>
#include <nori/ray.h>

NORI_NAMESPACE_BEGIN

class Luminaire;
class Mesh;
using Emitter = Luminaire;  ///< As later frameworks call it.

/// A place that is lit, a point on a light, and what lies between the two. All in the world.
struct LuminaireQueryRecord {
  const Luminaire* luminaire = nullptr;
  Point3f ref;     ///< The place that is lit (m) ...
  Point3f p;       ///< ... and the point on the light (m).
  Normal3f n;      ///< Of the light at p, on the side that shines; unit.
  float pdf = 0;   ///< With which p was chosen; of what it is a density, its user decides.
  Vector3f d;      ///< From ref to p, unit.
  float dist = 0;  ///< From ref to p, m.

  LuminaireQueryRecord() = default;
  explicit LuminaireQueryRecord(const Point3f& ref) : ref(ref) {}
  /// Of a point that is known, for example one that a ray has met.
  LuminaireQueryRecord(const Luminaire* luminaire, const Point3f& ref, const Point3f& p, const Normal3f& n)
      : luminaire(luminaire), ref(ref), p(p), n(n), d((p - ref).normalized()), dist((p - ref).norm()) {}
};

class NORI_SHARED Luminaire : public NoriObject {
 public:
  /// The radiance (W/(m^2 sr)) that leaves lRec.p against lRec.d; 0 where lRec.n, the light's front, is
  /// turned away.
  virtual Color3f eval(const LuminaireQueryRecord& lRec) const = 0;
  /// The radiance (W/(m^2 sr)) on the side that shines.
  virtual Color3f getColor() const = 0;
  /// The mesh that shines.
  virtual const Mesh* getMesh() const = 0;
  /// The same as what it is a part of, for a dynamic_cast.
  virtual const NoriObject* getParent() const = 0;
  virtual bool isEnvironmentLuminaire() const { return false; }
};

NORI_NAMESPACE_END
