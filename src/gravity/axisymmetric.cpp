#include <keeler/gravity/axisymmetric.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>

#include <fftw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace keeler::gravity {
namespace {

// A B-spline of order 8 spreads particles and interpolates forces, which conserves momentum. Its transform is divided
// out twice; the error left is the alias k - nodes of the shortest wave, (1/11)^8 = 5e-9 of it.
constexpr std::size_t order = 8, nodes_per_wave = 12;

using Weights = std::array<double, order>;

// Returns the weights of nodes first … first + 7 for a position t spacings beyond node first + 7, 0 ≤ t < 1 (Essmann et
// al. 1995). They are shifted down by half a spline; the shifts of spreading and interpolation cancel.
Weights spline_weights(double t) {
  assert(!(t < 0.0) && !(t > 1.0));
  Weights w{};
  w[order - 1] = t;
  w[order - 2] = 1.0 - t;
  for (std::size_t p = 3; p <= order; ++p) {
    const double scale = 1.0 / static_cast<double>(p - 1);
    w[order - p] = scale * (1.0 - t) * w[order - p + 1];
    for (std::size_t j = order - p + 1; j + 1 < order; ++j) {
      const double from_low = static_cast<double>(order - 1 - j); // distance from node j in spacings, less t
      w[j] = scale * ((from_low + t) * w[j] + (static_cast<double>(p) - from_low - t) * w[j + 1]);
    }
    w[order - 1] *= scale * t;
  }
  return w;
}

// The nodes of one particle and their weights.
struct Stencil {
  std::size_t first; // modulo the number of nodes
  Weights weights;
};

// Frees memory and plans of FFTW.
struct Free {
  void operator()(void* memory) const { fftw_free(memory); }
  void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
};
template<class T> using Owned = std::unique_ptr<T, Free>;

template<class T> T* require(T* allocated) {
  if (allocated == nullptr)
    throw std::bad_alloc();
  return allocated;
}

double waves_in(double size_x, double shortest_wavelength) {
  return std::floor(size_x / shortest_wavelength * (1.0 + 1e-12));
}

} // namespace

double radial_mesh_nodes(double size_x, double shortest_wavelength) {
  const double min_nodes =
      std::max(static_cast<double>(nodes_per_wave) * waves_in(size_x, shortest_wavelength), 2.0 * order);
  return std::exp2(std::ceil(std::log2(min_nodes)));
}

std::string radial_mesh_fault(double size_x, double shortest_wavelength) {
  constexpr double max_nodes = 0x1p27; // 10⁷ waves, of 1 m in the widest box allowed
  const double nodes = radial_mesh_nodes(size_x, shortest_wavelength);
  const bool too_long = !(waves_in(size_x, shortest_wavelength) >= 1.0);
  if (!too_long && nodes <= max_nodes)
    return {};
  const std::string begin =
                        fmt::format("gravity.shortest_wavelength = {} m is ", format_number(shortest_wavelength, 4)),
                    width = format_number(size_x, 4);
  if (too_long)
    return fmt::format("{}longer than the box is wide ({} m: no wave is left); shorten it", begin, width);
  return fmt::format(
      "{}too short (in a box that is {} m wide it needs a mesh of {} nodes, and at most {} are allowed); raise it",
      begin, width, format_number(nodes, 3), format_number(max_nodes, 3));
}

// The sums, the waves and the plans of FFTW; and a mesh of integers per thread.
double radial_mesh_bytes(double size_x, double shortest_wavelength, int threads) {
  return radial_mesh_nodes(size_x, shortest_wavelength) * (32.0 + 8.0 * threads);
}

struct AxisymmetricSolver::Mesh {
  explicit Mesh(double wavelength) : shortest_wavelength(wavelength) {}

  void prepare(const ShearingBox& box);
  Stencil stencil_at(double x, double length) const;
  void spread(const GravityProblem& problem);
  void transform(const GravityProblem& problem);
  double spline_transform(std::size_t n) const;

  double shortest_wavelength;
  std::size_t modes = 0, nodes = 0;
  std::vector<std::vector<std::int64_t>> fixed; // per thread: a mesh in fixed point
  Owned<double[]> real;                         // nodes
  Owned<fftw_complex[]> waves;                  // nodes / 2 + 1
  Owned<fftw_plan_s> forward, backward;
};

void AxisymmetricSolver::Mesh::prepare(const ShearingBox& box) {
  const double waves_in_box = waves_in(box.size_x, shortest_wavelength);
  assert(shortest_wavelength > 0.0 && box.size_x > 0.0);
  if (static_cast<double>(modes) == waves_in_box && modes > 0)
    return;
  if (const std::string fault = radial_mesh_fault(box.size_x, shortest_wavelength); !fault.empty())
    throw UsageError(fault);
  modes = 0; // not valid until all is allocated
  const double nodes_needed = radial_mesh_nodes(box.size_x, shortest_wavelength);
  require_memory(radial_mesh_bytes(box.size_x, shortest_wavelength, threads()),
                 fmt::format("a mesh of {} nodes", format_number(nodes_needed, 4)),
                 "raise gravity.shortest_wavelength");
  nodes = static_cast<std::size_t>(nodes_needed);
  real.reset(require(fftw_alloc_real(nodes)));
  waves.reset(require(fftw_alloc_complex(nodes / 2 + 1)));
  const auto size = static_cast<int>(nodes);
  forward.reset(require(fftw_plan_dft_r2c_1d(size, real.get(), waves.get(), FFTW_ESTIMATE)));
  backward.reset(require(fftw_plan_dft_c2r_1d(size, waves.get(), real.get(), FFTW_ESTIMATE)));
  modes = static_cast<std::size_t>(waves_in_box);
}

