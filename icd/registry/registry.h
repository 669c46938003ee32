// What the Vulkan registry and the claims in manifest/ say, as tables made at build time (icd/registry/generate.py).
// Looks things up by name or sType; knows no object.
#pragma once

#include <bitset>
#include <cstddef>
#include <span>
#include <string_view>

#include "icd/edge/vulkan_api.h"
#include "icd/enums.h"

namespace vitrine::icd {

using VoidFunction = void (*)();

/// A set of enumerators of Extension or Feature.
template <class E>
class EnumSet {
 public:
  bool test(E e) const { return bits_.test(static_cast<std::size_t>(e)); }
  void set(E e, bool value = true) { bits_.set(static_cast<std::size_t>(e), value); }
  EnumSet& operator|=(const EnumSet& other) {
    bits_ |= other.bits_;
    return *this;
  }

 private:
  std::bitset<static_cast<std::size_t>(E::kCount)> bits_;
};
using ExtensionSet = EnumSet<Extension>;
using FeatureSet = EnumSet<Feature>;

/// A command is there when the core version and all extensions (kCount: none) of one of its gates are.
struct Gate {
  std::uint32_t version;
  Extension extension[2];
};

enum class Scope : std::uint8_t { kGlobal, kInstance, kPhysicalDevice, kDevice };

struct EntryPoint {
  const char* name;
  Scope scope;
  std::uint16_t first_gate;
  std::uint16_t gate_count;
  VoidFunction implementation;  ///< null: claimed, but no source file defines it
  VoidFunction thunk;           ///< what the application gets: the implementation behind the API edge
  VoidFunction observed;        ///< what it gets where tools are on: recorded commands leave their names, too
};

struct ExtensionInfo {
  const char* name;
  std::uint32_t spec_version;
  bool is_instance;
  bool claimed;
  std::uint32_t promoted_to;  ///< core version, 0: none
};

struct FeatureMember {
  Feature feature;
  std::size_t offset;  ///< bytes from the start of the structure
};

/// A structure of VkBool32 members in the chain of VkPhysicalDeviceFeatures2. The first one in the table is
/// VkPhysicalDeviceFeatures itself (offsets relative to it).
struct FeatureStruct {
  VkStructureType type;
  std::uint16_t first_member;
  std::uint16_t member_count;
  std::size_t size;
};

/// A structure in the chain of VkPhysicalDeviceProperties2, with its claimed values. Where it has lists, the members
/// that say where they go and how much room there is are the application's.
struct PropertyStruct {
  VkStructureType type;
  std::size_t size;
  const void* values;
  std::size_t kept_first, kept_end;  ///< bytes of those members from the start of the structure; equal: there are none
};

struct FormatClaim {
  VkFormat format;
  VkFormatProperties properties;
};

/// Commands whose version or extension is claimed, sorted by name.
std::span<const EntryPoint> entry_points();
std::span<const Gate> gates(const EntryPoint& entry);
/// Indexed by Extension.
std::span<const ExtensionInfo> extension_infos();
std::span<const Feature> claimed_features();
std::span<const FeatureStruct> feature_structs();
std::span<const FeatureMember> feature_members(const FeatureStruct& structure);
std::span<const PropertyStruct> property_structs();
std::span<const FormatClaim> format_claims();

/// Null when the name is unknown or its gate is not claimed.
const EntryPoint* find_entry_point(std::string_view name);
/// Extension::kCount when unknown.
Extension find_extension(std::string_view name);
inline const ExtensionInfo& extension_info(Extension e) { return extension_infos()[static_cast<std::size_t>(e)]; }

/// True when some gate of the entry holds for the version and the extensions.
bool is_open(const EntryPoint& entry, std::uint32_t version, const ExtensionSet& extensions);

/// Writes every claimed feature structure found in the chain (VkPhysicalDeviceFeatures2 first) from `features`.
void write_feature_chain(VkPhysicalDeviceFeatures2* chain, const FeatureSet& features);
/// Writes VkPhysicalDeviceFeatures from `features`.
void write_features(VkPhysicalDeviceFeatures* out, const FeatureSet& features);
/// Collects the features that a chain enables (any structure chain, e.g. VkDeviceCreateInfo::pNext).
void read_feature_chain(const void* chain, FeatureSet& features);
void read_features(const VkPhysicalDeviceFeatures* in, FeatureSet& features);
/// Copies the claimed values into every known property structure after the first of the chain.
void write_property_chain(void* chain);

}  // namespace vitrine::icd
