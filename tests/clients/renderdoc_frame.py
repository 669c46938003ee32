"""In RenderDoc's Python: `capture PREFIX` captures a frame of vkcube; `texels FILE` replays a capture and writes the
texels of the picture that is shown at its end."""

import sys
import time

import renderdoc as rd


def capture(prefix):
    started = rd.ExecuteAndInject("/usr/bin/vkcube", "", "--c 400", [], prefix, rd.GetDefaultCaptureOptions(), False)
    assert started.result == rd.ResultCode.Succeeded, started.result
    target = rd.CreateTargetControl("", started.ident, "capture", True)
    assert target, "vkcube cannot be reached"
    target.QueueCapture(5, 1)
    end = time.monotonic() + 60
    while time.monotonic() < end:
        message = target.ReceiveMessage(None)
        if message.type in (rd.TargetControlMessageType.NewCapture, rd.TargetControlMessageType.Disconnected):
            break
    target.Shutdown()


def texels(path):
    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    file = rd.OpenCaptureFile()
    status = file.OpenFile(path, "", None)
    assert status == rd.ResultCode.Succeeded, status
    status, controller = file.OpenCapture(rd.ReplayOptions(), None)
    assert status == rd.ResultCode.Succeeded, status
    last = controller.GetRootActions()[-1]
    controller.SetFrameEvent(last.eventId, True)
    sys.stdout.buffer.write(controller.GetTextureData(last.copyDestination, rd.Subresource(0, 0, 0)))
    controller.Shutdown()
    file.Shutdown()
    rd.ShutdownReplay()


{"capture": capture, "texels": texels}[sys.argv[1]](sys.argv[2])
