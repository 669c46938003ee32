// See placed.h.
#include "glass/debug/placed.h"

#include <algorithm>
#include <utility>

namespace vitrine::glass::debug {
namespace {

using Kind = spirv::SourceType::Kind;
using Memory = spirv::SourceVariable::Memory;

const spirv::SourceType& type_at(const Viewer& viewer, const Place& place) { return viewer.tables().types[place.type]; }

bool is_number(Kind kind) {
  return kind == Kind::kBool || kind == Kind::kInt || kind == Kind::kUint || kind == Kind::kFloat;
}

/// Most numbers that are set at once.
constexpr std::size_t kMostSet = 65536;

/// Where each of the numbers of a scalar or vector lies; empty: it is another thing.
std::vector<Place> scalar_places(const Viewer& viewer, const Place& place) {
  const spirv::SourceType& type = type_at(viewer, place);
  if (place.descriptors || place.variable->memory == Memory::kOpaque) return {};
  if (is_number(type.kind)) return {place};
  std::vector<Place> places;
  for (std::uint32_t i = 0; type.kind == Kind::kVector && i < type.count; ++i)
    places.push_back(element_of(viewer.tables(), place, i));
  return places;
}

Scalar fitting(const spirv::SourceType& type, const Scalar& from) {
  if (type.kind == Kind::kBool) return make_bool(to_bool(from));
  if (type.kind == Kind::kFloat) return make_float(to_double(from), type.width);
  Scalar scalar = make_uint(static_cast<std::uint64_t>(to_int(from)), type.width);
  scalar.type = type.kind == Kind::kInt ? 'I' : 'U';
  return scalar;
}

struct Misfit {
  std::string text;
};

/// Puts values to where they belong. Throws Misfit.
class Fitter {
 public:
  explicit Fitter(const Viewer& viewer) : viewer_(viewer) {}

  void put(const Place& place, const Value& value) {
    const std::vector<Place> places = scalar_places(viewer_, place);
    if (!places.empty()) return put_numbers(places, value);
    const spirv::SourceType& type = type_at(viewer_, place);
    if (place.descriptors || place.variable->memory == Memory::kOpaque)
      throw Misfit{"images and arrays of bindings cannot be set"};
    if (type.kind != Kind::kArray && type.kind != Kind::kMatrix && type.kind != Kind::kStruct)
      throw Misfit{"what has the type " + type.name + " cannot be set"};
    if (!value.names.empty()) return put_members(place, type, value);
    const std::uint32_t count =
        type.kind == Kind::kStruct ? static_cast<std::uint32_t>(type.members.size()) : count_of(viewer_, place);
    const bool open = type.kind == Kind::kArray && type.count == 0;
    if (value.place) return put_copy(place, count, *value.place);
    const std::size_t given = value.list.size();
    if (given == 0 || (given != count && !open && is_flat(value))) return put_flat(place, value);
    if (given > count || (given != count && !open))
      throw Misfit{type.name + " has " + std::to_string(count) + " parts, not " + std::to_string(given)};
    for (std::uint32_t i = 0; i < given; ++i) put(part(place, i), value.list[i]);
  }

  std::vector<PlacedScalar> placed;

 private:
  Place part(const Place& place, std::uint32_t i) const {
    const bool member = type_at(viewer_, place).kind == Kind::kStruct && !place.descriptors;
    return member ? member_of(viewer_.tables(), place, i) : element_of(viewer_.tables(), place, i);
  }

  void add(const Place& place, const Scalar& number) {
    if (number.type == '?') throw Misfit{"a value that nobody has written"};
    if (placed.size() == kMostSet) throw Misfit{"these are too many numbers to be set at once"};
    placed.push_back({place, fitting(type_at(viewer_, place), number)});
  }

  std::vector<Scalar> numbers_in(const Value& value) const {
    if (value.place) return numbers_of(viewer_, *value.place);
    std::vector<Scalar> numbers = value.scalars;
    for (const Value& one : value.list) {
      const std::vector<Scalar> more = numbers_in(one);
      numbers.insert(numbers.end(), more.begin(), more.end());
    }
    return numbers;
  }

