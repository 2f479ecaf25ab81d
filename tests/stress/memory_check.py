"""One small render under valgrind."""

import pathlib
import shutil
import subprocess
import tempfile

from hard_meshes import BOX, obj
from harness import BIN
from programs import Row, mesh_object, scene

MARK = 99


def all_rows():
    row = Row("memory", "both programs under valgrind: no error")
    valgrind = shutil.which("valgrind")
    if not valgrind:
        row.expect("valgrind is not installed")
        yield row
        return
    with tempfile.TemporaryDirectory(prefix="sss-stress-") as name:
        folder = pathlib.Path(name)
        (folder / "mesh.obj").write_text(obj(*BOX))
        (folder / "scene.json").write_text(scene([mesh_object()], spacing=3))
        for arguments in (("sss-preprocess", "scene.json", "-o", "a.ssc"),
                          ("sss-render", "scene.json", "--cache", "a.ssc", "-o", "a.exr")):
            command = [valgrind, "--quiet", f"--error-exitcode={MARK}", "--errors-for-leak-kinds=none",
                       str(BIN / arguments[0]), *arguments[1:], "--threads", "1"]
            done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True,
                                  check=False)
            words = done.stderr.decode(errors="replace")
            row.expect(f"{arguments[0]} ended with {done.returncode}: {words[-500:]}"
                       if done.returncode != 0 else "")
    yield row
