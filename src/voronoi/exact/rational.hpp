// Blum: rational numbers of any size. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

namespace blum::voronoi {

/// Without expression templates: what a function returns is a number, and refers to nothing that is gone.
using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;

}  // namespace blum::voronoi
