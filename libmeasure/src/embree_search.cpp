// Embree as a search structure that culls in float32 and never culls too much; the argument is in
// docs/algorithms/distances.md, "Embree".
#include <embree3/rtcore.h>
#include <kaboum/geom/error.h>
#include <kaboum/geom/spatial_order.h>
#include <kaboum/measure/search.h>

#include <cmath>

namespace kaboum::measure {
namespace {

using geom::Vec3;

/// The next float32 number below (above) x's nearest one: a bound that rounding cannot cross.
float below(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

// Query points are clamped to this distance from the origin of the scaled coordinates, in which the
// mesh lies within [−1, 1]³.
constexpr double kFarthest = 1e6;
// No radius is smaller than this, so that its square is a normal float32 number.
constexpr double kSmallestRadius = 0x1p-60;
// Relative allowance for Embree's float32 arithmetic: subtraction, squares, sums, the square of the
// radius; less than 16 roundings of 2^-24 each.
constexpr double kTraversal = 1 + 0x1p-20;

// Triangles, neighbours in spatial order, that share a primitive: fewer to build with, and to visit.
constexpr std::size_t kGroup = 4;

[[noreturn]] void fail(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  throw Error(error == RTC_ERROR_OUT_OF_MEMORY ? ErrorCode::LimitReached : ErrorCode::Internal,
              std::string("Embree: ") + what + " (error " + std::to_string(error) + ")");
}

class EmbreeSearch final : public geom::TriangleSearch {
 public:
  explicit EmbreeSearch(const geom::Mesh& mesh) : EmbreeSearch(mesh, geom::spatial_order(mesh)) {}

  EmbreeSearch(const geom::Mesh& mesh, std::vector<std::uint32_t> order)
      : TriangleSearch(mesh, order), order_(std::move(order)) {
    center_ = box_.center();
    const double half = 0.5 * (box_.max - box_.min).maxCoeff();
    // A power of two, so that scaling does not round; 1e-60 and 1e60 stay far from its limits.
    scale_ = half > 0 ? std::exp2(-std::ceil(std::log2(half))) : 1.0;
    device_.reset(rtcNewDevice("threads=0"));
    if (!device_) throw Error(ErrorCode::Internal, "Embree: no device");
    scene_.reset(rtcNewScene(device_.get()));
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>((corners_.size() + kGroup - 1) / kGroup));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_LOW);
    rtcCommitScene(scene_.get());
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) fail(device_.get(), "building failed");
  }

  [[nodiscard]] Nearest nearest(const Vec3& p, std::uint32_t hint) const override {
    Visit visit;
    visit.search = this;
    visit.point = p;
    // Far away the float32 grid is coarser than the mesh; the clamped point still has every
    // triangle within the enlarged radius.
    const Vec3 q = (scale_ * (p - center_)).cwiseMax(-kFarthest).cwiseMin(kFarthest);
    const Vec3 exact = scale_ * (p - center_);
    RTCPointQuery query;
    query.x = static_cast<float>(q.x());
    query.y = static_cast<float>(q.y());
    query.z = static_cast<float>(q.z());
    query.time = 0;
    // How far the float32 point is from the true one, in scaled coordinates.
    visit.shift = (Vec3(query.x, query.y, query.z) - exact).norm() * (1 + 1e-12) +
                  1e-15 * exact.cwiseAbs().maxCoeff() + 1e-15;
    if (hint != kNone) visit.consider(hint, to_triangle(p, hint));
    query.radius = visit.radius();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_.get(), &query, &context, meet, &visit);
    ensure(std::isfinite(visit.best.upper), "Embree found no triangle");
    return visit.best;
  }

 private:
  struct Visit {
    const EmbreeSearch* search = nullptr;
    Vec3 point = Vec3::Zero();
    double shift = 0;
    Nearest best{0, std::numeric_limits<double>::infinity(),
                 std::numeric_limits<double>::infinity()};

    bool consider(std::uint32_t triangle, const geom::DistanceBounds& d) {
      best.lower = std::min(best.lower, d.lower);
      if (!(d.upper < best.upper)) return false;
      best.upper = d.upper;
      best.triangle = triangle;
      return true;
    }
    /// Radius about the float32 point that contains everything at most best.upper from the point.
    [[nodiscard]] float radius() const {
      if (!std::isfinite(best.upper)) return std::numeric_limits<float>::infinity();
      const double r = (search->scale_ * best.upper + shift) * kTraversal;
      return above(std::max(r, kSmallestRadius));
    }
  };

  /// The places in spatial order that a primitive stands for.
  [[nodiscard]] std::pair<std::size_t, std::size_t> group(unsigned primitive) const {
    const std::size_t first = std::size_t{primitive} * kGroup;
    return {first, std::min(first + kGroup, corners_.size())};
  }

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const EmbreeSearch*>(arguments->geometryUserPtr);
    geom::Box3 box;
    const auto [first, last] = self.group(arguments->primID);
    for (std::size_t place = first; place < last; ++place)
      for (const Vec3& corner : self.corners_[place])
        box.extend(Vec3(self.scale_ * (corner - self.center_)));
    // The difference errs by half an ulp of double, far less than the step to the next float32.
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = below(box.min.x() - 1e-15);
    out.lower_y = below(box.min.y() - 1e-15);
    out.lower_z = below(box.min.z() - 1e-15);
    out.upper_x = above(box.max.x() + 1e-15);
    out.upper_y = above(box.max.y() + 1e-15);
    out.upper_z = above(box.max.z() + 1e-15);
  }

  static bool meet(RTCPointQueryFunctionArguments* arguments) {
    auto& visit = *static_cast<Visit*>(arguments->userPtr);
    const EmbreeSearch& self = *visit.search;
    const auto [first, last] = self.group(arguments->primID);
    bool nearer = false;
    for (std::size_t place = first; place < last; ++place) {
      if (geom::box_beyond(visit.point, self.corners_[place], visit.best.upper)) continue;
      const auto& [a, b, c] = self.corners_[place];
      const bool closer =
          visit.consider(self.order_[place], geom::point_triangle_distance(visit.point, a, b, c));
      nearer = nearer || closer;
    }
    if (!nearer) return false;
    arguments->query->radius = std::min(arguments->query->radius, visit.radius());
    return true;
  }

  struct Release {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    void operator()(RTCScene s) const { rtcReleaseScene(s); }
  };
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
  std::vector<std::uint32_t> order_;  // place → triangle
  Vec3 center_ = Vec3::Zero();
  double scale_ = 1;
};

}  // namespace

std::unique_ptr<geom::TriangleSearch> make_search(const geom::Mesh& mesh, Backend backend) {
  if (backend == Backend::Own) return std::make_unique<geom::DistanceQuery>(mesh);
  return std::make_unique<EmbreeSearch>(mesh);
}

}  // namespace kaboum::measure
