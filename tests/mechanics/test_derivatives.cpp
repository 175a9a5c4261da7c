// Gradient and Hessian of every energy, and of the assembled fabric, against differences.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "mechanics/energies/all.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

using Generator = std::mt19937_64;

double uniform(Generator& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Control points of a segment of about length 1.4 d along x, disturbed.
template <std::size_t Dofs>
void place_segment(std::array<double, Dofs>& x, std::size_t from, Generator& random, const Vec3& middle,
                   const Vec3& direction) {
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      x[from + 3 * k + c] = middle[static_cast<int>(c)] +
                            1.4 * (static_cast<double>(k) - 1.5) * direction[static_cast<int>(c)] +
                            uniform(random, -0.1, 0.1);
}

// One case per energy: an element with plausible data and a state in which it is loaded. An energy in
// AllEnergies without its own specialisation here does not compile.
template <class Energy>
struct Case;

template <>
struct Case<Stretch> {
  static Stretch element(Generator& random) {
    return {uniform(random, 100, 3000), uniform(random, 1.2, 1.6)};
  }
  static std::array<double, 12> state(const Stretch&, Generator& random) {
    std::array<double, 12> x{};
    place_segment(x, 0, random, {}, {0.6, 0.64, 0.48});
    return x;
  }
};

template <>
struct Case<Bend> {
  // Straight yarn and set yarn, bent more and less than it was set.
  static Bend element(Generator& random) {
    static const std::array<std::array<double, 4>, 2> set{{{0.3, 0.1, 0, 0.6}, {0.02, 0.9, 0.4, 0.2}}};
    const auto kind = static_cast<std::size_t>(uniform(random, 0, 3));
    return {uniform(random, 0.5, 2), uniform(random, 1.2, 1.6), kind < 2 ? &set[kind] : nullptr};
  }
  static std::array<double, 12> state(const Bend&, Generator& random) {
    std::array<double, 12> x{};
    place_segment(x, 0, random, {1, 2, 3}, {0, 0.6, 0.8});
    x[4] += 0.5;  // a marked bend
    return x;
  }
};

template <>
struct Case<Contact> {
  static Contact element(Generator& random) {
    return {{1.0, 0.45, uniform(random, 50, 400), uniform(random, 1.5, 3)}, 8, 0.03};
  }
  static std::array<double, 24> state(const Contact&, Generator& random) {
    // Two yarns at an angle, pressed to between 0.65 and 0.85 of their diameter. The curvature of the law
    // jumps where contact begins, so states with a pair of samples just there are drawn anew.
    while (true) {
      std::array<double, 24> x{};
      const double angle = uniform(random, 0.4, 1.5);
      place_segment(x, 0, random, {}, {1, 0, 0});
      place_segment(x, 12, random, {0, 0, uniform(random, 0.75, 0.85)},
                    {std::cos(angle), std::sin(angle), 0});
      if (!begins(x)) return x;
    }
  }
  static bool begins(const std::array<double, 24>& x) {
    const SampleWeights w = sample_weights(8);
    const auto place = [&](std::size_t from, std::size_t i) {
      Vec3 p;
      for (std::size_t k = 0; k < 4; ++k)
        p += w[i][k] * Vec3{x[from + 3 * k], x[from + 3 * k + 1], x[from + 3 * k + 2]};
      return p;
    };
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < 8; ++j)
        if (std::abs(distance(place(0, i), place(12, j)) - 1) < 2e-3) return true;
    return false;
  }
};

template <>
struct Case<Friction> {
  // Half of the cases stick (slip below the softness), half slide.
  static Friction element(Generator& random) {
    Friction f;
    f.load = uniform(random, 1, 20);
    f.softness = 0.05;
    f.normal = normalized({uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 0.2, 1)});
    f.slip = f.tangential(Vec3{0.03, -0.02, 0.01} * uniform(random, 0.2, 1));
    f.weight_a = spline_weights(uniform(random, 0, 1)).value;
    f.weight_b = spline_weights(uniform(random, 0, 1)).value;
    return f;
  }
  static std::array<double, 24> state(Friction& f, Generator& random) {
    std::array<double, 24> x{};
    place_segment(x, 0, random, {}, {1, 0, 0});
    place_segment(x, 12, random, {0, 0, 0.8}, {0, 1, 0});
    // The place where the step started: this state's, less a slip of known size.
    Vec3 r;
    for (std::size_t k = 0; k < 4; ++k)
      for (int c = 0; c < 3; ++c)
        r[c] += f.weight_a[k] * x[3 * k + static_cast<std::size_t>(c)] -
                f.weight_b[k] * x[12 + 3 * k + static_cast<std::size_t>(c)];
    const double size = sliding_ = !sliding_ ? 1 : 0;
    f.start =
        r - (size > 0 ? 3.0 : 0.3) * f.softness * normalized(f.tangential({1, 0.5, -0.3})) + 0.1 * f.normal;
    return x;
  }
  static inline bool sliding_ = false;
};

