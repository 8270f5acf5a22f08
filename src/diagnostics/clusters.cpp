#include <keeler/diagnostics/clusters.hpp>

#include <keeler/cells/grid.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace keeler::diagnostics {
namespace {

Image operator+(const Image& a, const Image& b) {
  return {a.nx + b.nx, a.ny + b.ny};
}

// Union-find (Tarjan 1975) of particles, which stores the image of each that is adjacent to its cluster's root.
class Unions {
public:
  explicit Unions(std::size_t count) : nodes_(count) {
    for (std::size_t k = 0; k < count; ++k)
      nodes_[k].parent = static_cast<std::uint32_t>(k);
  }

  struct RootImage {
    std::uint32_t root;
    Image image; // of the particle, adjacent to its root
  };

  RootImage find(std::uint32_t k) {
    RootImage found{k, {}};
    while (nodes_[found.root].parent != found.root) {
      found.image = found.image + nodes_[found.root].image;
      found.root = nodes_[found.root].parent;
    }
    for (Image rest = found.image; nodes_[k].parent != k;) { // path compression
      const Node old = nodes_[k];
      nodes_[k] = {found.root, rest, old.endless};
      rest = rest + -old.image;
      k = old.parent;
    }
    return found;
  }

  // Joins i and the image of j, which touches it. The lower index becomes the root.
  void unite(std::uint32_t i, std::uint32_t j, const Image& image) {
    const RootImage at_i = find(i), at_j = find(j);
    const Image image_of_j = at_i.image + image; // j in the frame of i's root
    if (at_i.root == at_j.root) {
      if (!(image_of_j == at_j.image))
        nodes_[at_i.root].endless = true;
      return;
    }
    const Image root_j = image_of_j + -at_j.image; // the root of j in that frame
    const auto low = std::min(at_i.root, at_j.root), high = std::max(at_i.root, at_j.root);
    nodes_[low].endless = nodes_[low].endless || nodes_[high].endless;
    nodes_[high] = {low, high == at_j.root ? root_j : -root_j, false};
  }

  bool endless(std::uint32_t root) const { return nodes_[root].endless; }

private:
  struct Node {
    std::uint32_t parent = 0;
    Image image; // adjacent to the parent
    bool endless = false;
  };
  std::vector<Node> nodes_;
};

struct Friend {
  std::uint32_t other;
  Image image;
};

// Returns the friends of each particle that are smaller, or equal and later: each pair appears once.
std::vector<std::vector<Friend>> friends(const Patch& patch, double gap) {
  const std::vector<double>& radii = patch.radii;
  cells::PeriodicGrid grid;
  grid.build(patch.positions, patch.box, patch.offset, 2.0 * mean_radius(patch));
  std::vector<std::vector<Friend>> friends(patch.size());
  parallel_for(patch.size(), [&](std::size_t i) {
    const double reach = 2.0 * radii[i] * (1.0 + gap);
    grid.visit_near(patch.positions[i], reach, reach, [&](std::size_t j, const Image& image) {
      if (radii[j] > radii[i] || (radii[j] == radii[i] && j < i) || (i == j && image == Image{}))
        return;
      const Vec3 d = patch.positions[j] + patch.box.displacement(image, patch.offset) - patch.positions[i];
      const double limit = (radii[i] + radii[j]) * (1.0 + gap);
      if (d.squaredNorm() <= limit * limit)
        friends[i].push_back({static_cast<std::uint32_t>(j), image});
    });
  });
  return friends;
}

// Measures shape and spin from the members' adjacent images, relative to the first member to avoid cancellation.
void measure(Cluster& cluster, const Patch& patch, std::span<const Image> images) {
  const auto position = [&](std::size_t m) -> Vec3 {
    return patch.positions[cluster.members[m]] + patch.box.displacement(images[m], patch.offset);
  };
  const auto velocity = [&](std::size_t m) -> Vec3 {
    return patch.velocities[cluster.members[m]] - Vec3(0.0, patch.box.shear * patch.box.size_x * images[m].nx, 0.0);
  };
  const Vec3 reference = position(0), reference_velocity = velocity(0);
  Vec3 centre = Vec3::Zero(), drift = Vec3::Zero();
  for (std::size_t m = 0; m < images.size(); ++m) {
    const double fraction = patch.masses[cluster.members[m]] / cluster.mass;
    centre += fraction * (position(m) - reference);
    drift += fraction * (velocity(m) - reference_velocity);
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double angular_momentum = 0.0, inertia = 0.0;
  for (std::size_t m = 0; m < images.size(); ++m) {
    const std::uint32_t k = cluster.members[m];
    const double fraction = patch.masses[k] / cluster.mass;
    const Vec3 d = position(m) - reference - centre, v = velocity(m) - reference_velocity - drift;
    moments += fraction * (d * d.transpose() + patch.radii[k] * patch.radii[k] / 5.0 * Eigen::Matrix3d::Identity());
    angular_momentum += fraction * (d.x() * v.y() - d.y() * v.x());
    inertia += fraction * (d.x() * d.x() + d.y() * d.y());
  }
  const Vec3 principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues(); // ascending
  const auto half_axis = [&](int axis) { return std::sqrt(5.0 * std::max(0.0, principal[axis])); };
  cluster.half_axes = {half_axis(2), half_axis(1), half_axis(0)};
  const double r = patch.radii[cluster.members[0]];
  if (inertia > 1e-12 * r * r)
    cluster.spin = 1.0 + angular_momentum / inertia;
}

} // namespace

std::vector<Cluster> find_clusters(const Patch& patch, double gap) {
  assert(gap >= 0.0);
  if (patch.size() == 0)
    return {};
  Unions unions(patch.size());
  const std::vector<std::vector<Friend>> all = friends(patch, gap);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const Friend& f : all[i])
      unions.unite(static_cast<std::uint32_t>(i), f.other, f.image);

