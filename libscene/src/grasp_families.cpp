// Families of grasps that leave the hand free of contact.

#include "grasp_families.h"

#include <kaboum/robot/transform.h>
#include <kaboum/world/grasp_family.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace kaboum::scene {
namespace {

using geom::Vec3;

constexpr double kRound = 2 * std::numbers::pi;
/// Cells of one slide; of each of two; of a turn.
constexpr std::size_t kCellsOfOne = 15, kCellsOfTwo = 7, kCellsOfTurn = 36;
/// Families of one hold.
constexpr std::size_t kMostFamilies = 6;
/// Share of the free cells: families of fewer new ones are left out.
constexpr double kFew = 0.05;
/// Parts of a cell, of what bounds are moved out by, and of a family, that are looked at.
constexpr std::size_t kPartsOfCell = 200, kPartsOfStep = 5'000, kPartsOfFamily = 200'000;
/// Halvings of a cell by which bounds are moved out.
constexpr int kSteps = 4;

/// As people read it: what is only rounding is 0.
double plain_number(double x, double size) { return std::abs(x) < 1e-15 * size ? 0 : x; }

/// Four digits of a number, towards 0.
double shortened(double x) {
  if (x == 0) return 0;
  const double digits = std::pow(10.0, 3 - std::floor(std::log10(std::abs(x))));
  return std::trunc(x * digits) / digits;
}

/// Cells of a hold's values: two slides (one cell of what does not slide) and a turn.
class Cells {
 public:
  using Place = std::array<std::size_t, 3>;

  Cells(const Place& counts, bool round)
      : counts_(counts), round_(round), open_(counts[0] * counts[1] * counts[2], 0), left_(open_) {}

  void set_open(const Place& at) { open_[index(at)] = left_[index(at)] = 1; }

  /// Places from a first one on, as many each way; the turn goes on at its beginning.
  struct Box {
    Place first{}, count{};
    std::size_t gain = 0;  ///< cells that are in no box that was taken
  };

  [[nodiscard]] std::size_t left() const {
    return static_cast<std::size_t>(std::ranges::count(left_, 1));
  }

  /// The box of open cells alone that has the most that are left.
  [[nodiscard]] Box largest() const {
    const Sums closed(*this, open_, 0), gained(*this, left_, 1);
    Box best;
    Box box;
    for (box.first[0] = 0; box.first[0] < counts_[0]; ++box.first[0])
      for (box.count[0] = 1; box.first[0] + box.count[0] <= counts_[0]; ++box.count[0])
        for (box.first[1] = 0; box.first[1] < counts_[1]; ++box.first[1])
          for (box.count[1] = 1; box.first[1] + box.count[1] <= counts_[1]; ++box.count[1])
            widest_turn(closed, gained, box, best);
    return best;
  }

  void take(const Box& box) {
    for (std::size_t i = 0; i < box.count[0]; ++i)
      for (std::size_t k = 0; k < box.count[1]; ++k)
        for (std::size_t t = 0; t < box.count[2]; ++t)
          left_[index({box.first[0] + i, box.first[1] + k, (box.first[2] + t) % counts_[2]})] = 0;
  }

  [[nodiscard]] bool is_round(const Box& box) const { return round_ && box.count[2] == counts_[2]; }

 private:
  [[nodiscard]] std::size_t index(const Place& at) const {
    return (at[0] * counts_[1] + at[1]) * counts_[2] + at[2];
  }

  /// Numbers of cells below each corner, the turn twice.
  class Sums {
   public:
    Sums(const Cells& cells, const std::vector<char>& of, char what)
        : rows_(cells.counts_[1] + 1), turns_(2 * cells.counts_[2] + 1) {
      sums_.assign((cells.counts_[0] + 1) * rows_ * turns_, 0);
      for (std::size_t i = 0; i < cells.counts_[0]; ++i)
        for (std::size_t k = 0; k < cells.counts_[1]; ++k)
          for (std::size_t t = 0; t + 1 < turns_; ++t) {
            const bool is = of[cells.index({i, k, t % cells.counts_[2]})] == what;
            sums_[at(i + 1, k + 1, t + 1)] =
                (is ? 1 : 0) + sums_[at(i, k + 1, t + 1)] + sums_[at(i + 1, k, t + 1)] +
                sums_[at(i + 1, k + 1, t)] - sums_[at(i, k, t + 1)] - sums_[at(i, k + 1, t)] -
                sums_[at(i + 1, k, t)] + sums_[at(i, k, t)];
          }
    }
    [[nodiscard]] std::size_t in(const Box& box) const {
      const auto [i, k, t] = box.first;
      const std::size_t I = i + box.count[0], K = k + box.count[1], T = t + box.count[2];
      return static_cast<std::size_t>(sums_[at(I, K, T)] - sums_[at(i, K, T)] - sums_[at(I, k, T)] -
                                      sums_[at(I, K, t)] + sums_[at(i, k, T)] + sums_[at(i, K, t)] +
                                      sums_[at(I, k, t)] - sums_[at(i, k, t)]);
    }