  void put_numbers(const std::vector<Place>& places, const Value& value) {
    const std::vector<Scalar> numbers = value.names.empty() ? numbers_in(value) : std::vector<Scalar>();
    if (numbers.empty() || (numbers.size() != 1 && numbers.size() != places.size()))
      throw Misfit{"scalars and vectors can be set to as many numbers or to one"};
    for (std::size_t i = 0; i < places.size(); ++i) add(places[i], numbers[numbers.size() == 1 ? 0 : i]);
  }

  void put_members(const Place& place, const spirv::SourceType& type, const Value& value) {
    for (std::size_t i = 0; i < value.names.size(); ++i) {
      const auto named = [&](const auto& member) { return member.name == value.names[i]; };
      const auto found = std::ranges::find_if(type.members, named);
      if (type.kind != Kind::kStruct || found == type.members.end())
        throw Misfit{"there is no member '" + value.names[i] + "'"};
      put(part(place, static_cast<std::uint32_t>(found - type.members.begin())), value.list[i]);
    }
  }

  void put_copy(const Place& place, std::uint32_t count, const Place& from) {
    const spirv::SourceType &to = type_at(viewer_, place), &type = type_at(viewer_, from);
    const std::uint32_t there =
        type.kind == Kind::kStruct ? static_cast<std::uint32_t>(type.members.size()) : count_of(viewer_, from);
    if (from.descriptors || from.texel || type.kind != to.kind || there != count)
      throw Misfit{to.name + " can be set to what has the same parts, or to {a, b}"};
    for (std::uint32_t i = 0; i < count; ++i) put(part(place, i), {part(from, i), {}});
  }

  /// Whether each of a list is one number.
  bool is_flat(const Value& value) const {
    return std::ranges::all_of(value.list,
                               [&](const Value& one) { return one.names.empty() && numbers_in(one).size() == 1; });
  }

  void collect(const Place& place, std::vector<Place>& places) const {
    const std::vector<Place> own = scalar_places(viewer_, place);
    const spirv::SourceType& type = type_at(viewer_, place);
    places.insert(places.end(), own.begin(), own.end());
    if (!own.empty() || type.kind == Kind::kOther || places.size() > kMostSet) return;
    const std::uint32_t count =
        type.kind == Kind::kStruct ? static_cast<std::uint32_t>(type.members.size()) : count_of(viewer_, place);
    for (std::uint32_t i = 0; i < count && places.size() <= kMostSet; ++i) collect(part(place, i), places);
  }

  void put_flat(const Place& place, const Value& value) {
    std::vector<Place> places;
    collect(place, places);
    const std::vector<Scalar> numbers = numbers_in(value);
    if (numbers.size() != places.size())
      throw Misfit{type_at(viewer_, place).name + " can be set to {a, b} with what its parts get, or to " +
                   std::to_string(places.size()) + " numbers"};
    for (std::size_t i = 0; i < places.size(); ++i) add(places[i], numbers[i]);
  }

  const Viewer& viewer_;
};

std::vector<PlacedScalar> placed_texel(const Viewer& viewer, const Place& place, const Value& value) {
  std::vector<Scalar> now = numbers_of(viewer, place);
  std::vector<Scalar> numbers = value.place ? numbers_of(viewer, *value.place) : value.scalars;
  for (const Value& one : value.list) {
    const std::vector<Scalar> more = one.place ? numbers_of(viewer, *one.place) : one.scalars;
    if (more.size() != 1) throw Misfit{"texels can be set to numbers"};
    numbers.push_back(more[0]);
  }
  if (now.empty() || numbers.empty() || numbers.size() > now.size())
    throw Misfit{"texels can be set to one to four numbers"};
  std::vector<PlacedScalar> placed;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i < numbers.size() && numbers[i].type == '?') throw Misfit{"a value that nobody has written"};
    const Scalar& from = i < numbers.size() ? numbers[i] : now[i];
    const char letter = now[i].type;
    Scalar number = letter == 'F' ? make_float(to_double(from)) : make_uint(static_cast<std::uint64_t>(to_int(from)));
    number.type = letter;
    placed.push_back({place, number});
  }
  return placed;
}

}  // namespace

base::Result<std::vector<PlacedScalar>> placed_numbers(const Viewer& viewer, const Place& place, const Value& value) {
  try {
    if (place.texel) return placed_texel(viewer, place, value);
    Fitter fitter(viewer);
    fitter.put(place, value);
    return std::move(fitter.placed);
  } catch (const Misfit& misfit) {
    return base::Error{misfit.text};
  }
}

}  // namespace vitrine::glass::debug
