// Commands that break rules by themselves, whatever their shaders do.
#pragma once

#include <functional>
#include <string>

#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {

/// One finding for each rule, kind of command, pipeline name and message, until they are taken.
class BrokenCommands {
 public:
  void add(const spirv::ObservedCommand& command, const Rule& rule, const std::string& message) {
    const std::string told = std::string(command.name) + '\n' + command.pipeline + '\n' + message;
    const Order order(command.submission, command.command, Id{});
    places_.add({std::hash<std::string>()(told), rule.id}, 1, order, [&] {
      Finding finding;
      finding.rule = &rule;
      finding.message = message;
      finding.address.submission = command.submission;
      finding.address.command = command.command;
      finding.address.command_name = command.name;
      finding.address.labels = command.labels;
      finding.address.pipeline = command.pipeline;
      return finding;
    });
  }
  void take(std::vector<Finding>& to) { places_.take(to); }

 private:
  Places places_;
};

}  // namespace vitrine::glass::sanitize
