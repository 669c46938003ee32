"""The benchmark of a corpus: a module that runs is timed and its outputs compared; one that is broken ends nothing."""

import pathlib
import subprocess
import shutil
import sys
import tempfile

MODULE = """
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %id
OpExecutionMode %main LocalSize 64 1 1
OpDecorate %id BuiltIn GlobalInvocationId
OpDecorate %array ArrayStride 4
OpMemberDecorate %block 0 Offset 0
OpDecorate %block BufferBlock
OpDecorate %buffer DescriptorSet 0
OpDecorate %buffer Binding 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%uint = OpTypeInt 32 0
%v3 = OpTypeVector %uint 3
%v3_ptr = OpTypePointer Input %v3
%id = OpVariable %v3_ptr Input
%array = OpTypeRuntimeArray %uint
%block = OpTypeStruct %array
%block_ptr = OpTypePointer Uniform %block
%uint_ptr = OpTypePointer Uniform %uint
%buffer = OpVariable %block_ptr Uniform
%zero = OpConstant %uint 0
%main = OpFunction %void None %fn
%entry = OpLabel
%all = OpLoad %v3 %id
%x = OpCompositeExtract %uint %all 0
%at = OpAccessChain %uint_ptr %buffer %zero %x
%old = OpLoad %uint %at
%new = OpIMul %uint %old %old
OpStore %at %new
OpReturn
OpFunctionEnd
"""


def main():
    bench, lavapipe = sys.argv[1:]
    if shutil.which("spirv-as") is None or not pathlib.Path(lavapipe).exists():
        return 77
    with tempfile.TemporaryDirectory() as folder:
        good = pathlib.Path(folder, "good.spv")
        subprocess.run(["spirv-as", "--target-env", "spv1.0", "-o", good, "-"], input=MODULE.encode(), check=True)
        pathlib.Path(folder, "broken.spv").write_bytes(good.read_bytes()[:44])
        run = subprocess.run([bench, f"--corpus={folder}", "--rounds=1"], capture_output=True, text=True)
    print(run.stdout, run.stderr)
    wanted = ["1 modules timed", "0 with different outputs", "geometric mean", "good: "]
    missing = [text for text in wanted if text not in run.stdout]
    if run.returncode != 0 or missing:
        print("missing:", missing, "exit", run.returncode)
        return 1
    return 0


sys.exit(main())
