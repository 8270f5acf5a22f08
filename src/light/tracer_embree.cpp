#include "tracer.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/light/photometry.hpp>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <limits>

namespace keeler::light {
namespace {

// A ray whose direction is this near to the plane stays in the layer for longer than any ring is wide.
constexpr int max_crossings = 1000000;

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

// Follows a ray through the cells. try_segment(origin, length) returns true when the ray ends in that segment.
template<class TrySegment>
bool follow(const SphereCell& cell, const Vec3& origin, const Vec3& direction, const TrySegment& try_segment) {
  Vec3 point = cell.inside(origin);
  for (int crossing = 0; crossing < max_crossings; ++crossing) {
    bool leaves_layer = false;
    const double way = cell.way_out(point, direction, leaves_layer);
    if (try_segment(point, way + cell.margin()))
      return true;
    if (leaves_layer || interrupted())
      return false;
    point = cell.across(point, direction, way);
  }
  return false;
}

void set(RTCRay& ray, const Vec3& origin, const Vec3& direction, double length) {
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = 0.0f;
  ray.tfar = static_cast<float>(length);
  ray.time = 0.0f;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
}

} // namespace

bool can_trace() {
  return true;
}

void require_tracer() {}

struct Tracer::Scene {
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene> scene;
};

Tracer::Tracer(const Patch& patch) {
  if (patch.size() == 0)
    throw UsageError("the patch has no particles, so there is nothing that scatters light; take another state");
  cell_ = std::make_unique<SphereCell>(patch);
  scene_ = std::make_unique<Scene>();
  scene_->device.reset(rtcNewDevice(fmt::format("threads={},set_affinity=0", threads()).c_str()));
  if (!scene_->device)
    throw Error(ExitCode::run_time, "Embree does not start on this machine; look whether its library is whole");
  RTCDevice device = scene_->device.get();
  scene_->scene.reset(rtcNewScene(device));
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  const std::vector<CellSphere>& spheres = cell_->spheres();
  auto* const buffer = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), spheres.size()));
  if (buffer)
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis)
        buffer[4 * k + static_cast<std::size_t>(axis)] = static_cast<float>(spheres[k].centre[axis]);
      buffer[4 * k + 3] = static_cast<float>(spheres[k].radius);
    }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(scene_->scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcCommitScene(scene_->scene.get());
  const RTCError fault = rtcGetDeviceError(device);
  if (!buffer || fault == RTC_ERROR_OUT_OF_MEMORY)
    throw UsageError(no_memory);
  if (fault != RTC_ERROR_NONE)
    throw Error(ExitCode::run_time, fmt::format("Embree reports the error {} for this patch", static_cast<int>(fault)));
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

std::optional<Hit> Tracer::first_hit(const Vec3& origin, const Vec3& direction) const {
  std::optional<Hit> hit;
  follow(*cell_, origin, direction, [&](const Vec3& point, double length) {
    RTCRayHit query;
    set(query.ray, point, direction, length);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_->scene.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
      return false;
    // The sphere is Embree's; the point on it is that of double precision.
    const CellSphere& sphere = cell_->spheres()[query.hit.primID];
    const Vec3 to = sphere.centre - point;
    const double closest = to.dot(direction);
    const double depth2 = sphere.radius * sphere.radius - (to.squaredNorm() - closest * closest);
    const Vec3 met = point + std::max(0.0, closest - std::sqrt(std::max(0.0, depth2))) * direction;
    const Vec3 normal = (met - sphere.centre).normalized();
    hit = Hit{sphere.centre + sphere.radius * normal, normal, sphere.radius, sphere.particle};
    return true;
  });
  return hit;
}

bool Tracer::blocked(const Vec3& origin, const Vec3& direction) const {
  return follow(*cell_, origin, direction, [&](const Vec3& point, double length) {
    RTCRay ray;
    set(ray, point, direction, length);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_->scene.get(), &context, &ray);
    return ray.tfar < 0.0f;
  });
}

std::size_t Tracer::count_blocked_in_cell(std::span<const Vec3> origins, const Vec3& direction, bool in_packets) const {
  constexpr std::size_t packet = 16;
  constexpr float endless = std::numeric_limits<float>::infinity();
  const RTCScene scene = scene_->scene.get();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  std::size_t blocked = 0;
  if (!in_packets) {
    for (const Vec3& origin : origins) {
      RTCRay ray;
      set(ray, origin, direction, std::numeric_limits<double>::infinity());
      rtcOccluded1(scene, &context, &ray);
      blocked += ray.tfar < 0.0f ? 1 : 0;
    }
    return blocked;
  }
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const auto x = static_cast<float>(direction.x()), y = static_cast<float>(direction.y()),
             z = static_cast<float>(direction.z());
  for (std::size_t first = 0; first < origins.size(); first += packet) {
    alignas(64) int valid[packet];
    RTCRay16 rays;
    for (std::size_t k = 0; k < packet; ++k) {
      const bool is_one = first + k < origins.size();
      const Vec3& origin = origins[is_one ? first + k : first];
      valid[k] = is_one ? -1 : 0;
      rays.org_x[k] = static_cast<float>(origin.x());
      rays.org_y[k] = static_cast<float>(origin.y());
      rays.org_z[k] = static_cast<float>(origin.z());
      rays.dir_x[k] = x, rays.dir_y[k] = y, rays.dir_z[k] = z;
      rays.tnear[k] = 0.0f, rays.tfar[k] = endless, rays.time[k] = 0.0f;
      rays.mask[k] = ~0u, rays.id[k] = 0, rays.flags[k] = 0;
    }
    rtcOccluded16(valid, scene, &context, &rays);
    for (std::size_t k = 0; k < packet; ++k)
      blocked += valid[k] != 0 && rays.tfar[k] < 0.0f ? 1 : 0;
  }
  return blocked;
}

} // namespace keeler::light