Stencil AxisymmetricSolver::Mesh::stencil_at(double x, double length) const {
  const double turns = x / length, at = (turns - std::floor(turns)) * static_cast<double>(nodes);
  const auto node = static_cast<std::size_t>(at); // may be `nodes`, by rounding
  return {node + nodes - (order - 1), spline_weights(at - static_cast<double>(node))};
}

// Spreads the masses in fixed point: sums of integers have the same bits in any order and on any number of threads and
// ranks.
void AxisymmetricSolver::Mesh::spread(const GravityProblem& problem) {
  const std::size_t count = problem.positions.size();
  const double largest = largest_of(count, [&](std::size_t k) { return problem.masses[k]; });
  const double max_total = problem.ranks.max(largest) * static_cast<double>(problem.ranks.sum(count));
  const int exponent = 61 - std::ilogb(max_total); // no node has more than half of the total
  const double unit = std::ldexp(1.0, exponent), length = problem.box.size_x;
  fixed.resize(static_cast<std::size_t>(threads()));
  for (std::vector<std::int64_t>& mesh : fixed)
    mesh.assign(nodes, 0);
  parallel_for(count, [&](std::size_t k) {
    std::vector<std::int64_t>& mesh = fixed[static_cast<std::size_t>(omp_get_thread_num())];
    const Stencil stencil = stencil_at(problem.positions[k].x(), length);
    for (std::size_t j = 0; j < order; ++j)
      mesh[(stencil.first + j) & (nodes - 1)] += std::llrint(problem.masses[k] * unit * stencil.weights[j]);
  });
  std::vector<std::int64_t>& sums = fixed.front();
  for (std::size_t thread = 1; thread < fixed.size(); ++thread)
    for (std::size_t i = 0; i < nodes; ++i)
      sums[i] += fixed[thread][i];
  problem.ranks.sum(std::span(reinterpret_cast<std::uint64_t*>(sums.data()), nodes)); // the ranks' sums, modulo 2⁶⁴
  for (std::size_t i = 0; i < nodes; ++i)
    real[i] = std::ldexp(static_cast<double>(sums[i]), -exponent);
}

// Returns the transform of the spline at wave n ≥ 1.
double AxisymmetricSolver::Mesh::spline_transform(std::size_t n) const {
  assert(n >= 1 && n <= nodes / 2);
  const double half = pi * static_cast<double>(n) / static_cast<double>(nodes);
  return std::pow(std::sin(half) / half, static_cast<double>(order));
}

// Sets waves[n] to S_n × area, up to the phase of half a spline.
void AxisymmetricSolver::Mesh::transform(const GravityProblem& problem) {
  problem.ranks.together([&] {
    if (!std::all_of(problem.positions.begin(), problem.positions.end(), [](const Vec3& p) { return p.allFinite(); }))
      throw InvariantError("the position of a particle is not finite; take a shorter time.step");
    prepare(problem.box);
  });
  spread(problem);
  fftw_execute(forward.get());
  for (std::size_t n = 1; n <= modes; ++n)
    for (double& part : waves[n])
      part /= spline_transform(n);
}

AxisymmetricSolver::AxisymmetricSolver(double shortest_wavelength)
    : mesh_(std::make_unique<Mesh>(shortest_wavelength)) {}

AxisymmetricSolver::~AxisymmetricSolver() = default;

void AxisymmetricSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const std::size_t count = problem.positions.size();
  assert(accelerations.size() == count && problem.masses.size() == count);
  if (problem.ranks.sum(count) == 0)
    return;
  Mesh& mesh = *mesh_;
  mesh.transform(problem);
  const double pull = two_pi * problem.newton_g / problem.box.area();
  mesh.waves[0][0] = mesh.waves[0][1] = 0.0;
  for (std::size_t n = 1; n <= mesh.nodes / 2; ++n) {
    fftw_complex& wave = mesh.waves[n];
    const double factor = n <= mesh.modes ? pull / mesh.spline_transform(n) : 0.0;
    const double re = wave[0], im = wave[1];
    wave[0] = -factor * im; // g_n = 2π i G S_n
    wave[1] = factor * re;
  }
  fftw_execute(mesh.backward.get());
  parallel_for(count, [&](std::size_t k) {
    const Stencil stencil = mesh.stencil_at(problem.positions[k].x(), problem.box.size_x);
    double g = 0.0;
    for (std::size_t j = 0; j < order; ++j)
      g += stencil.weights[j] * mesh.real[(stencil.first + j) & (mesh.nodes - 1)];
    accelerations[k] = Vec3(g, 0.0, 0.0);
  });
}

// Sums ½ ∫ Σ Φ dA wave by wave.
GravityEnergy AxisymmetricSolver::energy(const GravityProblem& problem) {
  if (problem.ranks.sum(problem.positions.size()) == 0)
    return {};
  Mesh& mesh = *mesh_;
  mesh.transform(problem);
  double sum = 0.0;
  for (std::size_t n = 1; n <= mesh.modes; ++n) {
    const double re = mesh.waves[n][0], im = mesh.waves[n][1];
    sum += (re * re + im * im) / static_cast<double>(n);
  }
  return {-problem.newton_g * problem.box.size_x / problem.box.area() * sum, 0.0};
}

} // namespace keeler::gravity
