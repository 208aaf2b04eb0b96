// Embree as a search structure that culls in float32 and never culls too much; the argument is in
// docs/algorithms/distances.md, "Embree".
#include <embree3/rtcore.h>
#include <kaboum/base/error.h>
#include <kaboum/distance/search.h>
#include <kaboum/geom/four_triangles.h>
#include <kaboum/geom/spatial_order.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kaboum::distance {
namespace {

using geom::Float4;
using geom::larger;
using geom::Vec3;

/// The float32 number nearest to x, the largest finite one beyond their range: a conversion out of
/// range would be undefined.
float nearest_float(double x) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -kLargest, kLargest));
}
/// The next float32 number below (above) x's nearest one: a bound that rounding cannot cross. Of
/// x beyond their range, `above` is infinite.
float below(double x) {
  return std::nextafter(nearest_float(x), -std::numeric_limits<float>::infinity());
}
float above(double x) {
  return std::nextafter(nearest_float(x), std::numeric_limits<float>::infinity());
}

// Query points are clamped to this distance from the origin of the scaled coordinates, in which the
// mesh lies within [−1, 1]³.
constexpr double kFarthest = 1e6;
// No radius is smaller than this, so that its square is a normal float32 number.
constexpr double kSmallestRadius = 0x1p-60;
// Relative allowance for Embree's float32 arithmetic: subtraction, squares, sums, the square of the
// radius; less than 16 roundings of 2^-24 each.
constexpr double kTraversal = 1 + 0x1p-20;

// Triangles, neighbours in spatial order, that share a primitive: fewer to build with, and to
// visit.
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
    box_triangles();
    device_.reset(rtcNewDevice("threads=0"));
    if (!device_) throw Error(ErrorCode::Internal, "Embree: no device");
    scene_.reset(rtcNewScene(device_.get()));
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(
        geometry, static_cast<unsigned>((corners_.size() + kGroup - 1) / kGroup));
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

  /// Boxes of a primitive's triangles, by coordinate, so that they are all tested at once; those
  /// beyond the last triangle are empty.
  struct Boxes {
    static constexpr float kFar = std::numeric_limits<float>::infinity();
    std::array<Float4, 3> lower{kAllFar, kAllFar, kAllFar}, upper{-kAllFar, -kAllFar, -kAllFar};

   private:
    static constexpr Float4 kAllFar{kFar, kFar, kFar, kFar};
  };

  void box_triangles() {
    boxes_.resize((corners_.size() + kGroup - 1) / kGroup);
    for (std::size_t g = 0; g < boxes_.size(); ++g) {
      const auto [first, last] = group(static_cast<unsigned>(g));
      for (std::size_t place = first; place < last; ++place) {
        const auto& [a, b, c] = corners_[place];
        for (int axis = 0; axis < 3; ++axis) {
          const double low = std::min({a[axis], b[axis], c[axis]}) - center_[axis];
          const double high = std::max({a[axis], b[axis], c[axis]}) - center_[axis];
          // The differences err by half an ulp of double, far less than the step to the next
          // float32 number or 1e-15.
          boxes_[g].lower[axis][place - first] = below(scale_ * low - 1e-15);
          boxes_[g].upper[axis][place - first] = above(scale_ * high + 1e-15);
        }
      }
    }
  }

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const EmbreeSearch*>(arguments->geometryUserPtr);
    const Boxes& boxes = self.boxes_[arguments->primID];
    const auto low = [&](int axis) {
      const Float4& x = boxes.lower[axis];
      return std::min({x[0], x[1], x[2], x[3]});
    };
    const auto high = [&](int axis) {
      const Float4& x = boxes.upper[axis];
      return std::max({x[0], x[1], x[2], x[3]});
    };
    *arguments->bounds_o = {low(0), low(1), low(2), 0, high(0), high(1), high(2), 0};
  }

  /// Squared distances of the query point to the boxes of a primitive's triangles.
  static Float4 squared_distances(const RTCPointQuery& query, const Boxes& boxes) {
    const auto away = [&](int axis, float p) {
      return larger(larger(boxes.lower[axis] - p, p - boxes.upper[axis]), Float4{});
    };
    const Float4 x = away(0, query.x), y = away(1, query.y), z = away(2, query.z);
    return x * x + y * y + z * z;
  }

  static bool meet(RTCPointQueryFunctionArguments* arguments) {
    auto& visit = *static_cast<Visit*>(arguments->userPtr);
    const EmbreeSearch& self = *visit.search;
    RTCPointQuery& query = *arguments->query;
    const Float4 squared = squared_distances(query, self.boxes_[arguments->primID]);
    bool nearer = false;
    for (unsigned i = 0; i < kGroup; ++i) {
      if (squared[i] > query.radius * query.radius || squared[i] == Boxes::kFar) continue;
      const std::size_t place = std::size_t{arguments->primID} * kGroup + i;
      const auto& [a, b, c] = self.corners_[place];
      const bool closer =
          visit.consider(self.order_[place], geom::point_triangle_distance(visit.point, a, b, c));
      if (!closer) continue;
      query.radius = std::min(query.radius, visit.radius());
      nearer = true;
    }
    return nearer;
  }

  struct Release {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    void operator()(RTCScene s) const { rtcReleaseScene(s); }
  };
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
  std::vector<Boxes> boxes_;          // of primitives
  std::vector<std::uint32_t> order_;  // place → triangle
  Vec3 center_ = Vec3::Zero();
  double scale_ = 1;
};

}  // namespace

std::unique_ptr<geom::TriangleSearch> make_search(const geom::Mesh& mesh, Backend backend) {
  if (backend == Backend::Own) return std::make_unique<geom::DistanceQuery>(mesh);
  return std::make_unique<EmbreeSearch>(mesh);
}

}  // namespace kaboum::distance
