"""tools/pages/api: signatures with shapes and docstrings, on pages that ask nobody for anything."""

import re

import pytest

from tools.pages import api


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("api")
    api.write(folder, ["motiondiff_edu.ddpm", "motiondiff_edu.rollout"])
    return folder


def words(page: str) -> str:
    """The text of a page without its tags."""
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", page)).replace("&#39;", "'")


def test_a_function_has_its_shapes_and_its_docstring(site):
    text = words((site / "motiondiff_edu" / "ddpm.html").read_text("utf-8"))
    assert "def q_sample( x0: jaxtyping.Float[Tensor, 'B *shape']" in text
    assert "Add s steps: x_s = sqrt(alpha_bar_s) x0 + sqrt(1 - alpha_bar_s) noise." in text
    assert "_clean_guess" not in text and "deque(" not in text


def test_lines_of_a_docstring_stay_lines(site):
    page = (site / "motiondiff_edu" / "rollout.html").read_text("utf-8")
    assert ".docstring p{white-space:pre-wrap;}" in page


def test_no_page_asks_for_anything_from_elsewhere(site):
    pages = list(site.rglob("*.html"))
    assert len(pages) == 3
    for page in pages:
        text = page.read_text("utf-8")
        asked = re.findall(r'<(?:script|img|iframe|link)[^>]*(?:src|href)="([^"]+)"', text)
        assert [one for one in asked if "://" in one] == [] and "@import" not in text, page.name


def test_the_public_modules_have_pages_and_the_answers_have_none():
    names = api.modules()
    assert {"motiondiff_edu", "motiondiff_edu.modiff", "motiondiff_edu.motion"} <= set(names)
    assert "!motiondiff_edu.course.checks" in names and "data_synth.walking" in names
    assert not [name for name in names if "._" in name]
