#include "stats/quantile.h"

#include "stats/boost_policy.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace etendue {

double normal_quantile(double p) {
  return quantile(boost::math::normal_distribution<double, BoostPolicy>(0, 1), p);
}

double student_t_quantile(double p, double degrees_of_freedom) {
  return quantile(boost::math::students_t_distribution<double, BoostPolicy>(degrees_of_freedom), p);
}

double chi_squared_quantile(double p, double degrees_of_freedom) {
  return quantile(boost::math::chi_squared_distribution<double, BoostPolicy>(degrees_of_freedom), p);
}

}  // namespace etendue
