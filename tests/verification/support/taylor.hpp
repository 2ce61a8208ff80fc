// Truncated Taylor polynomials of two variables: exact derivatives of fields written once as formulas.
#pragma once

#include <array>
#include <cmath>

namespace undula::verification {

/// Value and derivatives of f(x, y) up to total degree `order` at one point: c[i][j] multiplies dx^i dy^j.
template <int order>
struct Taylor {
  std::array<std::array<double, order + 1>, order + 1> c{};

  Taylor() = default;
  Taylor(double value) { c[0][0] = value; } // constants mix with fields in formulas

  double value() const { return c[0][0]; }
  /// d^(i+j) f / dx^i dy^j.
  double derivative(int i, int j) const { return c[i][j] * std::tgamma(i + 1) * std::tgamma(j + 1); }

  /// d/dx (axis 0) or d/dy (axis 1); the highest degree is lost, so it is right up to order - 1 only.
  Taylor differentiated(int axis) const {
    Taylor result;
    for (int i = 0; i <= order; ++i)
      for (int j = 0; i + j < order; ++j)
        result.c[i][j] = axis == 0 ? (i + 1) * c[i + 1][j] : (j + 1) * c[i][j + 1];
    return result;
  }

  friend Taylor operator+(Taylor a, const Taylor& b) {
    for (int i = 0; i <= order; ++i)
      for (int j = 0; j <= order; ++j) a.c[i][j] += b.c[i][j];
    return a;
  }
  friend Taylor operator-(const Taylor& a) { return Taylor(-1) * a; }
  friend Taylor operator-(const Taylor& a, const Taylor& b) { return a + (-b); }
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    Taylor product;
    for (int i = 0; i <= order; ++i)
      for (int j = 0; i + j <= order; ++j)
        for (int k = 0; i + j + k <= order; ++k)
          for (int l = 0; i + j + k + l <= order; ++l) product.c[i + k][j + l] += a.c[i][j] * b.c[k][l];
    return product;
  }
};

/// The coordinate along `axis` (0 or 1) at `value`.
template <int order>
Taylor<order> coordinate(int axis, double value) {
  Taylor<order> x(value);
  (axis == 0 ? x.c[1][0] : x.c[0][1]) = 1;
  return x;
}

template <int order>
Taylor<order> sin(const Taylor<order>& f) {
  Taylor<order> rest = f, power(1), sum;
  rest.c[0][0] = 0;
  double factorial = 1;
  for (int k = 0; k <= order; ++k) {
    // The k-th derivative of the sine is the sine a quarter turn further.
    sum = sum + Taylor<order>(std::sin(f.value() + k * std::asin(1.0)) / factorial) * power;
    power = power * rest;
    factorial *= k + 1;
  }
  return sum;
}

template <int order>
Taylor<order> cos(const Taylor<order>& f) {
  return sin(f + Taylor<order>(std::asin(1.0)));
}

} // namespace undula::verification