   private:
    [[nodiscard]] std::size_t at(std::size_t i, std::size_t k, std::size_t t) const {
      return (i * rows_ + k) * turns_ + t;
    }
    std::size_t rows_, turns_;
    std::vector<int> sums_;
  };

  /// Compares boxes of these slides with the best one, of all turns.
  void widest_turn(const Sums& closed, const Sums& gained, Box box, Box& best) const {
    for (box.first[2] = 0; box.first[2] < counts_[2]; ++box.first[2]) {
      const std::size_t most = round_ ? counts_[2] : counts_[2] - box.first[2];
      for (box.count[2] = 1; box.count[2] <= most && closed.in(box) == 0; ++box.count[2]) {
        box.gain = gained.in(box);
        if (box.gain > best.gain) best = box;
      }
      if (best.count == box.count && is_round(best)) return;
    }
  }

  Place counts_;
  bool round_;
  std::vector<char> open_, left_;
};

/// A hold in cells.
class FreeSpace {
 public:
  FreeSpace(const FreeHold& hold, Hand& hand, GraspRequest::Axis closing, double size)
      : hold_(hold), hand_(hand), closing_(closing), size_(size), counts_{1, 1, 1} {
    StatedGrasp base = grasp_of(hold.tool, closing, size);
    base.slides = hold.slides;
    base.turn = hold.turn;
    base_ = base.read();
    for (std::size_t i = 0; i < hold.slides.size(); ++i)
      counts_[i] = hold.slides.size() == 1 ? kCellsOfOne : kCellsOfTwo;
    if (hold.turn) counts_[2] = kCellsOfTurn;
  }

  std::vector<StatedGrasp> families() {
    Cells cells(counts_, hold_.turn.has_value());
    for (std::size_t i = 0; i < counts_[0]; ++i)
      for (std::size_t k = 0; k < counts_[1]; ++k)
        if (fits(box_of({{i, k, 0}, {1, 1, 1}}))) open({{i, k, 0}, {1, 1, counts_[2]}}, cells);
    const std::size_t all = cells.left();
    std::vector<StatedGrasp> out;
    while (out.size() < kMostFamilies) {
      const Cells::Box box = cells.largest();
      if (box.gain == 0 || static_cast<double>(box.gain) < kFew * static_cast<double>(all)) break;
      cells.take(box);
      const bool round = cells.is_round(box);
      const StatedGrasp family = stated(widened(box_of(box), round), round);
      const world::Grasp read = family.read();
      if (hand_.is_free(read, whole(read), kPartsOfFamily)) out.push_back(family);
    }
    return out;
  }

 private:
  /// All members of a family.
  static MemberBox whole(const world::Grasp& grasp) {
    MemberBox out;
    for (const world::FreeSlide& slide : grasp.slides) out.push_back({slide.from, slide.to});
    if (grasp.turn) out.push_back({grasp.turn->from, grasp.turn->to});
    return out;
  }

  /// Opens those of some cells that are free: all at once, or those of either half.
  void open(const Cells::Box& some, Cells& cells) {
    const std::size_t count = some.count[2];
    if (hand_.is_free(base_, box_of(some), count == 1 ? kPartsOfCell : 1)) {
      for (std::size_t t = 0; t < count; ++t)
        cells.set_open({some.first[0], some.first[1], some.first[2] + t});
    } else if (count > 1) {
      Cells::Box half = some;
      half.count[2] = count / 2;
      open(half, cells);
      half.first[2] += half.count[2];
      half.count[2] = count - half.count[2];
      open(half, cells);
    }
  }

  [[nodiscard]] double cell_of(std::size_t freedom) const {
    if (freedom == hold_.slides.size()) return kRound / static_cast<double>(counts_[2]);
    const world::FreeSlide& slide = hold_.slides[freedom];
    return (slide.to - slide.from) / static_cast<double>(counts_[freedom]);
  }

  /// The values of cells.
  [[nodiscard]] MemberBox box_of(const Cells::Box& box) const {
    MemberBox out;
    const auto add = [&](std::size_t freedom, std::size_t place, double from) {
      const auto first = static_cast<double>(box.first[place]),
                 count = static_cast<double>(box.count[place]);
      const double cell = cell_of(freedom);
      out.push_back({from + first * cell, from + (first + count) * cell});
    };
    for (std::size_t i = 0; i < hold_.slides.size(); ++i) add(i, i, hold_.slides[i].from);
    // Cells of a turn are round whole multiples of an angle, so that 0 is the middle of one.
    if (hold_.turn) add(hold_.slides.size(), 2, -0.5 * cell_of(hold_.slides.size()));
    return out;
  }

  [[nodiscard]] bool fits(const MemberBox& box) const {
    return hold_.fits(
        {box.begin(), box.begin() + static_cast<std::ptrdiff_t>(hold_.slides.size())});
  }

