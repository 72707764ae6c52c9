// Bessel functions, which libc++ 13 lacks: libstdc++'s own, so that sums have the bits of a native build.
#include <cmath>
#include <limits>

#define _GLIBCXX_VISIBILITY(kind)
#define _GLIBCXX_BEGIN_NAMESPACE_VERSION
#define _GLIBCXX_END_NAMESPACE_VERSION
#define _GLIBCXX_USE_STD_SPEC_FUNCS 1
#define _GLIBCXX_USE_C99_MATH 1
#define _GLIBCXX_USE_C99_MATH_TR1 1
#define __N(text) text
#include <tr1/bessel_function.tcc>
#include <tr1/gamma.tcc>
#include <tr1/modified_bessel_func.tcc>

double std::cyl_bessel_j(double order, double x) {
  return __detail::__cyl_bessel_j(order, x);
}

double std::cyl_bessel_i(double order, double x) {
  return __detail::__cyl_bessel_i(order, x);
}
