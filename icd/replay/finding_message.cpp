// Findings as messages to the application (Vulkan 1.3.239, Debugging: VK_EXT_debug_utils).
#include <algorithm>

#include "glass/report/report.h"
#include "icd/edge/util.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {
namespace {

VkDebugUtilsMessageSeverityFlagBitsEXT severity_of(glass::Severity severity) {
  switch (severity) {
    case glass::Severity::kError:
      return VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    case glass::Severity::kWarning:
      return VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    default:
      return VK_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT;
  }
}

/// FNV-1a: the number of a rule stays the same for ever.
std::int32_t number_of(std::string_view id) {
  std::uint32_t hash = 0x811c9dc5u;
  for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193u;
  return static_cast<std::int32_t>(hash);
}

/// What a shader prints is no fault, and comes as the shader wrote it.
bool is_print(const glass::Finding& finding) { return std::string_view(finding.rule->id) == "printf"; }

std::string text_of(const glass::Finding& finding) {
  if (is_print(finding)) return finding.message;
  std::string text = glass::report_entry(glass::ReportFormat::kText, finding);
  text.erase(text.find_last_not_of('\n') + 1);
  return text;
}

/// The objects that a finding is about, and their names.
class ObjectNames {
 public:
  explicit ObjectNames(Instance& instance) : instance_(instance) {}

  void add(ObjectRef object) {
    if (!object.handle) return;
    auto info = make_struct<VkDebugUtilsObjectNameInfoEXT>();
    info.objectType = object.type;
    info.objectHandle = object.handle;
    names_.push_back(name_of(instance_, object));
    infos_.push_back(info);
  }
  std::span<const VkDebugUtilsObjectNameInfoEXT> infos() {
    for (std::size_t i = 0; i < infos_.size(); ++i)
      infos_[i].pObjectName = names_[i].empty() ? nullptr : names_[i].c_str();
    return infos_;
  }

 private:
  Instance& instance_;
  std::vector<std::string> names_;
  std::vector<VkDebugUtilsObjectNameInfoEXT> infos_;
};

ObjectNames objects_of(Device& device, const ObservedReplay& observed, const glass::Address& address) {
  ObjectNames out(device.physical_device.instance);
  const auto found =
      std::lower_bound(observed.objects.begin(), observed.objects.end(), address.command,
                       [](const auto& objects, std::uint32_t number) { return objects.command < number; });
  const bool known = address.submission == observed.submission && found != observed.objects.end();
  if (known && found->command == address.command) {
    for (const ObjectRef& shaders : found->shaders) out.add(shaders);
    out.add(found->command_buffer);
  }
  out.add(ref(device.queue));
  out.add(ref(device));
  return out;
}

std::vector<VkDebugUtilsLabelEXT> to_labels(std::span<const std::string> names) {
  std::vector<VkDebugUtilsLabelEXT> out(names.size(), make_struct<VkDebugUtilsLabelEXT>());
  for (std::size_t i = 0; i < names.size(); ++i) out[i].pLabelName = names[i].c_str();
  return out;
}

}  // namespace

void send_finding(Device& device, const ObservedReplay& observed, const glass::Finding& finding) {
  const std::string text = text_of(finding);
  ObjectNames names = objects_of(device, observed, finding.address);
  const std::span<const VkDebugUtilsObjectNameInfoEXT> objects = names.infos();
  // An address has the labels of the queue first.
  const std::span<const std::string> labels = finding.address.labels;
  const std::size_t of_queue = std::min(labels.size(), observed.queue_labels.size());
  const auto queue_labels = to_labels(labels.first(of_queue)), buffer_labels = to_labels(labels.subspan(of_queue));
  auto data = make_struct<VkDebugUtilsMessengerCallbackDataEXT>();
  data.pMessageIdName = finding.rule->id;
  data.messageIdNumber = number_of(finding.rule->id);
  data.pMessage = text.c_str();
  data.queueLabelCount = static_cast<std::uint32_t>(queue_labels.size());
  data.pQueueLabels = queue_labels.data();
  data.cmdBufLabelCount = static_cast<std::uint32_t>(buffer_labels.size());
  data.pCmdBufLabels = buffer_labels.data();
  data.objectCount = static_cast<std::uint32_t>(objects.size());
  data.pObjects = objects.data();
  send_message(
      device.physical_device.instance, severity_of(finding.rule->severity),
      is_print(finding) ? VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT : VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      data);
}

}  // namespace vitrine::icd
