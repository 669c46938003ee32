// The two visitors of fields.h: a value as JSON and back. Blobs go to a section of their own, each once.
#pragma once

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include "glass/bug/fields.h"

namespace vitrine::glass::bug {

using Json = nlohmann::ordered_json;

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Where blobs lie in their section, and what the section holds so far.
class BlobWriter {
 public:
  Json place_of(const Blob& blob) {
    if (!blob) return nullptr;
    const auto [at, added] = places_.try_emplace(blob.get(), bytes_.size());
    if (added) bytes_.append(reinterpret_cast<const char*>(blob->data()), blob->size());
    return Json::array({at->second, blob->size()});
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::map<const Bytes*, std::size_t> places_;
  std::string bytes_;
};

/// Writes the members of one value.
class Writer {
 public:
  explicit Writer(BlobWriter& blobs) : blobs_(blobs) {}
  template <class T>
  void operator()(const char* name, T& value) {
    object_[name] = json_of(value);
  }
  template <class T>
  void newer(const char* name, T& value) {
    (*this)(name, value);
  }
  Json take() { return std::move(object_); }

  template <class T>
  Json json_of(T& value) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
      return value;
    } else if constexpr (std::is_floating_point_v<T>) {
      return std::isfinite(value) ? Json(value) : Json(std::to_string(value));  // "nan", "-inf"
    } else if constexpr (std::is_enum_v<T>) {
      return static_cast<std::int64_t>(value);
    } else if constexpr (Number<T>) {
      return value;
    } else if constexpr (std::is_same_v<T, Blob>) {
      return blobs_.place_of(value);
    } else if constexpr (requires { std::begin(value); }) {
      Json list = Json::array();
      for (auto& one : value) list.push_back(json_of(one));
      return list;
    } else {
      Writer members(blobs_);
      fields(members, value);
      return members.take();
    }
  }

 private:
  BlobWriter& blobs_;
  Json object_ = Json::object();
};

/// Blobs out of their section, each once, however often it is named.
class BlobReader {
 public:
  explicit BlobReader(std::string_view section) : section_(section) {}
  Blob at(const Json& place) {
    if (place.is_null()) return nullptr;
    const auto offset = place.at(0).get<std::uint64_t>(), size = place.at(1).get<std::uint64_t>();
    if (place.size() != 2 || offset > section_.size() || size > section_.size() - offset)
      throw std::out_of_range("bytes that the file does not have");
    Blob& blob = blobs_[{offset, size}];
    if (blob) return blob;
    // Altered places that overlap would ask for more memory than the file has.
    if ((taken_ += size) > section_.size()) throw std::out_of_range("bytes that are named twice");
    const auto* first = reinterpret_cast<const std::byte*>(section_.data()) + offset;
    return blob = std::make_shared<Bytes>(first, first + size);
  }

 private:
  std::string_view section_;
  std::uint64_t taken_ = 0;
  std::map<std::pair<std::uint64_t, std::uint64_t>, Blob> blobs_;
};

/// Reads the members of one value. Throws std::exception for what is missing, of another kind or out of range.
class Reader {
 public:
  Reader(const Json& object, BlobReader& blobs) : object_(object), blobs_(blobs) {}
  template <class T>
  void operator()(const char* name, T& value) {
    read(object_.at(name), value);
  }
  /// A member that stays as it is where the file has none.
  template <class T>
  void newer(const char* name, T& value) {
    if (object_.contains(name)) read(object_[name], value);
  }

  template <class T>
  void read(const Json& json, T& value) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
      value = json.get<T>();
    } else if constexpr (std::is_floating_point_v<T>) {
      value = json.is_string() ? std::strtof(json.get_ref<const std::string&>().c_str(), nullptr) : number(json);
    } else if constexpr (std::is_enum_v<T>) {
      const auto number = integer<std::int32_t>(json);
      if (number < 0) throw std::out_of_range("a number that no enumeration has");
      value = static_cast<T>(number);
    } else if constexpr (Number<T>) {
      value = integer<T>(json);
    } else if constexpr (std::is_same_v<T, Blob>) {
      value = blobs_.at(json);
    } else if constexpr (requires { value.resize(1); }) {
      if (!json.is_array()) throw std::out_of_range("something that is no list");
      value.resize(json.size());
      for (std::size_t i = 0; i < value.size(); ++i) read(json[i], value[i]);
    } else if constexpr (requires { std::begin(value); }) {
      if (!json.is_array() || json.size() != std::size(value)) throw std::out_of_range("a list of another length");
      for (std::size_t i = 0; i < std::size(value); ++i) read(json[i], value[i]);
    } else {
      Reader members(json, blobs_);
      fields(members, value);
    }
  }

 private:
  static float number(const Json& json) {
    if (!json.is_number()) throw std::out_of_range("something that is no number");
    return static_cast<float>(json.get<double>());
  }
  template <class T>
  static T integer(const Json& json) {
    if (!json.is_number_integer()) throw std::out_of_range("something that is no whole number");
    const bool fits = json.is_number_unsigned() ? std::in_range<T>(json.get<std::uint64_t>())
                                                : std::in_range<T>(json.get<std::int64_t>());
    if (!fits) throw std::out_of_range("a number that is too large");
    return static_cast<T>(json.is_number_unsigned() ? json.get<std::uint64_t>()
                                                    : static_cast<std::uint64_t>(json.get<std::int64_t>()));
  }

  const Json& object_;
  BlobReader& blobs_;
};

}  // namespace vitrine::glass::bug
