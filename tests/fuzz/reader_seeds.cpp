// What the readers' fuzzer begins with: an input that each reader takes, or several.
#include <span>

#include "glass/bug/file.h"
#include "glass/bug/pack.h"
#include "glass/report/report.h"
#include "tests/fuzz/readers.h"
#include "tests/glass/bug/bugs.h"
#include "tests/glass/report/findings.h"

namespace vitrine::fuzz {
namespace {

std::string framed(const std::string& body) {
  return "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// A session of an editor.
std::string protocol() {
  std::string text;
  const auto request = [&](const char* command, const char* arguments) {
    text += framed(std::string(R"({"seq":1,"type":"request","command":")") + command + R"(","arguments":)" + arguments +
                   "}");
  };
  request("initialize", R"({"adapterID":"vitrine","linesStartAt1":true,"columnsStartAt1":true})");
  request("launch", R"({"program":"a","stopOnEntry":true})");
  request(
      "setBreakpoints",
      R"({"source":{"path":"a.comp"},"breakpoints":[{"line":3,"condition":"x > 3","hitCondition":">= 2","logMessage":"{x}"}]})");
  request("setFunctionBreakpoints", R"({"breakpoints":[{"name":"pixel 3,7"}]})");
  request("setExceptionBreakpoints", R"({"filters":["nan","finding"]})");
  request("configurationDone", "{}");
  request("threads", "{}");
  request("stackTrace", R"({"threadId":1,"startFrame":0,"levels":20})");
  request("scopes", R"({"frameId":1})");
  request("variables", R"({"variablesReference":1,"start":0,"count":4})");
  request("evaluate", R"({"expression":"x.y[3]","frameId":1,"context":"watch"})");
  request("setVariable", R"({"variablesReference":1,"name":"x","value":"3"})");
  request("dataBreakpointInfo", R"({"variablesReference":1,"name":"x"})");
  request("setDataBreakpoints", R"({"breakpoints":[{"dataId":"1","accessType":"write"}]})");
  request("source", R"({"sourceReference":1})");
  request("stepBack", R"({"threadId":1,"granularity":"line"})");
  request("disconnect", R"({"terminateDebuggee":true})");
  return text;
}

constexpr char kRequests[] =
    R"({"id":1,"request":"breakpoints","file":"a.comp","list":[{"line":3,"condition":"i == 2u","hits":"% 5","message":"{i}"}]})"
    "\n"
    R"({"id":2,"request":"functions","list":[{"name":"workgroup 1,0,0"},{"name":"vertex 3"}]})"
    "\n"
    R"({"id":3,"request":"catch","list":["nan","printf"]})"
    "\n"
    R"({"id":4,"request":"command","text":"break a.comp:12 if x > 3"})"
    "\n"
    R"({"id":5,"request":"watches","list":[{"lane":0,"frame":0,"text":"x"}]})"
    "\n"
    R"({"id":6,"request":"go","how":"step","lane":3,"backward":true})"
    "\n";

constexpr char kTracefile[] =
    "TN:\nSF:a.comp\nFN:9,f(vf3;\nFN:1,main\nFNDA:0,f(vf3;\nFNDA:2,main\nFNF:2\nFNH:1\nBRDA:3,0,0,2\nBRDA:3,0,1,-\nBRF:"
    "2\n"
    "BRH:1\nDA:1,2\nDA:9,0,checksum\nLF:2\nLH:1\nend_of_record\nSF:b,c.frag\nDA:5,1\nend_of_record\n";

constexpr char kCounters[] =
    R"({"version":1,"frames":3,"pipelines":{"gauss":{"instructions":1200,"most_waves":7,"source":"a.comp"},"b":{"instructions":1}},)"
    R"("lines":{"a.comp":{"3":17}},"sources":{"a.comp":"void main() {\n}\n"}})";

constexpr char kDigests[] =
    R"({"submission":1,"command":2,"name":"vkCmdDraw","labels":["frame"],"pipeline":"p","memory":{"1":"0123456789abcdef"}})"
    "\n"
    R"({"submission":1,"command":3,"name":"vkCmdDispatch","labels":[],"pipeline":"","memory":{"1":"0","2":"f"},"differs":3})"
    "\n";

std::string blocks(char format) {
  std::string bytes(1, format);
  for (int i = 0; i < 64; ++i) bytes += static_cast<char>(i * 37 + format);
  return bytes;
}

}  // namespace

std::vector<std::string> reader_seeds() {
  const glass::Finding findings[] = {glass::whole_finding(), glass::bare_finding(), glass::note_finding(),
                                     glass::race_finding()};
  const std::string bug = glass::bug::to_file(glass::bug::small_bug());
  const std::pair<char, std::string> seeds[] = {
      {1, kTracefile},
      {2, glass::to_report(glass::ReportFormat::kJson, findings)},
      {3, kCounters},
      {4, kDigests},
      {5, glass::bug::unpack(bug).take()},
      {6, bug},
      {7, "a.comp:12 if x.y[3] > -2.5e3f && (!b || int(c) % 4 == 0x1fu)"},
      {7, "mix(a.xyz, vec3(1.0), float(i)) * pow(2.0, 3.0) + {1, 2}.x"},
      {7, "pixel 3,7"},
      {8, protocol()},
      {9, kRequests},
  };
  std::vector<std::string> inputs;
  for (const auto& [reader, text] : seeds) inputs.push_back(reader + text);
  for (int format = 0; format < 54; ++format) inputs.push_back('\0' + blocks(static_cast<char>(format)));
  return inputs;
}

}  // namespace vitrine::fuzz
