"""Ending the command ends the server, also one that does not hear."""

import os
import signal
import subprocess
import sys
import time

import pytest

from motiondiff_edu.course import jupyter

SERVER = """
import pathlib, os, signal, sys, time
if sys.argv[2] == "deaf":
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
pathlib.Path(sys.argv[1] + ".new").write_text(str(os.getpid()))
os.replace(sys.argv[1] + ".new", sys.argv[1])
time.sleep(600)
"""
COMMAND = """
import sys
from motiondiff_edu.course import jupyter
jupyter.PATIENCE = float(sys.argv[1])
sys.exit(jupyter.serve(sys.argv[2:], {}))
"""
pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGTERM to wait for")


@pytest.mark.parametrize("asked", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize(("hears", "patience"), [("well", "600"), ("deaf", "0.5")])
def test_the_server_ends_with_the_command(tmp_path, asked, hears, patience):
    server = [sys.executable, "-c", SERVER, str(tmp_path / "pid"), hears]
    command = subprocess.Popen([sys.executable, "-c", COMMAND, patience, *server])
    try:
        while not (tmp_path / "pid").exists():
            assert command.poll() is None, "the command ended before it was asked to"
            time.sleep(0.05)
        command.send_signal(asked)
        assert command.wait(60) == 0
        with pytest.raises(ProcessLookupError):
            os.kill(int((tmp_path / "pid").read_text()), 0)
    finally:
        command.kill()
        command.wait()


def test_a_server_that_ends_by_itself_gives_its_status():
    assert jupyter.serve([sys.executable, "-c", "raise SystemExit(3)"], {}) == 3
