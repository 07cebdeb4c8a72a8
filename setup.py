"""Everything is in pyproject.toml; here a wheel takes along what `lab` needs without a checkout."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py


class WithNotebooks(build_py):
    """Copies what a wheel needs from outside the package: the notebooks, the pages they link to,
    constraints.txt."""

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
        for page in sorted((root / "docs").rglob("*")):
            if page.suffix in (".md", ".png", ".py"):  # PAGES of motiondiff_edu/course/copies.py
                target = package / page.relative_to(root)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(page, target)


setup(cmdclass={"build_py": WithNotebooks})
