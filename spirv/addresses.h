// Host memory that shaders may reach through pointers (storage class PhysicalStorageBuffer): a pointer is the host
// address. Accesses elsewhere read 0 and store nothing, so a wild pointer cannot harm the process. Process-wide: what a
// pointer may reach does not depend on the device that it came from.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vitrine::spirv {

struct AddressRange {
  std::uint64_t begin = 0, end = 0;
};

/// May throw std::bad_alloc. Any thread.
void add_addresses(const std::byte* data, std::uint64_t size);
/// `data` of an earlier add_addresses().
void remove_addresses(const std::byte* data) noexcept;

/// The range that contains `address`; empty if there is none. Any thread; cheap while nothing is added or removed.
AddressRange find_addresses(std::uint64_t address);

}  // namespace vitrine::spirv
