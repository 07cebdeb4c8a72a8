"""tools/pages: notebooks as pages that work offline."""

import base64
import io
import json
import re

import pytest
from tqdm import tqdm

from tools.pages import cells, font, index, maths, raw
from tools.pages.__main__ import pages

PNG = base64.b64encode(b"not really a picture").decode()


def code(source, *outputs):
    return {"cell_type": "code", "source": source, "outputs": list(outputs)}


def text(source):
    return {"cell_type": "markdown", "source": source}


def shown(**data):
    return {"output_type": "display_data", "data": data}


def notebook(needs="nothing", title="01 Motion as tensors"):
    opening = f"# {title}\n\n*What is a walk?*\n\n**It needs** {needs}. **Paper:** none."
    return {
        "cells": [
            text(opening),
            text(
                "## Noise & more\n\nHere $x_s = \\sqrt{a}\\,x_0$ and `$not$`; see [02](02_b.ipynb)."
            ),
            code(
                "print(1)",
                {"output_type": "stream", "name": "stdout", "text": ["1 < 2\n"]},
                shown(**{"image/png": PNG, "text/plain": "a curve"}),
            ),
        ]
    }


# --- formulas


def test_formulas_become_mathml_and_code_stays():
    page = maths.with_formulas("a $x_1$ `$y$`\n```\n$z$\n```\n$$\\frac{1}{2}$$", lambda t: t)
    assert page.count("<math") == 2 and "<mfrac>" in page
    assert "`$y$`" in page and "$z$" in page and "$x_1$" not in page


def test_a_formula_is_kept_from_the_markdown():
    """Two underscores would be emphasis, a bar would end the cell of a table."""
    page = cells.of_markdown("| a |\n|---|\n| $\\|x_1\\| + y_2$ |")
    assert "<em>" not in page and page.count("<td>") == 1 and page.count("<math") == 1


def test_prices_are_no_formulas():
    assert "<math" not in maths.with_formulas(r"it costs \$5 or \$6", lambda t: t)


def test_every_formula_of_the_course_can_be_converted():
    import notebook_cells

    for path in notebook_cells.sources():
        for cell in notebook_cells.markdown(notebook_cells.read(path)):
            maths.with_formulas(cell["source"], lambda t: t)


def test_a_formula_that_cannot_be_converted_is_told():
    with pytest.raises(maths.FormulaError, match="cannot be converted to MathML: "):
        maths.mathml(r"\left(1", "inline")


def test_the_font_has_what_the_page_needs_and_the_roots():
    from fontTools.ttLib import TTFont

    page = maths.with_formulas(r"$\sqrt{\alpha} + x$", lambda t: t)
    style = font.style(page)
    data = base64.b64decode(re.search(r"base64,([^\"]+)", style)[1])
    loaded = TTFont(io.BytesIO(data))
    points = set(loaded.getBestCmap())
    assert {0x221A, 0x1D6FC, 0x1D465, ord("+")} <= points and "MATH" in loaded
    assert len(data) < 150_000 and font.style("<p>no formula</p>") == ""


# --- cells


def test_headings_have_the_anchors_of_jupyter_and_github():
    page = cells.of_markdown("## The papers' claims, tested")
    assert 'id="The-papers&#x27;-claims,-tested"' in page
    assert 'id="the-papers-claims-tested"' in page


def test_links_lead_to_pages():
    page = cells.of_markdown(
        "[a](03_x.ipynb#Top) [b](../docs/RESULTS.md#one) [c](https://a.b/c.md)"
    )
    assert 'href="03_x.html#Top"' in page and 'href="docs/RESULTS.html#one"' in page
    assert 'href="https://a.b/c.md"' in page


def test_outputs():
    live = {cells.WIDGET: {"model_id": "1"}, "text/plain": "HBox(children=(1,))"}
    assert cells.of_output(shown(**live)) == cells.NEEDS_A_KERNEL
    page = cells.of_output(shown(**live, **{"text/html": "<b>still</b>", "image/png": PNG}))
    assert "<b>still</b>" in page and "HBox" not in page and "<img" not in page
    page = cells.of_output(shown(**{"image/png": PNG, "text/plain": 'a "curve"'}))
    assert 'alt="a &quot;curve&quot;"' in page
    page = cells.of_output({"output_type": "stream", "name": "stdout", "text": ["\x1b[1m1 < 2"]})
    assert "1 &lt; 2" in page and "\x1b" not in page


def test_a_progress_bar_leaves_nothing_on_the_page():
    """It stands where a machine was slow enough, and a page has nothing to wait for."""
    words = io.StringIO()
    with tqdm(total=50, desc="dancing", file=words) as bar:
        bar.update(24)
    bars = {text for text in words.getvalue().split("\r") if text.strip()}
    assert len(bars) >= 2
    for text in bars:
        assert cells.of_output(shown(**{cells.WIDGET: {"model_id": "1"}, "text/plain": text})) == ""
    slider = {cells.WIDGET: {"model_id": "1"}, "text/plain": "Label(value='50 % | of it')"}
    assert cells.of_output(shown(**slider)) == cells.NEEDS_A_KERNEL


def test_a_notebook_that_failed_is_no_page():
    failed = {"output_type": "error", "ename": "ValueError", "evalue": "no"}
    with pytest.raises(ValueError, match="the notebook failed with ValueError: no"):
        cells.of_output(failed)


# --- the index


@pytest.mark.parametrize(
    "line, wanted",
    [
        ("notebooks 01 to 03 and 07", ("01", "02", "03", "07")),
        ("notebook 01 and the density of a Gaussian", ("01",)),
        ("nothing", ()),
        ("notebooks 03 (the exact denoiser) and 12; 10 for there-and-back", ("03", "12", "10")),
    ],
)
def test_what_a_notebook_needs_is_read_from_its_opening(line, wanted):
    assert index.needs(f"# A\n\n**It needs** {line}. **Paper:** MoDiff 99.") == wanted


