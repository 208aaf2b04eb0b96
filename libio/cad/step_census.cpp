// Faces of a STEP file: which of them the products reach, and in how many places.
//
// Products and their use in others (NEXT_ASSEMBLY_USAGE_OCCURRENCE) say how often a representation
// is meant; plain relationships of representations and mapped items lead on; their items hold
// solids, shells and faces. Whatever can carry shape and is not reached this way is refused.

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>

#include "census.h"
#include "step_file.h"
#include "step_names.h"

namespace kaboum::io {
namespace {

constexpr std::size_t npos = StepFile::npos;
constexpr std::size_t kMostPlaces = 10'000'000;
constexpr int kDeepest = 200;  ///< products in products, representations in representations

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }

class StepCensus {
 public:
  explicit StepCensus(std::string text) : file_(std::move(text)) {}

  Census run() {
    classify();
    collect();
    check_placements(file_);
    drop_mapped_uses();
    weigh_products();
    std::vector<double> own(count(), 0);
    for (const auto& [rep, product] : shape_of_) own[rep] += weight_[product];
    const bool products = !shape_of_.empty();
    for (std::size_t i = 0; i < count(); ++i) {
      if (kind_[i] != StepKind::Shape) continue;
      if (!products && !referred_[i]) own[i] = 1;
      if (own[i] > 0) add_representation(i, own[i], 0, npos);
    }
    return result();
  }

 private:
  [[nodiscard]] std::size_t count() const { return file_.entities().size(); }
  [[nodiscard]] const StepEntity& entity(std::size_t i) const { return file_.entities()[i]; }
  [[nodiscard]] std::string name(std::size_t i) const { return named(entity(i)); }

  /// What each entity is; the file is refused where that cannot be said.
  void classify() {
    kind_.assign(count(), StepKind::Harmless);
    refers_.resize(count());
    uses_.assign(count(), 0);
    referred_.assign(count(), false);
    for (std::size_t i = 0; i < count(); ++i) {
      for (const StepRecord& record : entity(i).records) {
        const StepKind kind = step_kind(record.name);
        if (kind == StepKind::Unknown)
          refuse(name(i) + ": entities of the type " + std::string(record.name) +
                 " are not known, and may be a part of the shape");
        if (kind == StepKind::Refused)
          refuse(name(i) + ": entities of the type " + std::string(record.name) + " are not read");
        // The order of StepKind says which of several types decides.
        kind_[i] = std::min(kind_[i], kind);
      }
      refers_[i] = file_.references(entity(i));
      if (std::count(refers_[i].begin(), refers_[i].end(), npos) > 0)
        refuse(name(i) + " refers to an entity that the file does not have: #" +
               std::to_string(missing(entity(i))));
    }
  }

  std::int64_t missing(const StepEntity& e) const {
    for (const StepRecord& record : e.records)
      for (std::size_t t = record.begin; t < record.end; ++t) {
        const StepToken& token = file_.tokens()[t];
        if (token.kind == StepToken::Reference && file_.find(token.id) == npos) return token.id;
      }
    return 0;
  }

  /// The entity that an argument of a record must refer to.
  std::size_t required(std::size_t i, const StepRecord& record, std::size_t argument) const {
    const std::size_t at = file_.argument(record, argument);
    if (at == npos)
      refuse(name(i) + ": its parameter " + std::to_string(argument + 1) +
             " has to refer to an entity");
    return at;
  }

