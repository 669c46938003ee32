// Device addresses in compute shaders: outside of every live buffer, and where something was that is gone.
#include "spirv/observed_command.h"
#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

/// The application's buffers are `live`; what was at `gone` has been destroyed.
struct Command : spirv::ObservedCommand {
  std::string resource(std::uint32_t, std::uint32_t) const override { return {}; }
  spirv::AddressRange buffers_at(std::uint64_t address) const override {
    return address >= live.begin && address < live.end ? live : spirv::AddressRange{};
  }
  std::string departed(std::uint32_t, std::uint32_t) const override { return {}; }
  std::string departed(std::uint64_t address) const override {
    return address >= gone.begin && address < gone.end ? "buffer 'old', destroyed after submission 3" : std::string();
  }
  spirv::AddressRange live, gone;
};

/// Memory of 64 words in which a buffer has the first 32 and another had the last 16; 4 invocations read word
/// `index`(i) of it.
std::vector<std::string> found(const std::string& index) {
  std::vector<std::uint64_t> words(40), result(8);
  const auto address = reinterpret_cast<std::uint64_t>(words.data() + 4);
  spirv::add_addresses(reinterpret_cast<const std::byte*>(words.data()), words.size() * 8);
  Command command;
  command.live = {address, address + 32 * 4};
  command.gone = {address + 48 * 4, address + 64 * 4};
  result[0] = address;
  spirv::Descriptor descriptor;
  descriptor.data = reinterpret_cast<std::byte*>(result.data());
  descriptor.size = result.size() * 8;
  spirv::ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  table.command = &command;
  spirv::SetLayoutInfo set;
  spirv::BindingInfo buffer;
  buffer.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  set.bindings = {buffer};
  auto texts = found_with(table, set,
                          "#version 450\n#extension GL_EXT_buffer_reference : require\n"
                          "#extension GL_ARB_gpu_shader_int64 : require\n"
                          "layout(local_size_x = 4) in;\n"
                          "layout(buffer_reference, std430) buffer Words { uint w[]; };\n"
                          "layout(std430, binding = 0) buffer B { Words words; uint pad[6]; uint result[4]; };\n"
                          "void main() { uint i = gl_LocalInvocationIndex; result[i] = words.w[" +
                              index + "]; }\n");
  spirv::remove_addresses(reinterpret_cast<const std::byte*>(words.data()));
  // Addresses differ from run to run.
  for (std::string& text : texts) {
    const std::size_t begin = text.find("0x"), end = text.find(',', begin);
    if (begin != std::string::npos) text.replace(begin, end - begin, "ADDRESS");
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Addresses, OfLiveBuffersAreFine) { EXPECT_EQ(found("i * 8u + 7u"), Texts{}); }

TEST(Addresses, BesideEveryBufferAreTold) {
  EXPECT_EQ(found("29u + i"),
            Texts{"bad-device-address x1 at 3: load of 4 bytes at address ADDRESS, which is not inside "
                  "of a live buffer"});
}

TEST(Addresses, OfWhatIsGoneSayWhatItWas) {
  EXPECT_EQ(found("46u + i"),
            (Texts{"bad-device-address x2 at 0: load of 4 bytes at address ADDRESS, which is not inside "
                   "of a live buffer",
                   "freed-device-address x2 at 2: load of 4 bytes at address ADDRESS, inside of buffer "
                   "'old', destroyed after submission 3"}));
}

}  // namespace
}  // namespace vitrine::glass::test