template <>
struct Case<Plates> {
  static Plates element(Generator& random) { return {uniform(random, 20, 80), -0.3, 0.2, 1.4, 8}; }
  static std::array<double, 12> state(const Plates&, Generator& random) {
    std::array<double, 12> x{};
    place_segment(x, 0, random, {0, 0, uniform(random, 0.5, 0.8)}, {0.8, 0.6, 0});
    for (std::size_t k = 2; k < 12; k += 3) x[k] *= k % 2 == 0 ? 1 : 1.1;
    return x;
  }
};

template <std::size_t Dofs>
double largest(const std::array<double, Dofs>& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}

template <class Energy>
class EnergyDerivatives : public testing::Test {};

template <class Tuple>
struct AsTestTypes;
template <class... Energies>
struct AsTestTypes<std::tuple<Energies...>> {
  using Types = testing::Types<Energies...>;
};
struct EnergyName {
  template <class Energy>
  static std::string GetName(int) {  // NOLINT: GoogleTest's name
    return Energy::name;
  }
};
TYPED_TEST_SUITE(EnergyDerivatives, AsTestTypes<AllEnergies>::Types, EnergyName);

// Central differences with two steps and Richardson's extrapolation: an error of order step^4.
template <class F>
double slope_of(const F& f, double step) {
  const auto central = [&](double h) { return (f(h) - f(-h)) / (2 * h); };
  return (4 * central(step / 2) - central(step)) / 3;
}

TYPED_TEST(EnergyDerivatives, AreThoseOfTheValue) {
  constexpr std::size_t dofs = TypeParam::dofs;
  Generator random(20240617);
  for (int repeat = 0; repeat < 40; ++repeat) {
    TypeParam element = Case<TypeParam>::element(random);
    const std::array<double, dofs> x = Case<TypeParam>::state(element, random);
    const LocalTerm<dofs> term = element.evaluate(x);
    ASSERT_GT(std::abs(term.energy), 1e-8) << "the case does not load the energy";
    const double gradient_scale = largest(term.gradient);
    double hessian_scale = 0;
    for (const auto& row : term.hessian) hessian_scale = std::max(hessian_scale, largest(row));
    ASSERT_GT(gradient_scale, 1e-6);
    ASSERT_GT(hessian_scale, 1e-6);
    const auto shifted = [&](std::size_t i, double h) {
      std::array<double, dofs> y = x;
      y[i] += h;
      return element.evaluate(y);
    };
    for (std::size_t i = 0; i < dofs; ++i) {
      const double difference = slope_of([&](double h) { return shifted(i, h).energy; }, 1e-3);
      EXPECT_NEAR(term.gradient[i], difference, 1e-6 * gradient_scale)
          << "gradient " << i << ", case " << repeat;
      for (std::size_t j = 0; j < dofs; ++j) {
        EXPECT_NEAR(term.hessian[i][j], term.hessian[j][i], 1e-12 * hessian_scale);
        const double second = slope_of([&](double h) { return shifted(i, h).gradient[j]; }, 2e-4);
        EXPECT_NEAR(term.hessian[i][j], second, 1e-6 * hessian_scale)
            << "Hessian " << i << " " << j << ", case " << repeat;
      }
    }
    if (testing::Test::HasFailure()) return;
  }
}

// The yarn a tenth thicker than the one that the cloth was relaxed with, so that every contact is pressed.
ModelOptions swollen() {
  ModelOptions options = frictionless().model;
  options.material.contact.outer = 1.1;
  return options;
}

// A whole fabric along a random direction of all control points and measures.
struct Line {
  YarnModel model;
  YarnState state;
  Unknowns direction;
};