  void collect() {
    std::set<std::size_t> placed;  // relationships that place components
    for (std::size_t i = 0; i < count(); ++i) {
      if (const auto* r = record_of(entity(i), "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")) {
        placed.insert(required(i, *r, 0));
        const std::size_t shape = required(i, *r, 1);
        const auto* of = record_of(entity(shape), "PRODUCT_DEFINITION_SHAPE");
        if (of == nullptr ||
            record_of(entity(required(shape, *of, 2)), "NEXT_ASSEMBLY_USAGE_OCCURRENCE") == nullptr)
          refuse(name(i) + " places what is no component of an assembly");
        placed_.insert(required(shape, *of, 2));
      }
    }
    for (std::size_t i = 0; i < count(); ++i) {
      const StepEntity& e = entity(i);
      if (record_of(e, "NEXT_ASSEMBLY_USAGE_OCCURRENCE") != nullptr) {
        const auto* r = record_of(e, "PRODUCT_DEFINITION_RELATIONSHIP");
        if (r == nullptr) r = record_of(e, "NEXT_ASSEMBLY_USAGE_OCCURRENCE");
        parents_[required(i, *r, 4)].push_back({i, required(i, *r, 3)});
      }
      if (const auto* r = record_of(e, "SHAPE_DEFINITION_REPRESENTATION")) add_shape(i, *r);
      if (record_of(e, "SHAPE_REPRESENTATION_RELATIONSHIP") != nullptr) {
        const auto* r = record_of(e, "REPRESENTATION_RELATIONSHIP");
        if (r == nullptr) r = record_of(e, "SHAPE_REPRESENTATION_RELATIONSHIP");
        const std::size_t a = required(i, *r, 2), b = required(i, *r, 3);
        referred_[b] = true;
        if (placed.count(i) > 0) continue;
        linked_[a].push_back(b);
        linked_[b].push_back(a);
      }
      if (const auto* r = record_of(e, "REPRESENTATION_MAP")) referred_[required(i, *r, 1)] = true;
    }
  }

  void add_shape(std::size_t i, const StepRecord& r) {
    const std::size_t definition = required(i, r, 0), rep = required(i, r, 1);
    const auto* shape = record_of(entity(definition), "PRODUCT_DEFINITION_SHAPE");
    if (shape == nullptr) return;  // of an aspect of a shape
    const std::size_t product = file_.argument(*shape, 2);
    if (product == npos) refuse(name(definition) + " belongs to no product");
    if (is_product(product)) {
      shape_of_.emplace_back(rep, product);
      has_shape_.insert(product);
    } else if (record_of(entity(product), "NEXT_ASSEMBLY_USAGE_OCCURRENCE") != nullptr) {
      refuse(name(i) + " gives a component of an assembly a shape of its own, which is not read");
    }
  }

  [[nodiscard]] bool is_product(std::size_t i) const {
    return record_of(entity(i), "PRODUCT_DEFINITION") != nullptr ||
           record_of(entity(i), "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS") != nullptr;
  }

  /// A component that nothing places may be placed by a mapped item: then that one counts.
  void drop_mapped_uses() {
    std::set<std::size_t> mapped;
    for (std::size_t i = 0; i < count(); ++i)
      if (const auto* r = record_of(entity(i), "REPRESENTATION_MAP"))
        mapped.insert(required(i, *r, 1));
    std::set<std::size_t> products;
    for (const auto& [rep, product] : shape_of_)
      if (mapped.count(rep) > 0) products.insert(product);
    for (auto& [part, uses] : parents_) {
      if (products.count(part) == 0) continue;
      uses.erase(std::remove_if(uses.begin(), uses.end(),
                                [&](const Use& u) { return placed_.count(u.usage) == 0; }),
                 uses.end());
    }
  }

  void weigh_products() {
    std::set<std::size_t> assemblies;
    for (const auto& [part, uses] : parents_)
      for (const auto& use : uses) assemblies.insert(use.whole);
    for (const auto& [part, uses] : parents_)
      if (has_shape_.count(part) == 0 && assemblies.count(part) == 0)
        refuse(name(part) + " is a component of an assembly, and has no shape in this file");
    for (std::size_t i = 0; i < count(); ++i)
      if (is_product(i)) weight_[i] = weight(i, 0);
  }

  /// How often a product is meant.
  double weight(std::size_t product, int depth) {
    if (depth > kDeepest) refuse(name(product) + " is a component of itself");
    const auto known = weight_.find(product);
    if (known != weight_.end()) return known->second;
    const auto uses = parents_.find(product);
    if (uses == parents_.end()) return 1;
    double sum = 0;
    for (const auto& use : uses->second) sum += weight(use.whole, depth + 1);
    return weight_[product] = sum;
  }

  void add_representation(std::size_t rep, double weight, int depth, std::size_t from) {
    if (depth > kDeepest) refuse(name(rep) + " is a part of itself");
    if (++places_ > kMostPlaces) refuse(name(rep) + ": too many places of it");
    // Its context is one of what it refers to.
    if (refers_[rep].size() > 1 && united_.insert(rep).second) check_units(file_, entity(rep));
    for (const std::size_t item : refers_[rep]) add_item(rep, item, weight, depth);
    const auto links = linked_.find(rep);
    if (links == linked_.end()) return;
    for (const std::size_t next : links->second)
      if (next != from && !belongs_to_product(next))
        add_representation(next, weight, depth + 1, rep);
  }

