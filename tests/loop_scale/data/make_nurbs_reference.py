#!/usr/bin/env python3
"""Writes nurbs_reference.txt: interpolating curves found by SciPy (scipy.interpolate.make_interp_spline,
scipy.integrate.quad), an implementation independent of src/loop_scale/nurbs.cpp. Made with SciPy 1.10.1;
run it again only to add cases:  python3 make_nurbs_reference.py > nurbs_reference.txt

A case:
  case NAME DEGREE PARAMETRISATION ENDS     ends: averaged natural periodic
  points N, then N lines x y z
  shift x y z                               periodic only
  weights N w ...                           0: none
  length L
  samples M, then M lines u x y z x' y' z' x'' y'' z''
"""
import numpy as np
from scipy.integrate import quad
from scipy.interpolate import make_interp_spline

# Table 2 of the first paper (r = 1, one loop) and its neighbour to the right
LOOP = np.array([[-4, -3, -1.5], [-1, 0, 0], [-2, 3.5, 1.5], [-3, 7, 0], [0, 10, -1.5], [3, 7, 0], [2, 3.5, 1.5],
                 [1, 0, 0]], float)
COURSE = np.vstack([LOOP, LOOP + [8, 0, 0], [[12, -3, -1.5]]])
RAGGED = np.random.default_rng(7).normal(size=(12, 3)).cumsum(axis=0)


def parameters(points, rule):
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    step = {"chord": chord, "centripetal": np.sqrt(chord), "uniform": np.ones(len(chord))}[rule]
    return np.concatenate([[0], np.cumsum(step)])


def spline(points, degree, rule, ends, shift, weights):
    """Homogeneous spline as a function u, derivative -> (x, y, z, w), its first and last parameter."""
    if ends == "periodic":
        u = parameters(np.vstack([points, points[:1] + shift]), rule)
        line = np.outer(u / u[-1], shift)
        closed = np.vstack([points, points[:1] + shift]) - line
        periodic = make_interp_spline(u, closed, k=3, bc_type="periodic")
        slope = np.array(shift) / u[-1]

        def curve(x, nu=0):
            straight = {0: slope * x, 1: slope}.get(nu, slope * 0)
            return np.append(periodic(x, nu=nu) + straight, 1.0 if nu == 0 else 0.0)
        return curve, u
    u = parameters(points, rule)
    if ends == "natural":
        cubic = make_interp_spline(u, points, k=3, bc_type="natural")
        return lambda x, nu=0: np.append(cubic(x, nu=nu), 1.0 if nu == 0 else 0.0), u
    inner = [u[j:j + degree].mean() for j in range(1, len(u) - degree)]
    knots = np.concatenate([[u[0]] * (degree + 1), inner, [u[-1]] * (degree + 1)])
    if weights is None:
        b = make_interp_spline(u, points, k=degree, t=knots)
        return lambda x, nu=0: np.append(b(x, nu=nu), 1.0 if nu == 0 else 0.0), u
    from scipy.interpolate import BSpline
    w = BSpline(knots, np.array(weights), degree)
    a = make_interp_spline(u, points * w(u)[:, None], k=degree, t=knots)
    return lambda x, nu=0: np.append(a(x, nu=nu), w(x, nu=nu)), u


def rational(curve, x):
    a0, a1, a2 = (curve(x, nu) for nu in range(3))
    c0 = a0[:3] / a0[3]
    c1 = (a1[:3] - a1[3] * c0) / a0[3]
    c2 = (a2[:3] - 2 * a1[3] * c1 - a2[3] * c0) / a0[3]
    return c0, c1, c2


def case(name, points, degree, rule, ends, shift=None, weights=None):
    curve, u = spline(points, degree, rule, ends, shift, weights)
    print(f"case {name} {degree} {rule} {ends}")
    print(f"points {len(points)}")
    for p in points:
        print(*(repr(float(v)) for v in p))
    if shift is not None:
        print("shift", *shift)
    print("weights", 0 if weights is None else len(weights), *([] if weights is None else weights))
    length = sum(quad(lambda x: np.linalg.norm(rational(curve, x)[1]), a, b, epsabs=1e-13, epsrel=1e-13)[0]
                 for lo, hi in zip(u, u[1:]) for a, b in [(lo, (lo + hi) / 2), ((lo + hi) / 2, hi)])
    print("length", repr(float(length)))
    samples = np.linspace(u[0], u[-1], 15)[1:-1]
    print(f"samples {len(samples)}")
    for x in samples:
        print(repr(float(x)), *(repr(float(v)) for part in rational(curve, x) for v in part))


for rule in ("chord", "centripetal", "uniform"):
    case(f"course_clamped_{rule}", COURSE, 3, rule, "averaged")
    case(f"course_natural_{rule}", COURSE, 3, rule, "natural")
    case(f"course_periodic_{rule}", LOOP, 3, rule, "periodic", shift=[8, 0, 0])
case("ragged_quintic", RAGGED, 5, "centripetal", "averaged")
case("ragged_quadratic", RAGGED, 2, "chord", "averaged")
case("ragged_rational", RAGGED, 3, "chord", "averaged",
     weights=[1, 2, 0.5, 1, 3, 1, 0.7, 1.2, 1, 2, 1, 0.4])
case("three_points_natural", RAGGED[:3], 3, "chord", "natural")