Line line_through(const Fabric& fabric, const ModelOptions& options, unsigned seed) {
  Line line{build_yarn_model(fabric, options), build_yarn_state(fabric), {}};
  Generator random(seed);
  for (int i = 0; i < line.model.nodes; ++i) {
    const Vec3 v{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    line.direction.u.push_back(line.model.held[static_cast<std::size_t>(i)] ? Vec3{} : v);
  }
  const FreeMeasures& free = line.model.free;
  line.direction.g = {free.width ? 3 * uniform(random, 0.5, 1) : 0,
                      free.height ? -2 * uniform(random, 0.5, 1) : 0,
                      free.skew ? uniform(random, 0.5, 1) : 0};
  return line;
}

// Moves every control point that is free by up to `size`, so that nothing is at rest and contacts are uneven.
Fabric disturbed(Fabric fabric, double size) {
  Generator random(7);
  for (FabricYarn& yarn : fabric.yarns)
    for (std::size_t i = 0; i < yarn.control_points.size(); ++i)
      if (i >= yarn.held.size() || !yarn.held[i])
        yarn.control_points[i] +=
            Vec3{uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
  return fabric;
}

constexpr double pair_range = 1.7;

// The gradient in the unknowns of the line's start, at its place h. An assembled gradient belongs to the
// unknowns of its own state, in which the measures carry the points from where they are: M_i differs by what
// the points have moved.
Unknowns gradient_at(const Line& line, double h) {
  Assembly assembly(line.model);
  const YarnState state = assembly.moved(line.state, line.direction, h);
  Unknowns gradient;
  BlockMatrix unused;
  assembly.update_pairs(state, pair_range);
  assembly.hessian(state, gradient, unused);
  const auto there = assembly.fractions(state), start = assembly.fractions(line.state);
  const FreeMeasures& free = line.model.free;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const double xi = start[i][0] - there[i][0], eta = start[i][1] - there[i][1];
    if (free.width) gradient.g[0] += xi * gradient.u[i].x;
    if (free.height) gradient.g[1] += eta * gradient.u[i].y;
    if (free.skew) gradient.g[2] += eta * gradient.u[i].x;
  }
  return gradient;
}

// Held points move with the measures alone, so their place in the frame and with it M_i stay as they are.
void check_line(const Line& line) {
  Assembly assembly(line.model);
  assembly.update_pairs(line.state, pair_range);
  Unknowns gradient, product;
  BlockMatrix hessian;
  const EnergyParts parts = assembly.hessian(line.state, gradient, hessian);
  ASSERT_GT(parts.contact, 0.01) << "no contact in this case";
  EXPECT_NEAR(parts.total(), assembly.energy(line.state).total(), 1e-12 * parts.total());
  multiply(hessian, line.direction, product);

  const auto energy_at = [&](double h) {
    return assembly.energy(assembly.moved(line.state, line.direction, h)).total();
  };
  const double slope = dot(gradient, line.direction), curve = dot(product, line.direction);
  EXPECT_NEAR(slope, slope_of(energy_at, 2e-4), 1e-6 * std::abs(slope) + 1e-8 * curve);

  // Every row of the Hessian: differences of the gradient along the line. Steps are small because the Hessian
  // jumps where samples come into contact.
  constexpr double h = 1e-6;
  const Unknowns ahead = gradient_at(line, h), behind = gradient_at(line, -h);
  double scale = 0;
  for (const Vec3& v : product.u) scale = std::max(scale, norm(v));
  for (std::size_t i = 0; i < product.u.size(); ++i) {
    if (line.model.held[i]) {
      EXPECT_EQ(gradient.u[i], Vec3{});
      continue;
    }
    const Vec3 difference = (ahead.u[i] - behind.u[i]) / (2 * h);
    EXPECT_NEAR(norm(difference - product.u[i]), 0, 1e-5 * scale) << "control point " << i;
  }
  const FreeMeasures& free = line.model.free;
  const std::array<bool, 3> is_free{free.width, free.height, free.skew};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_free[k]) {
      EXPECT_EQ(gradient.g[k], 0);
      continue;
    }
    EXPECT_NEAR(product.g[k], (ahead.g[k] - behind.g[k]) / (2 * h),
                1e-5 * std::max(scale, std::abs(product.g[k])))
        << "measure " << k;
  }
}

TEST(AssemblyDerivatives, PeriodicCellWithImagesAndMeasures) {
  ModelOptions options = swollen();
  options.free = {true, true, true};
  for (const char* courses : {"g", "ge", "g\ne"}) {
    SCOPED_TRACE(courses);
    const Fabric cell = relax(knitted(courses, "periodic", ""), frictionless()).fabric;
    const Line line = line_through(disturbed(cell, 0.02), options, 3);
    check_line(line);
  }
}

TEST(AssemblyDerivatives, LivelyYarnThatResistsTwist) {
  ModelOptions options = swollen();
  options.free = {true, true, true};
  options.material.twist_stiffness = 20;  // so much that it counts beside the rest
  for (const char* courses : {"g", "ge", "g\ne"}) {
    SCOPED_TRACE(courses);
    Fabric cell = relax(knitted(courses, "periodic", ""), frictionless()).fabric;
    for (FabricYarn& yarn : cell.yarns) yarn.liveliness = 0.2;
    check_line(line_through(disturbed(cell, 0.02), options, 3));
  }
}

TEST(AssemblyDerivatives, EachMeasureByItself) {
  ModelOptions options = swollen();
  options.free = {true, true, true};
  const Fabric cell = relax(knitted("ge\neg", "periodic", ""), frictionless()).fabric;
  Line line = line_through(disturbed(cell, 0.02), options, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    for (Vec3& u : line.direction.u) u = {};
    line.direction.g = {};
    line.direction.g[k] = 1;
    check_line(line);
  }
}

