// A lowered function with its resources: inputs are set and outputs read by location.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>

#include "spirv/lower/lower.h"
#include "spirv/program.h"
#include "tests/spirv/buffers.h"
#include "tests/spirv/ir_builder.h"

namespace vitrine::spirv::test {

struct ShaderRun {
  explicit ShaderRun(Builder& builder, const ResourceTable& table = {}) {
    auto lowered = lower(std::move(builder.function));
    if (!lowered.ok()) throw std::runtime_error(lowered.message());
    shader = lowered.take();
    bound.emplace(*shader, table, fault);
    wave.bind(*bound);
  }
  base::WaveRegister* input(std::uint32_t location) {
    for (const InterfaceSlot& slot : shader->interface().inputs)
      if (slot.location == location) return &wave.input(slot.reg);
    return nullptr;
  }
  const base::WaveRegister& output(std::uint32_t location) {
    for (const InterfaceSlot& slot : shader->interface().outputs)
      if (slot.location == location) return wave.output(slot.reg);
    throw std::runtime_error("no such output");
  }
  void dispatch_groups(std::uint32_t x) {
    const std::uint32_t base[3] = {}, groups[3] = {x, 1, 1};
    dispatch(*bound, base, groups);
  }

  Fault fault;
  std::unique_ptr<Shader> shader;
  std::optional<BoundShader> bound;
  WaveRunner wave;
};

}  // namespace vitrine::spirv::test
