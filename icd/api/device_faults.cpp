// What an application can learn of a lost device, and of the addresses of its objects (Vulkan 1.3.239, Debugging:
// Device Fault; VK_EXT_device_address_binding_report).
#include <algorithm>
#include <cstring>

#include "glass/bug/capture.h"
#include "glass/report/report.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/sync.h"

namespace vitrine::icd {
namespace {

/// As much of the text as fits, ended by a zero.
void copy_text(std::string_view text, char (&to)[VK_MAX_DESCRIPTION_SIZE]) {
  const std::size_t size = std::min(text.size(), sizeof to - 1);
  std::memcpy(to, text.data(), size);
  to[size] = 0;
}

/// "vendor-specific binary crash dump": the header that the specification asks for, and behind it the bug file, where
/// commands are captured (docs/glass/bugfile.md), else what we know of the fault as a report in JSON
/// (docs/glass/report.md section 2). Empty: no shader is at fault.
std::string vendor_binary(const Device& device) {
  if (!device.features.test(Feature::deviceFaultVendorBinary) || !device.loss.of_shader) return {};
  glass::Finding finding;
  finding.rule = &glass::rule("endless-shader");
  finding.message = device.loss.reason;
  for (const DeviceLoss::Call& call : device.loss.calls) finding.message.append("\n").append(call.text);
  finding.address.spirv_id = device.loss.spirv_id;
  const VkPhysicalDeviceProperties& properties = device.physical_device.properties;
  VkDeviceFaultVendorBinaryHeaderVersionOneEXT header{};  // names of application and engine: none
  header.headerSize = sizeof header;
  header.headerVersion = VK_DEVICE_FAULT_VENDOR_BINARY_HEADER_VERSION_ONE_EXT;
  header.vendorID = properties.vendorID;
  header.deviceID = properties.deviceID;
  header.driverVersion = properties.driverVersion;
  std::memcpy(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE);
  const std::string start(reinterpret_cast<const char*>(&header), sizeof header);
  const glass::bug::Captures* const captures = glass::bug::captures();
  if (const std::string file = captures ? captures->file_of_loss(&device) : ""; !file.empty()) return start + file;
  return start + glass::to_report(glass::ReportFormat::kJson, {&finding, 1});
}

}  // namespace

void report_binding(Device& device, ObjectRef object, const void* address, VkDeviceSize bytes,
                    VkDeviceAddressBindingTypeEXT type) {
  if (!device.features.test(Feature::reportAddressBinding) || !address) return;
  Instance& instance = device.physical_device.instance;
  auto binding = make_struct<VkDeviceAddressBindingCallbackDataEXT>();
  binding.baseAddress = reinterpret_cast<VkDeviceAddress>(address);
  binding.size = bytes;
  binding.bindingType = type;
  const std::string name = name_of(instance, object);
  auto info = make_struct<VkDebugUtilsObjectNameInfoEXT>();
  info.objectType = object.type;
  info.objectHandle = object.handle;
  info.pObjectName = name.empty() ? nullptr : name.c_str();
  auto data = make_struct<VkDebugUtilsMessengerCallbackDataEXT>(&binding);
  data.pMessageIdName = "address-binding";
  data.pMessage = type == VK_DEVICE_ADDRESS_BINDING_TYPE_BIND_EXT ? "an object got its addresses"
                                                                  : "an object gave up its addresses";
  data.objectCount = 1;
  data.pObjects = &info;
  send_message(instance, VK_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT,
               VK_DEBUG_UTILS_MESSAGE_TYPE_DEVICE_ADDRESS_BINDING_BIT_EXT, data);
}

namespace entry {

/// Vendor information: the call stack, innermost first, with the SPIR-V id of the instruction and the line.
VKAPI_ATTR VkResult VKAPI_CALL GetDeviceFaultInfoEXT(VkDevice device, VkDeviceFaultCountsEXT* counts,
                                                     VkDeviceFaultInfoEXT* info) {
  Device& d = from_handle<Device>(device);
  const std::lock_guard lock(d.sync_mutex);
  const auto calls = static_cast<std::uint32_t>(d.loss.calls.size());
  const std::uint32_t room = info ? counts->vendorInfoCount : calls;
  const std::string binary = vendor_binary(d);
  const VkDeviceSize bytes = info && info->pVendorBinaryData ? counts->vendorBinarySize : binary.size();
  // No fault so far has an address.
  counts->addressInfoCount = 0;
  counts->vendorBinarySize = std::min<VkDeviceSize>(bytes, binary.size());
  counts->vendorInfoCount = std::min(calls, room);
  if (!info) return VK_SUCCESS;
  copy_text(d.loss.reason, info->description);
  for (std::uint32_t i = 0; info->pVendorInfos && i < counts->vendorInfoCount; ++i) {
    copy_text(d.loss.calls[i].text, info->pVendorInfos[i].description);
    info->pVendorInfos[i].vendorFaultCode = d.loss.spirv_id;
    info->pVendorInfos[i].vendorFaultData = d.loss.calls[i].line;
  }
  if (info->pVendorBinaryData) std::memcpy(info->pVendorBinaryData, binary.data(), counts->vendorBinarySize);
  return room < calls || bytes < binary.size() ? VK_INCOMPLETE : VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd
