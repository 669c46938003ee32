// A debugger that follows a script: commands of the prompt, what they say is kept.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "glass/debug/commands.h"
#include "glass/debug/tool.h"

namespace vitrine::glass::debug::test {

class Script : public Face {
 public:
  explicit Script(std::vector<std::string> lines) : lines_(lines.begin(), lines.end()) {}

  void stopped(Engine& engine, const Stop& stop, std::unique_lock<std::mutex>&) override {
    said.push_back(stop_text(engine, stop));
    while (!engine.going()) {
      if (lines_.empty()) {
        engine.go({Motion::Kind::kDetach, false});
        return;
      }
      const std::string line = lines_.front();
      lines_.pop_front();
      if (std::string text = command(engine, line); !text.empty()) said.push_back(std::move(text));
    }
  }
  void output(const std::string& text) override { said.push_back("log: " + text + "\n"); }

  /// Everything that was said, stops and answers, as one text.
  std::string text() const {
    std::string all;
    for (const std::string& one : said) all += one;
    return all;
  }

  std::vector<std::string> said;

 private:
  std::deque<std::string> lines_;
};

/// A tool with a script; the engine lives as long.
struct ScriptedDebugger {
  explicit ScriptedDebugger(std::vector<std::string> lines, Shown shown = Shown::kRehearsal)
      : script(std::move(lines)), engine(script) {
    engine.start();
    tool = make_tool(engine, shown);
  }
  Script script;
  Engine engine;
  std::unique_ptr<Tool> tool;
};

}  // namespace vitrine::glass::debug::test
