// Vectors of words as the storage buffers of a shader, and dispatches over them.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "spirv/compile.h"
#include "spirv/program.h"

namespace vitrine::spirv::test {

/// Words as the buffer at slot `slot` of set 0.
class Buffers {
 public:
  Buffers(std::initializer_list<std::vector<std::uint32_t>*> buffers) {
    for (std::vector<std::uint32_t>* words : buffers) {
      Descriptor descriptor;
      descriptor.data = reinterpret_cast<std::byte*>(words->data());
      descriptor.size = words->size() * 4;
      descriptors_.push_back(descriptor);
    }
    table.set[0] = descriptors_.data();
    table.set_size[0] = static_cast<std::uint32_t>(descriptors_.size());
  }
  ResourceTable table;

 private:
  std::vector<Descriptor> descriptors_;
};

/// Compiles a compute module and dispatches `groups` x 1 x 1 workgroups of it over buffer 0 of set 0, which holds
/// `words`. Refusals and faults fail the test; returns false when there was nothing to dispatch.
inline bool dispatch_over(std::vector<std::uint32_t>& words, const std::vector<std::uint32_t>& module,
                          const CompileOptions& options, std::uint32_t groups) {
  const auto shader = compile(module, options);
  EXPECT_TRUE(shader) << shader.message();
  if (!shader) return false;
  const Buffers buffers{&words};
  Fault fault;
  const BoundShader bound(*shader.value(), buffers.table, fault);
  const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {groups, 1, 1};
  dispatch(bound, base, counts);
  EXPECT_FALSE(fault.raised) << fault.message;
  return true;
}

}  // namespace vitrine::spirv::test
