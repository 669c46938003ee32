// Members of JSON that somebody else wrote: another type than expected reads as if it were not there.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vitrine::glass {

inline std::string text_of(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

template <class T = std::size_t>
T number_of(const nlohmann::json& object, const char* key, T otherwise = 0) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<T>() : otherwise;
}

inline nlohmann::json list_of(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : nlohmann::json::array();
}

}  // namespace vitrine::glass