def entries(*pairs):
    return [index.Entry(n, f"{n}_x", f"Title {n}", "", needs, "") for n, needs in pairs]


def test_the_graph_draws_only_direct_needs_and_puts_each_below_what_it_needs():
    ones = entries(("00", ()), ("01", ("00",)), ("02", ("00", "01")), ("03", ("01",)))
    assert index.lacking(ones) == {"00": (), "01": ("00",), "02": ("01",), "03": ("01",)}
    assert index.levels(ones) == {"00": 0, "01": 1, "02": 2, "03": 2}
    drawn = index.graph(ones)
    assert drawn.count("<path") == 3 and drawn.count("<a href") == 4
    assert "02 needs 01" in drawn


def test_the_course_is_a_graph_without_circles():
    import notebook_cells

    read = {path.stem: notebook_cells.read(path) for path in notebook_cells.sources()}
    ones = [index.entry(name, one) for name, one in read.items()]
    assert all(n < one.number for one in ones for n in one.needs)
    assert all(one.question for one in ones)
    assert min(index.levels(ones).values()) == 0


# --- all of it


@pytest.fixture
def executed(tmp_path):
    folder = tmp_path / "executed"
    folder.mkdir()
    (folder / "01_a.ipynb").write_text(json.dumps(notebook()))
    (folder / "02_b.ipynb").write_text(json.dumps(notebook("notebook 01", "02 Noise")))
    return folder


def test_pages_of_a_folder(executed, tmp_path):
    written = pages(executed, tmp_path / "site")
    names = [path.relative_to(tmp_path / "site").as_posix() for path in written]
    assert names[:2] == ["01_a.html", "02_b.html"] and names[-1] == "index.html"
    assert "docs/RESULTS.html" in names and (tmp_path / "site/docs/results/repairs.png").is_file()
    page = written[0].read_text()
    assert "<title>01 Motion as tensors</title>" in page and 'href="02_b.html">02 →' in page
    assert "1 &lt; 2" in page and "@font-face" in page
    first = written[-1].read_text()
    assert first.count("<li>") == 2 and "data:image/png" in first and "<svg" in first


def test_the_first_page_leads_to_the_api_where_that_was_written(executed, tmp_path):
    site, link = tmp_path / "site", 'href="api/index.html"'
    assert link not in pages(executed, site)[-1].read_text()
    (site / "api").mkdir()
    (site / "api" / "index.html").write_text("<h1>API</h1>")
    assert link in pages(executed, site)[-1].read_text()


def test_no_page_asks_for_anything_from_elsewhere(executed, tmp_path):
    for path in pages(executed, tmp_path / "site"):
        page = path.read_text()
        asked = re.findall(r'<(?:script|img|iframe|link)[^>]*(?:src|href)="(?!data:)([^"]+)"', page)
        assert [one for one in asked if "://" in one] == [], path.name


def test_a_heading_with_a_formula_is_whole():
    page = cells.of_markdown("### Exercise 3: from numbers to $L_a$ (easy)\n\nText.")
    assert page.count("<h3 ") == page.count("</h3>") == 1
    assert re.search(r'<h3 id="[^"<>]*"><span id="[^"<>]*"></span>Exercise 3: from', page)
    assert page.count("<math") == 1 and "(easy)</h3>" in page


def test_the_first_page_has_words_and_no_marks():
    line = "A *first* line of **[attention](../docs/GLOSSARY.md#attention)** and `code` x_s, _now_."
    cell = {"cell_type": "markdown", "source": f"# 01 A title\n\n{line}\n"}
    found = index.entry("01_a", {"cells": [cell]})
    assert found.question == "A first line of attention and code x_s, now."


def test_local_links_lead_somewhere(executed, tmp_path):
    """Also those within the page, and in all pages. Notebooks that were not run have no page."""
    written = {path.resolve(): path.read_text() for path in pages(executed, tmp_path / "site")}
    followed = 0
    for path, page in written.items():
        for href in re.findall(r'<a [^>]*href="([^":]+)"', page):
            name, _, anchor = href.partition("#")
            target = (path.parent / name).resolve() if name else path
            if re.fullmatch(r"\d\d_\w+\.html", target.name) and target not in written:
                continue
            assert target.is_file(), f"{path.name}: {href}"
            if anchor and target in written:
                assert f'id="{anchor}"' in written[target], f"{path.name}: {href}"
            followed += 1
    assert followed > 20


def test_an_empty_folder_is_told(tmp_path):
    with pytest.raises(SystemExit, match="there are no executed notebooks in"):
        pages(tmp_path, tmp_path / "site")


def test_a_failed_notebook_is_told(executed, tmp_path):
    broken = notebook()
    broken["cells"].append(code("1/0", {"output_type": "error", "ename": "E", "evalue": "v"}))
    (executed / "01_a.ipynb").write_text(json.dumps(broken))
    with pytest.raises(SystemExit, match="01_a: the notebook failed with E: v"):
        pages(executed, tmp_path / "site")


def test_what_is_raw_is_found():
    assert raw.raw_formulas("so $x_1$ is") and raw.raw_formulas(r"\frac12")
    assert raw.raw_formulas("it costs 5 $") == []
    assert raw.raw_widgets("HBox(children=(IntSlider(value=1),", "")
    assert raw.raw_widgets("", "<motiondiff_edu.widgets.player.Player object at 0x1>")
    assert raw.raw_widgets("the function f(value=1) draws", "") == []
