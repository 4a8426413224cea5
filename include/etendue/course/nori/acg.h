// Names of the handouts that put each group's classes into a namespace of its own.
#pragma once

#include <nori/object.h>

#define GROUP_NAMESPACE_BEGIN() namespace group {
#define GROUP_NAMESPACE_END }
#define NORI_REGISTER_GROUP_CLASS(cls, name) \
  using cls = group::cls;                    \
  NORI_REGISTER_CLASS(cls, name)