TEST(AssemblyDerivatives, HeldPieceBetweenPlates) {
  RelaxOptions options = frictionless();
  options.most_iterations = 60;
  const Fabric piece = relax(knitted("g", "held", "3 wales x 3 courses"), options).fabric;
  double low = 0, high = 0;
  for (const FabricYarn& yarn : piece.yarns)
    for (const Vec3& p : yarn.control_points) {
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
  ModelOptions model = swollen();
  model.plates = {50, 0.8 * low, 0.8 * high};
  const Line line = line_through(disturbed(piece, 0.02), model, 5);
  Assembly assembly(line.model);
  assembly.update_pairs(line.state, pair_range);
  EXPECT_GT(assembly.energy(line.state).plates, 0.01) << "the plates do not press";
  check_line(line);
}

// Loads on control points, free and held, of a piece and of a cell whose images carry them too.
TEST(AssemblyDerivatives, LoadsOnControlPoints) {
  for (const char* edges : {"periodic", "held"}) {
    SCOPED_TRACE(edges);
    const Fabric fabric =
        relax(knitted("g", edges, edges[0] == 'h' ? "3 wales x 3 courses" : ""), frictionless()).fabric;
    ModelOptions options = swollen();
    Generator random(13);
    const auto nodes = static_cast<std::size_t>(build_yarn_model(fabric, options).nodes);
    for (std::size_t i = 0; i < nodes; ++i)
      options.point_loads.push_back(
          {uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1)});
    check_line(line_through(disturbed(fabric, 0.02), options, 3));
  }
}

// With history: the cloth is moved once and that motion accepted, so contacts carry slip, some slide and some
// stick.
TEST(AssemblyDerivatives, FrictionCountedFromTheLastHessian) {
  for (const char* edges : {"periodic", "held"}) {
    SCOPED_TRACE(edges);
    RelaxOptions options = frictionless();
    const Fabric start =
        relax(knitted("g", edges, edges[0] == 'h' ? "3 wales x 3 courses" : ""), options).fabric;
    ModelOptions model = swollen();
    model.material.friction = 0.3;
    const Line line = line_through(disturbed(start, 0.02), model, 11);
    Assembly assembly(line.model);
    Unknowns gradient, product;
    BlockMatrix hessian;
    assembly.update_pairs(line.state, pair_range);
    assembly.hessian(line.state, gradient, hessian);
    const YarnState next = assembly.moved(line.state, line.direction, 0.012);
    const EnergyParts there = assembly.energy(next);
    EXPECT_GT(there.friction, 1e-3) << "friction does no work in this case";
    // Asked for by segment, the sums are the same, friction's work among them.
    std::vector<double> of_segments;
    EXPECT_EQ(assembly.energy(next, of_segments).total(), there.total());
    EXPECT_NEAR(std::accumulate(of_segments.begin(), of_segments.end(), 0.0),
                there.stretch + there.bend + there.contact, 1e-9 * there.total());
    assembly.accept(next);
    assembly.update_pairs(next, pair_range);
    const EnergyParts parts = assembly.hessian(next, gradient, hessian);
    EXPECT_EQ(parts.friction, 0);
    Unknowns alone;  // without the Hessian: the same forces, to the last bit, those of friction among them
    EXPECT_EQ(assembly.gradient(next, alone).total(), parts.total());
    EXPECT_EQ(alone.u, gradient.u);
    EXPECT_EQ(alone.g, gradient.g);
    multiply(hessian, line.direction, product);
    const auto energy_at = [&](double h) {
      return assembly.energy(assembly.moved(next, line.direction, h)).total();
    };
    const double slope = dot(gradient, line.direction), curve = dot(product, line.direction);
    // Contacts of little load slide on the way: the energy has jumps in its third derivative, so steps are
    // small.
    EXPECT_NEAR(slope, slope_of(energy_at, 2e-5), 2e-6 * std::abs(slope) + 1e-7 * curve);
    const auto slope_at = [&](double h) {
      return slope_of([&](double k) { return energy_at(h + k); }, 1e-4);
    };
    EXPECT_NEAR(curve, slope_of(slope_at, 1e-4), 3e-3 * std::abs(curve));
    // And friction is in both: without it they differ.
    ModelOptions without = model;
    without.material.friction = 0;
    const YarnModel smooth = build_yarn_model(start, without);
    Assembly other(smooth);
    Unknowns smooth_gradient;
    other.update_pairs(next, pair_range);
    other.hessian(next, smooth_gradient, hessian);
    EXPECT_GT(std::abs(dot(smooth_gradient, line.direction) - slope), 1e-2);
  }
}

}  // namespace
}  // namespace loopwright
