// The first paper's two claims, measured: that its improved net fits knitted cloth better than the
// traditional one (section 3.3), and that Verlet allows larger steps and is more accurate than Euler's
// methods (4.4). Prints the tables of results.txt; docs/loop_scale.md says what they mean.
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "loop_scale/integrators.hpp"
#include "loop_scale/loop_model.hpp"
#include "loop_scale/settle.hpp"

namespace loopwright {
namespace {

constexpr std::array<Integrator, 4> methods{Integrator::verlet, Integrator::semi_implicit_euler,
                                            Integrator::explicit_euler, Integrator::implicit_euler};

// 12 x 12 loops of acrylic plain: K_weft 238, K_warp 680 N/m, 5.7 mg a loop, w 2.80, c 2.12 mm; lengths in
// mm. Clamped at the bottom, pulled by 10 %, let go.
struct Release {
  MassSpringNet net;
  NetState state;
};
Release released(double damping_ratio) {
  constexpr int side = 12;
  constexpr double w = 2.80, c = 2.12, mass = 5.7e-6;
  Release release;
  MassSpringNet& net = release.net;
  net.mass.assign(side * side, mass);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const int k = i * side + j;
      if (j + 1 < side) net.springs.push_back({k, k + 1, 238, {w, 0, 0}, SpringKind::weft});
      if (i + 1 < side) net.springs.push_back({k, k + side, 680, {0, c, 0}, SpringKind::warp});
    }
  net.clamps.emplace_back();
  for (int j = 0; j < side; ++j) net.clamps[0].masses.push_back(j);
  net.damping = damping_ratio * settling_damping(net);
  std::vector<Vec3> places = grid_places(side, side, w, c);
  for (Vec3& p : places) p.y *= 1.1;
  release.state = state_at_rest(places);
  return release;
}

double energy_of(const NetKernel& kernel, const NetState& state) {
  const NetEnergy e = kernel.energy(state);
  return e.kinetic + e.springs;
}

// Whether a run of 0.02 s (a dozen slow swings) stays below four times the energy that it starts with.
bool is_stable(const Release& release, Integrator method, double h) {
  const NetKernel kernel(release.net);
  NetState state = release.state;
  const double start = energy_of(kernel, state);
  const int steps = static_cast<int>(std::ceil(0.02 / h));
  for (int done = 0; done < steps; done += 20) {
    integrate(release.net, kernel, method, h, std::min(20, steps - done), state);
    if (!(energy_of(kernel, state) < 4 * start)) return false;
  }
  return true;
}

void print_steps(double damping) {
  const Release release = released(damping);
  const NetKernel kernel(release.net);
  const double bound = kernel.stable_step();
  std::printf("damping %.2g of that which settles fast; bound 2/omega = %.3g s\n", damping, bound);
  std::printf(
      "  method               largest stable step   error after 5 ms at 0.25    at 0.025    energy after 20 "
      "ms  "
      "evaluations\n");
  const double time = 5e-3;
  const auto run = [&](Integrator method, double h, double until, long long* evaluations) {
    NetState state = release.state;
    const int steps = static_cast<int>(std::lround(until / h));
    integrate(release.net, kernel, method, until / steps, steps, state, evaluations);
    return state;
  };
  const NetState exact = run(Integrator::verlet, bound / 400, time, nullptr);
  for (const Integrator method : methods) {
    double low = 0.02, high = 1;
    const bool always = method == Integrator::implicit_euler && is_stable(release, method, 20 * bound);
    const bool never = !is_stable(release, method, low * bound);
    while (is_stable(release, method, high * bound) && high < 4) high *= 1.5;
    for (int k = 0; k < 9 && !always && !never; ++k) {
      const double middle = std::sqrt(low * high);
      (is_stable(release, method, middle * bound) ? low : high) = middle;
    }
    const auto error = [&](double share, long long* evaluations) {
      const NetState state = run(method, share * bound, time, evaluations);
      double sum = 0, scale = 0;
      for (std::size_t i = 0; i < state.size(); ++i) {
        sum += squared_norm(state.position(i) - exact.position(i));
        scale += squared_norm(exact.position(i) - release.state.position(i));
      }
      return std::sqrt(sum / scale);
    };
    long long evaluations = 0;
    const double coarse = error(0.25, &evaluations), fine = error(0.025, nullptr);
    const double kept =
        energy_of(kernel, run(method, 0.25 * bound, 0.02, nullptr)) / energy_of(kernel, release.state);
    char largest[32];
    if (always)
      std::snprintf(largest, sizeof largest, "> 20");
    else if (never)
      std::snprintf(largest, sizeof largest, "< 0.02");
    else
      std::snprintf(largest, sizeof largest, "%.3f", low);
    std::printf("  %-20s %12s of it   %22.2e  %10.2e  %16.3g  %12lld\n", name_of(method).data(), largest,
                coarse, fine, kept, evaluations);
  }
}

// Acrylic plain as measured by Singal et al., Nature Communications 15, 2622 (2024), raw data reduced: strain
// at stress (N/mm) along the course and the wale; transverse strain at a strain of 0.2.
struct Measured {
  double stress, course, wale;
};
constexpr std::array<Measured, 4> plain_measured{
    {{0.02, .046, .036}, {0.05, .143, .086}, {0.1, .266, .142}, {0.2, .393, .229}}};
constexpr double transverse_course = -.064, transverse_wale = -.108;
constexpr double Y_course = 0.314, Y_wale = 0.515;  // initial stiffness, N/mm

struct Answer {
  double strain = 0, transverse = 0;
};

// A piece of n x n masses pulled at two opposite borders, free to narrow there; measured between the masses
// of its inside.
Answer pulled(MassSpringNet net, const std::vector<Vec3>& places, int side, bool along_course, double force) {
  Load load, back;
  for (int k = 0; k < side; ++k) {
    load.masses.push_back(along_course ? k * side + side - 1 : (side - 1) * side + k);
    back.masses.push_back(along_course ? k * side : k);
  }
  const Vec3 way = along_course ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  load.force = way * (force / side);
  back.force = way * (-force / side);
  load.factor =
      back.factor = {{0, 0}, {0.05, 1}};  // slowly: a net without shear stiffness folds under a jerk
  net.loads = {load, back};
  net.damping = settling_damping(net);
  NetKernel kernel(net);
  NetState state = state_at_rest(places);
  SettleOptions options;
  options.tolerance = 1e-5;
  settle(kernel, net, state, options);
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * side + j); };
  const int low = side / 4, high = side - 1 - side / 4, mid = side / 2;
  const double x = distance(state.position(at(mid, high)), state.position(at(mid, low))) /
                       distance(places[at(mid, high)], places[at(mid, low)]) -
                   1;
  const double y = distance(state.position(at(high, mid)), state.position(at(low, mid))) /
                       distance(places[at(high, mid)], places[at(low, mid)]) -
                   1;
  return along_course ? Answer{x, y} : Answer{y, x};
}

