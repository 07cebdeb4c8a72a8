"""Start JupyterLab at one notebook, and stop it with its kernels."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from ..widgets.browsers import shut_in

# defaults of the course: JupyterLab does not ask about news; a student's own settings come first
CONFIG = Path(__file__).parent / "jupyter_config"
PATIENCE = 15  # seconds: Jupyter gives its kernels 5 to end by themselves


def open_lab(
    root: Path, notebook: Path, options: list[str], environment: dict[str, str], alone: bool = False
) -> int:
    """Start JupyterLab in `root` with `notebook` open; returns its exit status.

    `alone`: the notebook fills the window, without tabs and side bar.
    """
    address = f"/{'doc' if alone else 'lab'}/tree/" + notebook.relative_to(root).as_posix()
    command = [sys.executable, "-m", "jupyterlab"]
    command += [f"--ServerApp.root_dir={root}", f"--LabApp.default_url={address}"]
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        # in a container the user is root, and JupyterLab refuses that by default
        command.append("--allow-root")
    if shut_in() and not any("use_redirect_file" in option for option in options):
        # Jupyter would hide the address with its token in a file that a snap cannot open
        command.append("--ServerApp.use_redirect_file=False")
    theirs = os.environ.get("JUPYTER_CONFIG_PATH")
    config = os.pathsep.join([str(CONFIG)] + ([theirs] if theirs else []))
    print(f"opening {notebook.name} in {notebook.parent} (stop with Ctrl-C)", flush=True)
    return serve([*command, *options], {"JUPYTER_CONFIG_PATH": config} | environment)


def serve(command: list[str], environment: dict[str, str]) -> int:
    """Run the server; returns its exit status. Ctrl-C and SIGTERM stop it and its kernels.

    A server that does not end within PATIENCE seconds, or a second Ctrl-C, is killed.
    """
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    server = None
    try:
        server = subprocess.Popen(command, env=os.environ | environment)
        return server.wait()
    except KeyboardInterrupt:
        if server:
            end(server)
        return 0
    finally:
        signal.signal(signal.SIGTERM, before)


def end(server: subprocess.Popen) -> None:
    """Ask the server to end, and kill it if it does not."""
    try:
        server.terminate()
        server.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        pass  # stopped while a kernel starts, Jupyter Server 2.21 waits for ever for a thread
    finally:
        server.kill()  # does nothing to a server that has ended
        server.wait()
