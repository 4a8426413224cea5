// Quantiles of the normal, Student and chi-squared distributions (Boost.Math).
#pragma once

namespace etendue {

/// The value below which a standard normal variable lies with probability `p` in [0, 1]; -inf at 0, +inf
/// at 1. This and the quantiles below throw std::domain_error for arguments outside their ranges or NaN.
double normal_quantile(double p);

/// The same for Student's t with `degrees_of_freedom` > 0 (need not be whole).
double student_t_quantile(double p, double degrees_of_freedom);

/// The same for chi-squared with `degrees_of_freedom` > 0; 0 at p = 0.
double chi_squared_quantile(double p, double degrees_of_freedom);

}  // namespace etendue
