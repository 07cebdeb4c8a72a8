"""What the tests share, and how often shapes are checked.

The real recordings and the browser, skipped visibly, or demanded where the build says so.

MOTIONDIFF_REAL_DATA   folder of real recordings; when it is set, a test that cannot use it fails
MOTIONDIFF_REQUIRE_BROWSER   when it is set, a test that finds no Chromium fails
"""

import os
import re
import shutil
from pathlib import Path

import jaxtyping
import pytest
import typecheck

# what --jaxtyping-packages (pyproject.toml) puts before every function of the packages
jaxtyping.jaxtyped = typecheck.now_and_then(jaxtyping.jaxtyped)

ROOT = Path(__file__).parent.parent
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def demanded(name: str) -> bool:
    """Whether the environment variable `name` is set to something other than 0."""
    return os.environ.get(name, "") not in ("", "0")


def missing(what: str, variable: str) -> None:
    """Skip, or fail where the build demanded it."""
    if demanded(variable):
        pytest.fail(f"{what}, and {variable} is set: this test must not be skipped", pytrace=False)
    pytest.skip(what)


@pytest.fixture(scope="session")
def root() -> Path:
    """The root of the checkout."""
    return ROOT


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of real recordings (bvh/, bvh_odd_and_broken/, oracle/ ...).

    Never part of the project.
    """
    folder = os.environ.get("MOTIONDIFF_REAL_DATA", "")
    if not folder:
        pytest.skip("real recordings not given: set MOTIONDIFF_REAL_DATA to their folder")
    if not Path(folder).is_dir():
        missing(f"there is no folder {folder}", "MOTIONDIFF_REAL_DATA")
    return Path(folder)


@pytest.fixture(scope="session")
def chromium() -> str:
    """The path of the system's Chromium, for playwright's executable_path."""
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        missing(
            "no Chromium found: install it (Debian: apt-get install chromium)",
            "MOTIONDIFF_REQUIRE_BROWSER",
        )
    return found


@pytest.fixture(scope="module")
def browser(chromium):
    """A running Chromium, one for all tests of a file."""
    from browser import (
        start_browser,  # not above: what it imports is checked only once pytest has set that up
    )

    with start_browser(chromium) as running:
        yield running


@pytest.fixture(scope="session")
def lab_server(chromium, root, tmp_path_factory):
    """A running JupyterLab, one for all tests of a process (helpers/jupyter_page.py)."""
    pytest.importorskip("jupyterlab")
    from jupyter_page import started_lab

    with started_lab(tmp_path_factory.mktemp("lab"), root) as lab:
        yield lab


@pytest.fixture
def lab_folder(lab_server, tmp_path) -> Path:
    """Where the notebook of a test lies, and what its kernel writes."""
    folder = lab_server.folder / tmp_path.name
    folder.mkdir()
    return folder


@pytest.fixture
def lab(lab_server, lab_folder, root, request):
    """The address of a notebook in JupyterLab whose one cell is the CELL of the test's module."""
    from jupyter_page import notebook

    path = lab_folder / "walk.ipynb"
    notebook(path, request.module.CELL.format(tests=str(root / "tests" / "helpers")))
    yield lab_server.opened(path)
    lab_server.end_kernels()


def pytest_runtest_setup() -> None:
    """In each test the first calls of a function are checked."""
    typecheck.begin_test()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Every test that uses the browser is marked so, and `make test` runs those last.

    Raises UsageError for one in whose file `make browser` would not look.
    """
    shown = [item for item in items if "chromium" in getattr(item, "fixturenames", ())]
    for item in shown:
        item.add_marker(pytest.mark.browser)
    for path in {item.path for item in shown}:
        if not re.search(r"\bbrowser\b", path.read_text(encoding="utf-8")):
            raise pytest.UsageError(f'{path} has tests that use Chromium: say "browser" in it')


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo):
    """A skip is a failure where the test was demanded.

    From anywhere (importorskip, a mark), in a browser or real-data test.

    What wants real recordings as well as a browser may be skipped where none are given.
    """
    report = yield
    names = getattr(item, "fixturenames", ())
    if "real_data" in names and not demanded("MOTIONDIFF_REAL_DATA"):
        return report
    for fixture, variable in (
        ("chromium", "MOTIONDIFF_REQUIRE_BROWSER"),
        ("real_data", "MOTIONDIFF_REAL_DATA"),
    ):
        if (
            report.skipped
            and not hasattr(report, "wasxfail")
            and fixture in names
            and demanded(variable)
        ):
            report.outcome = "failed"
            report.longrepr = f"skipped, although {variable} is set: {report.longrepr}"
    return report
