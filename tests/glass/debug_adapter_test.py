#!/usr/bin/env python3
"""Tests `vitrine debug --dap` as an editor does, with a small client of the Debug Adapter Protocol, and with clients that
behave badly.

usage: debug_adapter_test.py VITRINE APPLICATION PIXELS SPEAKER
"""
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SAYS = """#version 450
#extension GL_EXT_debug_printf : require
layout(local_size_x = 4) in;
void main() {
  if (gl_LocalInvocationID.x == 2)
    debugPrintfEXT("this is %u", gl_LocalInvocationID.x);
}
"""
FILE = "tests/glass/app/fill.comp"


class Client:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)
        self.text, self.sequence, self.events = b"", 0, []

    def send(self, message):
        body = json.dumps(message).encode()
        self.socket.sendall(b"Content-Length: %d\r\n\r\n" % len(body) + body)

    def receive(self):
        while b"\r\n\r\n" not in self.text:
            self.more()
        header, _, rest = self.text.partition(b"\r\n\r\n")
        length = int(header.split(b": ")[1])
        while len(rest) < length:
            self.more()
            rest = self.text.partition(b"\r\n\r\n")[2]
        self.text = rest[length:]
        return json.loads(rest[:length])

    def more(self):
        part = self.socket.recv(65536)
        if not part:
            raise EOFError
        self.text += part

    def request(self, command, **arguments):
        self.sequence += 1
        self.send({"seq": self.sequence, "type": "request", "command": command, "arguments": arguments})
        while True:
            message = self.receive()
            if message["type"] == "response":
                assert message["request_seq"] == self.sequence, message
                return message
            self.events.append(message)

    def ask(self, command, **arguments):
        answer = self.request(command, **arguments)
        assert answer["success"], answer
        return answer["body"]

    def wait(self, name):
        while True:
            for i, event in enumerate(self.events):
                if event["event"] == name:
                    del self.events[: i + 1]
                    return event["body"]
            self.events.append(self.receive())