  [[nodiscard]] bool belongs_to_product(std::size_t rep) const {
    return std::any_of(shape_of_.begin(), shape_of_.end(),
                       [rep](const auto& shape) { return shape.first == rep; });
  }

  void add_item(std::size_t holder, std::size_t i, double weight, int depth) {
    if (depth > kDeepest) refuse(name(i) + " is a part of itself");
    switch (kind_[i]) {
      case StepKind::Face:
        uses_[i] += weight;
        break;
      case StepKind::Container:
        if (++places_ > kMostPlaces) refuse(name(i) + ": too many places of it");
        add_container(i, weight, depth);
        break;
      case StepKind::Surface: {
        const bool in_set = record_of(entity(holder), "GEOMETRIC_SET") != nullptr;
        if (!in_set) refuse(name(i) + ": a surface by itself in " + name(holder) + " is not read");
        uses_[i] += weight;
        break;
      }
      case StepKind::NotAsShape:
        refuse(name(i) + ": entities of this type are not read in shapes");
      case StepKind::Assembly:
        if (record_of(entity(i), "MAPPED_ITEM") != nullptr)
          add_representation(mapped_by(i), weight, depth + 1, npos);
        break;
      default:
        break;  // placements, curves, points, contexts
    }
  }

  /// The representation that a mapped item repeats.
  [[nodiscard]] std::size_t mapped_by(std::size_t i) const {
    const std::size_t map = required(i, *record_of(entity(i), "MAPPED_ITEM"), 1);
    const auto* r = record_of(entity(map), "REPRESENTATION_MAP");
    if (r == nullptr) refuse(name(i) + " maps " + name(map) + ", which is not read");
    return required(map, *r, 1);
  }

  void add_container(std::size_t i, double weight, int depth) {
    const double before = total_;
    for (const std::size_t part : refers_[i]) {
      if (kind_[part] == StepKind::Face) total_ += 1;
      add_item(i, part, weight, depth + 1);
    }
    const bool set = record_of(entity(i), "GEOMETRIC_SET") != nullptr ||
                     record_of(entity(i), "GEOMETRIC_CURVE_SET") != nullptr;
    if (!set && total_ == before) refuse(name(i) + " has no faces");
  }

  /// Edges that the bounds of a face state.
  [[nodiscard]] std::size_t edges(std::size_t face) const {
    std::size_t sum = 0;
    for (const std::size_t bound : refers_[face]) {
      if (record_of(entity(bound), "FACE_BOUND") == nullptr &&
          record_of(entity(bound), "FACE_OUTER_BOUND") == nullptr)
        continue;
      for (const std::size_t loop : refers_[bound])
        if (record_of(entity(loop), "EDGE_LOOP") != nullptr ||
            record_of(entity(loop), "POLY_LOOP") != nullptr)
          sum += refers_[loop].size();
    }
    return sum;
  }

  Census result() const {
    Census out;
    for (std::size_t i = 0; i < count(); ++i) {
      if (kind_[i] == StepKind::Face && uses_[i] == 0)
        refuse(name(i) + " is a face that no product and no shape reaches");
      if (kind_[i] == StepKind::Harmless || kind_[i] == StepKind::Shape)
        out.harmless.insert(entity(i).id);
      if (uses_[i] > 0) out.faces.push_back({entity(i).id, name(i), uses_[i], edges(i)});
    }
    return out;
  }

  struct Use {
    std::size_t usage, whole;
  };

  StepFile file_;
  std::vector<StepKind> kind_;
  std::vector<std::vector<std::size_t>> refers_;
  std::vector<double> uses_;
  std::vector<bool> referred_;
  std::map<std::size_t, std::vector<Use>> parents_;  ///< of products: usage and the whole
  std::map<std::size_t, std::vector<std::size_t>> linked_;
  std::vector<std::pair<std::size_t, std::size_t>> shape_of_;  ///< representation, product
  std::set<std::size_t> has_shape_, placed_;
  std::set<std::size_t> united_;  ///< representations whose units were looked at
  std::map<std::size_t, double> weight_;
  double total_ = 0;
  std::size_t places_ = 0;
};

}  // namespace

Census step_census(std::string text) { return StepCensus(std::move(text)).run(); }

}  // namespace kaboum::io