  std::vector<Cluster> clusters;
  std::vector<std::vector<Image>> images; // of the members of each
  std::vector<std::uint32_t> sizes(patch.size(), 0), cluster_of(patch.size(), 0);
  for (std::uint32_t k = 0; k < patch.size(); ++k)
    ++sizes[unions.find(k).root];
  for (std::uint32_t k = 0; k < patch.size(); ++k) {
    const auto [root, image] = unions.find(k);
    if (sizes[root] < 2)
      continue;
    if (root == k) { // roots have the lowest index of their cluster
      cluster_of[k] = static_cast<std::uint32_t>(clusters.size());
      clusters.emplace_back();
      images.emplace_back();
    }
    Cluster& cluster = clusters[cluster_of[root]];
    cluster.members.push_back(k);
    cluster.mass += patch.masses[k];
    images[cluster_of[root]].push_back(image);
  }
  parallel_for(
      clusters.size(),
      [&](std::size_t c) {
        if (!unions.endless(clusters[c].members[0]))
          measure(clusters[c], patch, images[c]);
      },
      16);
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.mass > b.mass; });
  return clusters;
}

ClusterAnalysis analyze_clusters(std::span<const Patch> patches, double gap) {
  assert(!patches.empty());
  ClusterAnalysis mean;
  mean.gap = gap;
  const double weight = 1.0 / static_cast<double>(patches.size());
  double spinning = 0.0, spin = 0.0;
  std::array<double, 3> axes{};
  int with_axes = 0;
  for (const Patch& patch : patches) {
    const double mass = total_mass(patch);
    const std::vector<Cluster> clusters = find_clusters(patch, gap);
    mean.count += weight * static_cast<double>(clusters.size());
    for (const Cluster& cluster : clusters) {
      const double mass_fraction = weight * cluster.mass / mass;
      mean.mass_fraction += mass_fraction;
      const auto power = static_cast<std::size_t>(std::bit_width(cluster.members.size())) - 2; // 0: two or three
      while (mean.spectrum.size() <= power)
        mean.spectrum.push_back({std::size_t{2} << mean.spectrum.size(), 0.0, 0.0});
      mean.spectrum[power].count += weight;
      mean.spectrum[power].mass_fraction += mass_fraction;
      if (cluster.spin) {
        spinning += mass_fraction;
        spin += mass_fraction * *cluster.spin;
      }
    }
    if (clusters.empty())
      continue;
    mean.largest_mass_fraction += weight * clusters[0].mass / mass;
    if (clusters[0].half_axes) {
      ++with_axes;
      for (std::size_t axis = 0; axis < 3; ++axis)
        axes[axis] += (*clusters[0].half_axes)[axis];
    }
  }
  if (spinning > 0.0)
    mean.spin = spin / spinning;
  if (with_axes > 0)
    mean.largest_half_axes = {axes[0] / with_axes, axes[1] / with_axes, axes[2] / with_axes};
  return mean;
}

} // namespace keeler::diagnostics