  /// A box whose bounds are moved out as far as what is added is free.
  MemberBox widened(MemberBox box, bool round) {
    for (std::size_t i = 0; i < box.size(); ++i) {
      const bool is_turn = i == hold_.slides.size();
      if (is_turn && round) continue;
      for (const bool up : {false, true}) {
        double step = cell_of(i);
        for (int k = 0; k < kSteps; ++k) {
          step *= 0.5;
          MemberBox more = box;
          more[i] =
              up ? Range{box[i].to, box[i].to + step} : Range{box[i].from - step, box[i].from};
          const bool within =
              is_turn ? box[i].to - box[i].from + step < kRound
                      : more[i].from >= hold_.slides[i].from && more[i].to <= hold_.slides[i].to;
          if (!within || !fits(more) || !hand_.is_free(base_, more, kPartsOfStep)) continue;
          (up ? box[i].to : box[i].from) = up ? more[i].to : more[i].from;
        }
      }
    }
    return box;
  }

  /// The family of these members, about the one in their middle.
  [[nodiscard]] StatedGrasp stated(const MemberBox& box, bool round) const {
    ToolPlace tool = hold_.tool;
    Vec3 slid = Vec3::Zero();
    for (std::size_t i = 0; i < hold_.slides.size(); ++i)
      slid += (0.5 * box[i].from + 0.5 * box[i].to) * hold_.slides[i].direction;
    const bool turned = hold_.turn && !round;
    if (turned) {
      const Eigen::Matrix3d turn =
          robot::rotation_about(hold_.turn->axis, 0.5 * box.back().from + 0.5 * box.back().to);
      tool.approach = turn * tool.approach;
      tool.closing = turn * tool.closing;
      tool.origin = hold_.turn->point + turn * (tool.origin - hold_.turn->point);
    }
    tool.origin += slid;
    StatedGrasp out = grasp_of(tool, closing_, size_);
    out.slides = hold_.slides;
    for (std::size_t i = 0; i < out.slides.size(); ++i) {
      out.slides[i].direction = plain(out.slides[i].direction, 1);
      out.slides[i].to = shortened(0.5 * box[i].to - 0.5 * box[i].from);
      out.slides[i].from = -out.slides[i].to;
    }
    out.turn = hold_.turn;
    out.turns_round = round;
    if (out.turn) {
      out.turn->point = plain(out.turn->point + slid, size_);
      out.turn->axis = plain(out.turn->axis, 1);
    }
    if (turned) {
      out.turn->to = shortened(0.5 * box.back().to - 0.5 * box.back().from);
      out.turn->from = -out.turn->to;
    }
    out.rank = hold_.rank;
    return out;
  }

  const FreeHold& hold_;
  Hand& hand_;
  GraspRequest::Axis closing_;
  double size_;
  Cells::Place counts_;
  world::Grasp base_;
};

}  // namespace

Vec3 plain(const Vec3& v, double size) {
  return {plain_number(v.x(), size), plain_number(v.y(), size), plain_number(v.z(), size)};
}

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

world::Grasp StatedGrasp::read(std::string name) const {
  world::Grasp out{std::move(name), {}};
  out.pose.translation = position;
  if (!rotation.vec().isZero(0)) out.pose.linear = rotation.normalized().toRotationMatrix();
  out.slides = slides;
  for (world::FreeSlide& slide : out.slides) slide.direction.normalize();
  out.turn = turn;
  if (out.turn) out.turn->axis.normalize();
  out.rank = rank;
  return out;
}

Json StatedGrasp::json(const std::string& name) const {
  Json out = {{"name", name},
              {"position", numbers(position)},
              {"quaternion", {rotation.x(), rotation.y(), rotation.z(), rotation.w()}}};
  if (turn) {
    out["turn"] = {
        {"about", {{"point", numbers(turn->point)}, {"direction", numbers(turn->axis)}}}};
    if (!turns_round) {
      out["turn"]["from"] = turn->from;
      out["turn"]["to"] = turn->to;
    }
  }
  for (const world::FreeSlide& slide : slides)
    out["slides"].push_back({{"along", {{"direction", numbers(slide.direction)}}},
                             {"from", slide.from},
                             {"to", slide.to}});
  if (rank > 0) out["rank"] = rank;
  return out;
}

StatedGrasp grasp_of(const ToolPlace& tool, GraspRequest::Axis closing, double size) {
  const bool x = closing == GraspRequest::Axis::X;
  Eigen::Matrix3d axes;
  axes.col(x ? 0 : 1) = tool.closing;
  axes.col(x ? 1 : 0) =
      x ? Vec3(tool.approach.cross(tool.closing)) : Vec3(tool.closing.cross(tool.approach));
  axes.col(2) = tool.approach;
  const Eigen::Quaterniond q(Eigen::Matrix3d(axes.transpose()));
  StatedGrasp out;
  out.position = plain(-(axes.transpose() * tool.origin), size);
  out.rotation = {plain_number(q.w(), 1), plain_number(q.x(), 1), plain_number(q.y(), 1),
                  plain_number(q.z(), 1)};
  return out;
}

std::vector<StatedGrasp> families_of(const FreeHold& hold, Hand& hand, GraspRequest::Axis closing,
                                     double size) {
  return FreeSpace(hold, hand, closing, size).families();
}

}  // namespace kaboum::scene
