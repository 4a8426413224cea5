// How Boost.Math is used here: infinity where a quantile is infinite, an exception for bad arguments.
#pragma once

#include <boost/math/policies/policy.hpp>

namespace etendue {

using BoostPolicy =
    boost::math::policies::policy<boost::math::policies::overflow_error<boost::math::policies::ignore_error>,
                                  boost::math::policies::domain_error<boost::math::policies::throw_on_error>>;

}  // namespace etendue