class Adapter(unittest.TestCase):
    vitrine, application, pixels, speaker = "", "", "", ""

    def serve(self, application=None, *arguments):
        server = subprocess.Popen([self.vitrine, "debug", "--dap", "0", "--", application or self.application, *arguments],
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (server.kill(), server.wait(), server.stdout.close(), server.stderr.close()))
        line = server.stderr.readline()
        return server, int(re.search(r":(\d+)$", line.strip())[1])

    def client(self, port):
        client = Client(port)
        self.addCleanup(client.socket.close)
        return client

    def begin(self, client, breakpoints, **launch):
        capabilities = client.ask("initialize", adapterID="vitrine")
        self.assertTrue(capabilities["supportsStepBack"])
        client.wait("initialized")
        client.ask("setBreakpoints", source={"path": os.path.abspath(FILE)}, breakpoints=breakpoints)
        client.ask("launch", **launch)
        client.ask("configurationDone")

    def at(self, client, thread):
        frame = client.ask("stackTrace", threadId=thread)["stackFrames"][0]
        return frame["name"], frame["line"], frame["id"]

    def test_session(self):
        server, port = self.serve()
        client = self.client(port)
        self.begin(client, [{"line": 8, "condition": "i == 5"}])
        stop = client.wait("stopped")
        self.assertEqual((stop["reason"], stop["threadId"]), ("breakpoint", 6))
        threads = client.ask("threads")["threads"]
        self.assertEqual((len(threads), threads[5]["name"]), (16, "invocation (5, 0, 0)"))
        frames = client.ask("stackTrace", threadId=6)["stackFrames"]
        self.assertEqual([(frame["name"], frame["line"]) for frame in frames], [("put", 8), ("main", 14)])
        scopes = client.ask("scopes", frameId=frames[0]["id"])["scopes"]
        self.assertEqual([scope["name"] for scope in scopes], ["Locals", "Globals"])
        local = client.ask("variables", variablesReference=scopes[0]["variablesReference"])["variables"]
        self.assertEqual([(row["name"], row["value"], row["type"]) for row in local], [("i", "5", "uint")])
        shared = client.ask("variables", variablesReference=scopes[1]["variablesReference"])["variables"]
        block = next(row for row in shared if row["variablesReference"] and "data" in row["value"])
        data = client.ask("variables", variablesReference=block["variablesReference"])["variables"][0]
        words = client.ask("variables", variablesReference=data["variablesReference"])["variables"]
        self.assertEqual([row["name"] for row in words], [f"[{i}]" for i in range(8)])
        self.assertEqual(client.ask("evaluate", expression="i * 2u", frameId=frames[0]["id"])["result"], "10")
        self.assertFalse(client.request("evaluate", expression="nobody", frameId=frames[0]["id"])["success"])
        client.ask("stepBack", threadId=6)
        self.assertEqual(client.wait("stopped")["reason"], "step")
        self.assertEqual(self.at(client, 6)[:2], ("main", 14))
        client.ask("stepIn", threadId=6)
        client.wait("stopped")
        self.assertEqual(self.at(client, 6)[:2], ("put", 8))
        client.ask("stepOut", threadId=6)
        client.wait("stopped")
        self.assertEqual(self.at(client, 6)[:2], ("main", 14))
        client.ask("reverseContinue", threadId=6)
        client.wait("stopped")
        self.assertEqual(self.at(client, 6)[:2], ("put", 8))
        self.assertIn("put at", client.ask("exceptionInfo", threadId=6)["description"])
        client.ask("continue", threadId=6)
        self.assertEqual(client.wait("exited")["exitCode"], 0)
        client.wait("terminated")
        client.ask("disconnect")
        self.assertEqual(server.wait(timeout=60), 0)

    def test_breakpoints_are_verified_when_a_shader_has_them(self):
        _, port = self.serve()
        client = self.client(port)
        client.ask("initialize")
        set_before = client.ask("setBreakpoints", source={"path": FILE}, breakpoints=[{"line": 8}, {"line": 100}])["breakpoints"]
        functions = client.ask("setFunctionBreakpoints", breakpoints=[{"name": "nobody"}])["breakpoints"]
        self.assertEqual([row["verified"] for row in set_before + functions], [False] * 3)
        ids = [row["id"] for row in set_before + functions]
        self.assertEqual(len(set(ids)), 3)
        client.ask("launch")
        client.ask("configurationDone")
        news = client.wait("breakpoint")
        self.assertEqual((news["reason"], news["breakpoint"]), ("changed", {"id": ids[0], "verified": True, "line": 8}))
        stop = client.wait("stopped")
        self.assertEqual(stop["hitBreakpointIds"], [ids[0]])
        # The same ones again: others for the editor, and known at once.
        again = client.ask("setBreakpoints", source={"path": FILE}, breakpoints=[{"line": 8}])["breakpoints"]
        self.assertTrue(again[0]["verified"])
        client.ask("stepIn", threadId=stop["threadId"])
        client.wait("stopped")
        self.assertFalse([event for event in client.events if event["event"] == "breakpoint"])
        client.ask("disconnect")

    def test_log_points_and_hit_counts(self):
        _, port = self.serve()
        client = self.client(port)
        self.begin(client, [{"line": 12, "logMessage": "here is {gl_GlobalInvocationID.x}"}, {"line": 14, "hitCondition": "4"}])
        output = [client.wait("output")["output"] for _ in range(16)]
        self.assertEqual(len(output), 16)
        stop = client.wait("stopped")
        self.assertEqual(stop["threadId"], 4)
        client.ask("disconnect")

    def test_functions_and_entry(self):
        _, port = self.serve()
        client = self.client(port)
        client.ask("initialize")
        client.ask("setFunctionBreakpoints", breakpoints=[{"name": "put"}])
        client.ask("launch", stopOnEntry=True)
        client.ask("configurationDone")
        self.assertEqual(client.wait("stopped")["reason"], "pause")
        self.assertEqual(self.at(client, 1)[:2], ("main", 12))
        client.ask("next", threadId=1)
        client.wait("stopped")
        client.ask("continue", threadId=1)
        client.wait("stopped")
        self.assertEqual(self.at(client, 1)[:2], ("put", 8))
        client.ask("setFunctionBreakpoints", breakpoints=[])
        verified = client.ask("setBreakpoints", source={"path": FILE}, breakpoints=[{"line": 9}, {"line": 100}])["breakpoints"]
        self.assertEqual([row["verified"] for row in verified], [True, False])
        client.ask("continue", threadId=1)

    def test_fragments(self):
        server, port = self.serve(self.pixels)
        client = self.client(port)
        client.ask("initialize")
        client.ask("setBreakpoints", source={"path": "/elsewhere/pixels.frag"}, breakpoints=[{"line": 14, "condition": "color.x < 0.0 || true"}])
        client.ask("launch")
        client.ask("configurationDone")
        stop = client.wait("stopped")
        thread = stop["threadId"]
        self.assertIn("pixel (", stop["text"])
        self.assertEqual(self.at(client, thread)[1], 14)
        client.ask("setBreakpoints", source={"path": "/elsewhere/pixels.frag"}, breakpoints=[])
        client.ask("next", threadId=thread)
        client.wait("stopped")
        frame = self.at(client, thread)[2]
        result = client.ask("evaluate", expression="result", frameId=frame)["result"]
        self.assertRegex(result, r"^\(.*, .*, .*, .*\)$")
        client.ask("continue", threadId=thread)
        client.wait("exited")
        self.assertEqual(server.wait(timeout=60), 0)

    def test_images(self):
        server, port = self.serve(self.pixels)
        client = self.client(port)
        client.ask("initialize")
        client.ask("setBreakpoints", source={"path": "/elsewhere/pixels.comp"}, breakpoints=[{"line": 9}])
        client.ask("launch")
        client.ask("configurationDone")
        frame = self.at(client, client.wait("stopped")["threadId"])[2]
        shared = client.ask("scopes", frameId=frame)["scopes"][1]
        variables = client.ask("variables", variablesReference=shared["variablesReference"])["variables"]
        image = next(row for row in variables if row["name"] == "to")
        self.assertEqual(image["value"], "R8G8B8A8_UNORM, 16 x 16")
        rows = client.ask("variables", variablesReference=image["variablesReference"])["variables"]
        self.assertEqual([row["name"] for row in rows], [f"row {i}" for i in range(16)])
        texels = client.ask("variables", variablesReference=rows[5]["variablesReference"])["variables"]
        self.assertEqual((texels[3]["name"], texels[3]["evaluateName"]), ("[3, 5]", "to[3, 5]"))
        changed = client.ask("setVariable", variablesReference=rows[5]["variablesReference"], name="[3, 5]", value="{1, 0.5, 0, 1}")
        self.assertEqual(changed["value"], "(1.0, 0.5019608, 0.0, 1.0)")
        client.ask("disconnect")
        server.wait(timeout=60)

    def test_exceptions(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        shader, module = os.path.join(folder.name, "says.comp"), os.path.join(folder.name, "says.comp.spv")
        with open(shader, "w", encoding="utf-8") as file:
            file.write(SAYS)
        subprocess.run(["glslangValidator", "-V", "-g", "--quiet", "--target-env", "vulkan1.1", "-o", module, shader], check=True)
        server, port = self.serve(self.speaker, module)
        client = self.client(port)
        filters = client.ask("initialize")["exceptionBreakpointFilters"]
        self.assertEqual([row["filter"] for row in filters], ["printf", "nan", "findings"])
        client.ask("setExceptionBreakpoints", filters=["printf"])
        client.ask("launch")
        client.ask("configurationDone")
        stop = client.wait("stopped")
        self.assertEqual(stop["reason"], "exception")
        info = client.ask("exceptionInfo", threadId=stop["threadId"])
        self.assertEqual(info["exceptionId"], "printf")
        self.assertIn("printf: this is 2", info["description"])
        self.assertEqual(self.at(client, stop["threadId"])[1], 6)
        client.ask("setExceptionBreakpoints", filters=[])
        client.ask("continue", threadId=stop["threadId"])
        client.wait("exited")
        server.wait(timeout=60)

    def test_findings(self):
        server, port = self.serve(self.application, "1", "12")
        client = self.client(port)
        client.ask("initialize")
        client.ask("setExceptionBreakpoints", filters=["findings"])
        client.ask("launch")
        client.ask("configurationDone")
        stop = client.wait("stopped")
        self.assertEqual(stop["reason"], "exception")
        info = client.ask("exceptionInfo", threadId=stop["threadId"])
        self.assertEqual(info["exceptionId"], "finding")
        self.assertIn("out-of-bounds-store", info["description"])
        self.assertEqual(self.at(client, stop["threadId"])[:2], ("put", 8))
        client.ask("setExceptionBreakpoints", filters=[])
        client.ask("continue", threadId=stop["threadId"])
        client.wait("exited")
        server.wait(timeout=60)

    def test_other_values_of_wholes(self):
        _, port = self.serve()
        client = self.client(port)
        self.begin(client, [{"line": 14, "condition": "i == 2u"}])
        client.wait("stopped")
        frame = self.at(client, 3)[2]
        shared = client.ask("scopes", frameId=frame)["scopes"][1]
        block = next(row for row in client.ask("variables", variablesReference=shared["variablesReference"])["variables"]
                     if row["variablesReference"] and "data" in row["value"])
        changed = client.ask("setVariable", variablesReference=block["variablesReference"], name="data", value="{8, 7, 6, 5, 4, 3, 2, 1}")
        self.assertEqual(changed["value"], "{8, 7, 6, 5, 4, 3, 2, 1}")
        words = client.ask("variables", variablesReference=changed["variablesReference"])["variables"]
        self.assertEqual([row["value"] for row in words], list("87654321"))
        self.assertEqual(client.ask("setExpression", expression="data", value="{5, 6}", frameId=frame)["value"], "{5, 6, 6, 5, 4, 3, 2, 1}")
        self.assertFalse(client.request("setExpression", expression="data", value="5", frameId=frame)["success"])
        client.ask("disconnect")

    def test_other_values_and_data_breakpoints(self):
        server, port = self.serve()
        client = self.client(port)
        self.begin(client, [{"line": 14, "condition": "i == 2u"}])
        stop = client.wait("stopped")
        self.assertEqual(stop["threadId"], 3)
        frame = self.at(client, 3)[2]
        local, shared = client.ask("scopes", frameId=frame)["scopes"]
        changed = client.ask("setVariable", variablesReference=local["variablesReference"], name="i", value="3u + 3u")
        self.assertEqual((changed["value"], changed["type"]), ("6", "uint"))
        block = next(row for row in client.ask("variables", variablesReference=shared["variablesReference"])["variables"]
                     if row["variablesReference"] and "data" in row["value"])
        data = client.ask("variables", variablesReference=block["variablesReference"])["variables"][0]
        words = client.ask("variables", variablesReference=data["variablesReference"])["variables"]
        self.assertEqual(words[6]["evaluateName"], "data[6]")
        changed = client.ask("setVariable", variablesReference=data["variablesReference"], name="[7]", value="70")
        self.assertEqual(changed["value"], "70")
        self.assertEqual(client.ask("setExpression", expression="data[5]", value="data[7]", frameId=frame)["value"], "70")
        self.assertFalse(client.request("setVariable", variablesReference=local["variablesReference"], name="i", value="nobody")["success"])
        self.assertFalse(client.request("setExpression", expression="1", value="2", frameId=frame)["success"])
        watched = client.ask("dataBreakpointInfo", variablesReference=data["variablesReference"], name="[6]")
        self.assertEqual((watched["description"], watched["accessTypes"]), ("data[6]", ["write"]))
        self.assertIsNone(client.ask("dataBreakpointInfo", name="nobody", frameId=frame)["dataId"])
        answer = client.ask("setDataBreakpoints", breakpoints=[{"dataId": watched["dataId"]}, {"dataId": "x"}])["breakpoints"]
        self.assertEqual([row["verified"] for row in answer], [True, False])
        client.ask("setBreakpoints", source={"path": os.path.abspath(FILE)}, breakpoints=[])
        client.ask("continue", threadId=3)
        stop = client.wait("stopped")
        self.assertEqual((stop["reason"], stop["description"]), ("data breakpoint", "watch 2: data[6] has changed: 0 -> 6"))
        self.assertEqual(self.at(client, stop["threadId"])[:2], ("put", 8))
        client.ask("setDataBreakpoints", breakpoints=[])
        client.ask("continue", threadId=3)
        client.wait("exited")
        server.wait(timeout=60)

    def test_another_color(self):
        server, port = self.serve(self.pixels)
        client = self.client(port)
        client.ask("initialize")
        client.ask("setBreakpoints", source={"path": "/elsewhere/pixels.frag"},
                   breakpoints=[{"line": 20, "condition": "gl_FragCoord.x == 5.5 && gl_FragCoord.y == 6.5"}])
        client.ask("launch")
        client.ask("configurationDone")
        thread = client.wait("stopped")["threadId"]
        frame = self.at(client, thread)[2]
        self.assertEqual(client.ask("setExpression", expression="result", value="vec4(0.0, 1.0, 0.0, 1.0)", frameId=frame)["value"],
                         "(0.0, 1.0, 0.0, 1.0)")
        client.ask("continue", threadId=thread)
        client.wait("exited")
        server.wait(timeout=60)
        # What is fetched at the line is added: its red, and more than 1 of the others.
        lines = server.stdout.read().splitlines()
        self.assertIn("last 0 5 6 0xff00ff60", lines)
        self.assertIn("last 0 5 5 0xff40809f", lines)

    def test_pause(self):
        _, port = self.serve(self.application, "3000")
        client = self.client(port)
        client.ask("initialize")
        client.ask("launch")
        client.ask("configurationDone")
        time.sleep(0.5)
        client.ask("pause", threadId=1)
        stop = client.wait("stopped")
        self.assertEqual(stop["reason"], "pause")
        self.assertEqual(self.at(client, stop["threadId"])[:2], ("main", 12))
        client.ask("disconnect")

    def test_disconnect_in_the_middle(self):
        server, port = self.serve()
        client = self.client(port)
        self.begin(client, [{"line": 8}])
        client.wait("stopped")
        client.socket.close()
        self.assertEqual(server.wait(timeout=60), 0)

    def test_rubbish(self):
        server, port = self.serve()
        for text in (b"\0\xff" * 5000, b"GET / HTTP/1.0\r\n\r\n", b"Content-Length: 5\r\n\r\n[1,2]", b"Content-Length: 999999999999999999999\r\n\r\n",
                     b"Content-Length: -1\r\n\r\n", b"Content-Length: 3\r\n\r\n{{{", b""):
            bad = socket.create_connection(("127.0.0.1", port), timeout=60)
            bad.sendall(text)
            if text:
                self.assertEqual(self.rest_of(bad), b"", text[:20])
            bad.close()
            time.sleep(0.05)
        client = self.client(port)
        for command, arguments in (("nonsense", {}), ("variables", {"variablesReference": 7}), ("stackTrace", {"threadId": "x"}),
                                   ("scopes", {}), ("evaluate", {"expression": 3}), ("continue", {}), ("source", {})):
            self.assertFalse(client.request(command, **arguments)["success"], command)
        client.ask("threads")
        client.ask("setBreakpoints", breakpoints=[1, "x", {"line": -5}, {"line": 1e99}], source=7)
        client.send({"seq": "x", "command": ["y"], "arguments": 3})
        client.receive()
        self.begin(client, [{"line": 8, "condition": ")("}, {"line": 12, "condition": "i.x.y.z"}, {"line": 14}])
        client.wait("stopped")
        for arguments in ({"threadId": 0}, {"threadId": 99999}, {"threadId": -1}):
            client.request("stackTrace", **arguments)
            client.request("scopes", frameId=arguments["threadId"])
        client.ask("continue", threadId=99999)
        client.wait("exited")
        self.assertEqual(server.wait(timeout=60), 0)

    def rest_of(self, connection):
        try:
            return connection.recv(1000)
        except ConnectionResetError:
            return b""

    def test_two_clients(self):
        server, port = self.serve()
        client = self.client(port)
        self.begin(client, [{"line": 8}])
        client.wait("stopped")
        second = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.assertEqual(self.rest_of(second), b"")
        second.close()
        self.assertEqual(self.at(client, 1)[:2], ("put", 8))
        client.ask("disconnect")
        self.assertEqual(server.wait(timeout=60), 0)

    def test_port_in_use(self):
        _, port = self.serve()
        for word in (str(port), "x", "99999"):
            result = subprocess.run([self.vitrine, "debug", "--dap", word, "--", self.application], capture_output=True, text=True,
                                    check=False, timeout=60)
            self.assertEqual(result.returncode, 2)
            self.assertRegex(result.stderr, "not free|no port")


if __name__ == "__main__":
    Adapter.vitrine, Adapter.application, Adapter.pixels, Adapter.speaker = sys.argv[1:5]
    unittest.main(argv=sys.argv[:1])
