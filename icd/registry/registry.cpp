// Look-ups in the generated registry tables, and the two chains that are answered from flat lists of claims.
#include "icd/registry/registry.h"

#include <algorithm>
#include <cstring>

#include "icd/edge/util.h"

namespace vitrine::icd {
namespace {

template <class Row>
const Row* find_by_name(std::span<const Row> rows, std::string_view name) {
  const auto it =
      std::lower_bound(rows.begin(), rows.end(), name, [](const Row& row, std::string_view n) { return row.name < n; });
  return it != rows.end() && it->name == name ? &*it : nullptr;
}

template <class Row>
const Row* find_by_type(std::span<const Row> rows, VkStructureType type) {
  const auto it = std::find_if(rows.begin(), rows.end(), [type](const Row& row) { return row.type == type; });
  return it != rows.end() ? &*it : nullptr;
}

void write_members(const FeatureStruct& structure, void* out, const FeatureSet& features) {
  for (const FeatureMember& member : feature_members(structure)) {
    const VkBool32 value = features.test(member.feature) ? VK_TRUE : VK_FALSE;
    std::memcpy(static_cast<std::byte*>(out) + member.offset, &value, sizeof value);
  }
}

void read_members(const FeatureStruct& structure, const void* in, FeatureSet& features) {
  for (const FeatureMember& member : feature_members(structure)) {
    VkBool32 value;
    std::memcpy(&value, static_cast<const std::byte*>(in) + member.offset, sizeof value);
    if (value) features.set(member.feature);
  }
}

}  // namespace

const EntryPoint* find_entry_point(std::string_view name) { return find_by_name(entry_points(), name); }

Extension find_extension(std::string_view name) {
  const ExtensionInfo* info = find_by_name(extension_infos(), name);
  return info ? static_cast<Extension>(info - extension_infos().data()) : Extension::kCount;
}

bool is_open(const EntryPoint& entry, std::uint32_t version, const ExtensionSet& extensions) {
  for (const Gate& gate : gates(entry)) {
    bool open = gate.version <= version;
    for (const Extension e : gate.extension) open = open && (e == Extension::kCount || extensions.test(e));
    if (open) return true;
  }
  return false;
}

void write_features(VkPhysicalDeviceFeatures* out, const FeatureSet& features) {
  write_members(feature_structs().front(), out, features);
}

void read_features(const VkPhysicalDeviceFeatures* in, FeatureSet& features) {
  read_members(feature_structs().front(), in, features);
}

void write_feature_chain(VkPhysicalDeviceFeatures2* chain, const FeatureSet& features) {
  write_features(&chain->features, features);
  for (VkBaseOutStructure& item : out_chain(chain->pNext)) {
    const FeatureStruct* structure = find_by_type(feature_structs().subspan(1), item.sType);
    if (structure) write_members(*structure, &item, features);
  }
}

void read_feature_chain(const void* chain, FeatureSet& features) {
  for (const VkBaseInStructure& item : in_chain(chain)) {
    if (item.sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2) {
      read_features(&reinterpret_cast<const VkPhysicalDeviceFeatures2&>(item).features, features);
    } else if (const FeatureStruct* structure = find_by_type(feature_structs().subspan(1), item.sType)) {
      read_members(*structure, &item, features);
    }
  }
}

void write_property_chain(void* chain) {
  for (VkBaseOutStructure& item : out_chain(chain)) {
    const PropertyStruct* structure = find_by_type(property_structs(), item.sType);
    if (!structure) continue;
    const auto write = [&](std::size_t first, std::size_t end) {
      std::memcpy(reinterpret_cast<std::byte*>(&item) + first, static_cast<const std::byte*>(structure->values) + first,
                  end - first);
    };
    write(sizeof(VkBaseOutStructure), structure->kept_first);
    write(structure->kept_end, structure->size);
  }
}

}  // namespace vitrine::icd
