"""Everything is in pyproject.toml.

Here a wheel takes notebooks and constraints along, for `lab` without a checkout.
"""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py


class WithNotebooks(build_py):
    """Copies what a wheel needs from outside the package.

    notebooks/, notebooks/student/ and constraints.txt.
    """

    def run(self):
        super().run()
        if self.editable_mode:
            return
        root = Path(__file__).parent
        package = Path(self.build_lib) / "motiondiff_edu"
        shutil.copy(root / "constraints.txt", package / "constraints.txt")
        for folder in ("notebooks", "notebooks/student"):
            (package / folder).mkdir(parents=True, exist_ok=True)
            for notebook in sorted((root / folder).glob("*.ipynb")):
                shutil.copy(notebook, package / folder / notebook.name)


setup(cmdclass={"build_py": WithNotebooks})