void print_fit() {
  constexpr int side = 16;
  constexpr double w = 2.80, c = 2.12, mass = 5.7e-6;
  const GridStiffness k = stiffness_of_fabric(Y_course, Y_wale, w, c);
  // improved: masses at binding points, one constant for each direction
  MassSpringNet improved;
  improved.mass.assign(side * side, mass);
  const double rho = 0.43;  // mean of the measured transverse strains at 0.2
  MassSpringNet coupled;
  coupled.mass = improved.mass;
  std::vector<int> wefts(side * side, -1);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const int m = i * side + j;
      if (j + 1 < side) {
        wefts[static_cast<std::size_t>(m)] = static_cast<int>(improved.springs.size());
        improved.springs.push_back({m, m + 1, k.weft, {w, 0, 0}, SpringKind::weft});
      }
      if (i + 1 < side) improved.springs.push_back({m, m + side, k.warp, {0, c, 0}, SpringKind::warp});
    }
  coupled.springs = improved.springs;
  for (Spring& s : coupled.springs) s.stiffness /= 1 + rho;
  for (std::size_t s = 0; s < coupled.springs.size(); ++s) {
    const Spring& warp = coupled.springs[s];
    if (warp.kind != SpringKind::warp) continue;
    std::vector<int> beside;
    if (warp.a % side > 0) beside.push_back(wefts[static_cast<std::size_t>(warp.a) - 1]);
    if (wefts[static_cast<std::size_t>(warp.a)] >= 0)
      beside.push_back(wefts[static_cast<std::size_t>(warp.a)]);
    for (const int weft : beside)
      coupled.couplings.push_back({static_cast<std::int32_t>(s), weft,
                                   rho * k.warp / (1 - rho * rho) / static_cast<double>(beside.size()),
                                   std::sqrt(k.weft / k.warp)});
  }
  // a net of weft and warp springs alone may shear freely; without any shear stiffness it does so when it
  // narrows
  for (int i = 0; i + 1 < side; ++i)
    for (int j = 0; j + 1 < side; ++j) {
      const int m = i * side + j;
      coupled.springs.push_back({m, m + side + 1, 0.02 * k.weft, {w, c, 0}, SpringKind::shear});
      coupled.springs.push_back({m + 1, m + side, 0.02 * k.weft, {-w, c, 0}, SpringKind::shear});
    }
  // traditional: uniform distances and one structural constant; structural and diagonal springs k and s give
  // C11 = k + s, C12 = s on a square grid: fitted to the mean stiffness and the mean transverse strain
  const double spacing = std::sqrt(w * c), Y = (Y_course + Y_wale) / 2, C11 = Y / (1 - rho * rho);
  const MassSpringNet traditional =
      traditional_net(side, side, spacing, spacing, mass, {C11 * (1 - rho), C11 * rho, 0.01 * C11});
  struct Net {
    const char* name;
    const MassSpringNet* net;
    double wide, high;
  };
  const std::array<Net, 3> nets{{{"improved (paper)", &improved, w, c},
                                 {"improved, coupled", &coupled, w, c},
                                 {"traditional", &traditional, spacing, spacing}}};
  std::printf(
      "\nacrylic plain: strain under a stress along the course / the wale; stiffness from the initial "
      "slopes\n");
  std::printf("  %-20s", "N/mm");
  for (const Measured& m : plain_measured) std::printf("        %.2f      ", m.stress);
  std::printf("   transverse at strain about 0.2\n  %-20s", "measured");
  for (const Measured& m : plain_measured) std::printf("  %6.3f / %6.3f  ", m.course, m.wale);
  std::printf("   %6.3f / %6.3f\n", transverse_course, transverse_wale);
  for (const Net& net : nets) {
    const std::vector<Vec3> places = grid_places(side, side, net.wide, net.high);
    std::printf("  %-20s", net.name);
    double error = 0;
    int terms = 0;
    for (const Measured& m : plain_measured) {
      const Answer x = pulled(*net.net, places, side, true, m.stress * net.high * side);
      const Answer y = pulled(*net.net, places, side, false, m.stress * net.wide * side);
      std::printf("  %6.3f / %6.3f  ", x.strain, y.strain);
      if (m.stress > 0.11) continue;
      error += std::pow(std::log(x.strain / m.course), 2) + std::pow(std::log(y.strain / m.wale), 2);
      terms += 2;
    }
    const Answer x = pulled(*net.net, places, side, true, 0.2 * Y_course * net.high * side);
    const Answer y = pulled(*net.net, places, side, false, 0.2 * Y_wale * net.wide * side);
    std::printf("   %6.3f / %6.3f   mean factor of error up to 0.1 N/mm: %.2f\n",
                x.transverse / x.strain * 0.2, y.transverse / y.strain * 0.2,
                std::exp(std::sqrt(error / terms)));
  }
  // Bias cut: does shear come out of weft and warp springs, as the paper says?
  std::printf("\nforce that shears the net by 0.02, over what the traditional net needs: ");
  const auto shear_energy = [](const MassSpringNet& net, const std::vector<Vec3>& places) {
    std::vector<Vec3> sheared = places;
    for (Vec3& p : sheared) p.x += 0.02 * p.y;
    return NetKernel(net).energy(state_at_rest(sheared)).springs;
  };
  const double free = shear_energy(improved, grid_places(side, side, w, c));
  const double firm = shear_energy(traditional, grid_places(side, side, spacing, spacing));
  std::printf("%.1e\n", free / firm);
}

}  // namespace
}  // namespace loopwright

int main() {
  std::printf("12 x 12 loops of acrylic plain, clamped at the bottom, stretched by 10 %% and let go\n");
  loopwright::print_steps(0);
  loopwright::print_steps(0.1);
  loopwright::print_fit();
}
