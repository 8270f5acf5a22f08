#include <keeler/diagnostics/clusters.hpp>

#include <keeler/cells/grid.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <bit>
#include <cmath>

namespace keeler {
namespace {

Image operator+(const Image& a, const Image& b) {
  return {a.nx + b.nx, a.ny + b.ny};
}

// Union and find (Tarjan 1975) of particles that know which image of them stands beside their cluster's root.
class Unions {
public:
  explicit Unions(std::size_t count) : nodes_(count) {
    for (std::size_t k = 0; k < count; ++k)
      nodes_[k].parent = static_cast<std::uint32_t>(k);
  }

  struct Place {
    std::uint32_t root;
    Image image; // of the particle, next to its root
  };

  Place find(std::uint32_t k) {
    Place place{k, {}};
    while (nodes_[place.root].parent != place.root) {
      place.image = place.image + nodes_[place.root].image;
      place.root = nodes_[place.root].parent;
    }
    for (Image rest = place.image; nodes_[k].parent != k;) { // now all on the way know the root
      const Node old = nodes_[k];
      nodes_[k] = {place.root, rest, old.endless};
      rest = rest + -old.image;
      k = old.parent;
    }
    return place;
  }

  // The image of j touches i. The lower index becomes the root.
  void unite(std::uint32_t i, std::uint32_t j, const Image& image) {
    const Place at_i = find(i), at_j = find(j);
    const Image j_beside_i = at_i.image + image; // j in the frame of i's root
    if (at_i.root == at_j.root) {
      if (!(j_beside_i == at_j.image))
        nodes_[at_i.root].endless = true;
      return;
    }
    const Image root_j = j_beside_i + -at_j.image; // the root of j in that frame
    const auto low = std::min(at_i.root, at_j.root), high = std::max(at_i.root, at_j.root);
    nodes_[low].endless = nodes_[low].endless || nodes_[high].endless;
    nodes_[high] = {low, high == at_j.root ? root_j : -root_j, false};
  }

  bool endless(std::uint32_t root) const { return nodes_[root].endless; }

private:
  struct Node {
    std::uint32_t parent = 0;
    Image image; // beside the parent
    bool endless = false;
  };
  std::vector<Node> nodes_;
};

struct Friend {
  std::uint32_t other;
  Image image;
};

// The friends of each particle that are smaller, or as large and later: each pair stands once.
std::vector<std::vector<Friend>> friends(const Patch& patch, double gap) {
  const std::vector<double>& radii = patch.radii;
  PeriodicGrid grid;
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

// Shape and spin from the members' images next to each other, about the first of them so that nothing cancels.
void measure(Cluster& cluster, const Patch& patch, std::span<const Image> images) {
  const auto place = [&](std::size_t m) -> Vec3 {
    return patch.positions[cluster.members[m]] + patch.box.displacement(images[m], patch.offset);
  };
  const auto velocity = [&](std::size_t m) -> Vec3 {
    return patch.velocities[cluster.members[m]] - Vec3(0.0, patch.box.shear * patch.box.size_x * images[m].nx, 0.0);
  };
  const Vec3 near = place(0), slow = velocity(0);
  Vec3 centre = Vec3::Zero(), drift = Vec3::Zero();
  for (std::size_t m = 0; m < images.size(); ++m) {
    const double share = patch.masses[cluster.members[m]] / cluster.mass;
    centre += share * (place(m) - near);
    drift += share * (velocity(m) - slow);
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double angular_momentum = 0.0, inertia = 0.0;
  for (std::size_t m = 0; m < images.size(); ++m) {
    const std::uint32_t k = cluster.members[m];
    const double share = patch.masses[k] / cluster.mass;
    const Vec3 d = place(m) - near - centre, v = velocity(m) - slow - drift;
    moments += share * (d * d.transpose() + patch.radii[k] * patch.radii[k] / 5.0 * Eigen::Matrix3d::Identity());
    angular_momentum += share * (d.x() * v.y() - d.y() * v.x());
    inertia += share * (d.x() * d.x() + d.y() * d.y());
  }
  const Vec3 principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues(); // rising
  const auto half_axis = [&](int axis) { return std::sqrt(5.0 * std::max(0.0, principal[axis])); };
  cluster.half_axes = {half_axis(2), half_axis(1), half_axis(0)};
  const double r = patch.radii[cluster.members[0]];
  if (inertia > 1e-12 * r * r)
    cluster.spin = 1.0 + angular_momentum / inertia;
}

} // namespace

std::vector<Cluster> find_clusters(const Patch& patch, double gap) {
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
  ClusterAnalysis mean;
  mean.gap = gap;
  const double share = 1.0 / static_cast<double>(patches.size());
  double spinning = 0.0, spin = 0.0;
  std::array<double, 3> axes{};
  int with_axes = 0;
  for (const Patch& patch : patches) {
    const double mass = total_mass(patch);
    const std::vector<Cluster> clusters = find_clusters(patch, gap);
    mean.count += share * static_cast<double>(clusters.size());
    for (const Cluster& cluster : clusters) {
      const double mass_fraction = share * cluster.mass / mass;
      mean.mass_fraction += mass_fraction;
      const auto power = static_cast<std::size_t>(std::bit_width(cluster.members.size())) - 2; // 0: two or three
      while (mean.spectrum.size() <= power)
        mean.spectrum.push_back({std::size_t{2} << mean.spectrum.size(), 0.0, 0.0});
      mean.spectrum[power].count += share;
      mean.spectrum[power].mass_fraction += mass_fraction;
      if (cluster.spin) {
        spinning += mass_fraction;
        spin += mass_fraction * *cluster.spin;
      }
    }
    if (clusters.empty())
      continue;
    mean.largest_mass_fraction += share * clusters[0].mass / mass;
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

} // namespace keeler
