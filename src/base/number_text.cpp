#include "base/number_text.h"

#include <cmath>
#include <locale.h>
#include <stdlib.h>
#include <string>

namespace etendue {

std::from_chars_result number_from_chars(const char* first, const char* last, double& value) {
  const std::from_chars_result result = std::from_chars(first, last, value);
  if (result.ec != std::errc::result_out_of_range) return result;
  // from_chars does not say on which side; strtod does.
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
  const double nearest = strtod_l(std::string(first, result.ptr).c_str(), nullptr, plain);
  if (std::isinf(nearest)) return result;
  value = nearest;
  return {result.ptr, std::errc()};
}

}  // namespace etendue
