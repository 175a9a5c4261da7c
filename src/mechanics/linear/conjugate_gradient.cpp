#include "mechanics/linear/conjugate_gradient.hpp"

namespace loopwright {

ConjugateGradientResult conjugate_gradient(const BlockMatrix& matrix, double shift,
                                           const Preconditioner& preconditioner, const Unknowns& b,
                                           double tolerance, int most, Unknowns& x) {
  ConjugateGradientResult result;
  Unknowns r = b, z, p, Ap;
  x.u.assign(b.u.size(), Vec3{});
  x.g = {};
  preconditioner(r, z);
  p = z;
  double rz = dot(r, z);
  const double wanted = tolerance * tolerance * rz;
  while (result.iterations < most) {
    if (!(rz > wanted)) {
      result.converged = true;
      break;
    }
    multiply(matrix, shift, p, Ap);
    ++result.iterations;
    const double curvature = dot(p, Ap);
    if (!(curvature > 0)) {
      result.indefinite = true;
      break;
    }
    const double a = rz / curvature;
    axpy(a, p, x);
    axpy(-a, Ap, r);
    preconditioner(r, z);
    const double next = dot(r, z), beta = next / rz;
    rz = next;
    for (std::size_t i = 0; i < p.u.size(); ++i) p.u[i] = z.u[i] + beta * p.u[i];
    for (std::size_t k = 0; k < 3; ++k) p.g[k] = z.g[k] + beta * p.g[k];
  }
  return result;
}

}  // namespace loopwright
