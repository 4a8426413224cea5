#include "render/isa.h"

#include "base/error.h"
#include "base/module.h"
#include "render/kernel.h"

#include <array>
#include <fmt/format.h>
#include <mutex>
#include <string>

namespace etendue {

namespace {

constexpr std::array all_isas{Isa::scalar, Isa::v2, Isa::v3, Isa::v4};
constexpr std::array<std::string_view, 4> isa_names{"scalar", "v2", "v3", "v4"};

/// Whether kernels were built for it.
bool is_built(Isa isa) {
  return std::string_view(ETENDUE_ISAS).find(isa_name(isa)) != std::string_view::npos;
}

bool has_isa(Isa isa) {
  __builtin_cpu_init();
#ifdef __clang__
  // As far as clang 16 can name them: it does not know "x86-64-v3".
  const bool has_v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
  const bool has_v3 = has_v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool has_v4 = has_v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
#else
  const bool has_v2 = __builtin_cpu_supports("x86-64-v2"), has_v3 = __builtin_cpu_supports("x86-64-v3"),
             has_v4 = __builtin_cpu_supports("x86-64-v4");
#endif
  switch (isa) {
    case Isa::scalar:
      return true;
    case Isa::v2:
      return has_v2;
    case Isa::v3:
      return has_v3;
    case Isa::v4:
      return has_v4;
  }
  return false;
}

const Kernel* load_kernel(Isa isa) {
  void* entry = module_entry(fmt::format("kernel_{}", isa_name(isa)), "etendue_kernel");
  return reinterpret_cast<const Kernel* (*)()>(entry)();
}

}  // namespace

std::string_view isa_name(Isa isa) { return isa_names[std::size_t(isa)]; }

std::vector<Isa> available_isas() {
  std::vector<Isa> available;
  for (const Isa isa : all_isas)
    if (is_built(isa) && has_isa(isa)) available.push_back(isa);
  return available;
}

Isa isa_from_name(std::string_view name) {
  for (const Isa isa : all_isas) {
    if (isa_name(isa) != name) continue;
    if (!is_built(isa))
      throw InputError(fmt::format("this program was built without '{}' kernels; see etendue info", name));
    if (!has_isa(isa))
      throw InputError(fmt::format("this machine has no '{}' instructions; see etendue info", name));
    return isa;
  }
  throw InputError({}, fmt::format("unknown instruction set '{}'", name),
                   known_names(name, std::vector<std::string>(isa_names.begin(), isa_names.end())));
}

int lane_count(Isa isa) { return kernel_for(isa).lanes; }

const Kernel& kernel_for(Isa isa) {
  static std::array<const Kernel*, all_isas.size()> kernels{};
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const Kernel*& kernel = kernels[std::size_t(isa)];
  if (!kernel) kernel = load_kernel(isa);
  return *kernel;
}

}  // namespace etendue
