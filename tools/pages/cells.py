"""The cells of an executed notebook as HTML."""

import html
import re

from nbconvert.filters import ansi2html
from nbconvert.filters.highlight import Highlight2HTML
from nbconvert.filters.markdown_mistune import markdown2html_mistune

from motiondiff_edu.course import anchors

from .maths import with_formulas

NEEDS_A_KERNEL = (
    '<p class="kernel-note">Here the notebook has controls that need a running kernel: '
    "<code>make lab</code> opens it.</p>"
)
WIDGET = "application/vnd.jupyter.widget-view+json"
PROGRESS = re.compile(r"[^|\n]*\d+%\|")  # a bar of tqdm, in words
HIGHLIGHT = Highlight2HTML()


def of_notebook(notebook: dict) -> str:
    """All cells, in order."""
    return "\n".join(map(of_cell, notebook["cells"]))


def of_cell(cell: dict) -> str:
    source = "".join(cell["source"])
    if cell["cell_type"] == "markdown":
        return f'<section class="text">{of_markdown(source)}</section>'
    if cell["cell_type"] != "code" or not source.strip():
        return ""
    outputs = "".join(map(of_output, cell.get("outputs", [])))
    code = HIGHLIGHT(source, language="python")
    return f'<section class="code">{code}{outputs}</section>'


def of_output(output: dict) -> str:
    """One output. Raises ValueError for an error: a page of a notebook that failed is no page."""
    kind = output["output_type"]
    if kind == "error":
        raise ValueError(f"the notebook failed with {output['ename']}: {output['evalue']}")
    if kind == "stream":
        name = "told" if output["name"] == "stdout" else "told warning"
        return f'<pre class="{name}">{ansi2html("".join(output["text"]))}</pre>'
    data = {mime: "".join(text) for mime, text in output["data"].items() if mime != WIDGET}
    if "text/html" in data:
        return f'<div class="shown">{data["text/html"]}</div>'
    if WIDGET in output["data"]:
        over = PROGRESS.match(data.get("text/plain", ""))
        return "" if over else NEEDS_A_KERNEL
    if "image/png" in data:
        words, png = html.escape(data.get("text/plain", "")), data["image/png"]
        return f'<img alt="{words}" src="data:image/png;base64,{png}">'
    if "text/markdown" in data:
        return of_markdown(data["text/markdown"])
    return f'<pre class="told">{html.escape(data.get("text/plain", ""))}</pre>'


def of_markdown(source: str) -> str:
    """Markdown with formulas, headings that links find, and links to pages."""
    return linked(anchored(with_formulas(source, rendered)))


def rendered(source: str) -> str:
    """Markdown as HTML, with headings that have no anchors yet.

    nbconvert makes anchors of a heading's text, in which a formula would become markup later.
    """
    text = re.sub(r'<a class="anchor-link".*?</a>', "", markdown2html_mistune(source))
    return re.sub(r"<h([1-6])[^>]*>", r"<h\1>", text)


def anchored(text: str) -> str:
    """Every heading gets the anchors that Jupyter and GitHub give it."""

    def heading(match: re.Match) -> str:
        level, inner = match[1], match[2]
        words = html.unescape(re.sub(r"<[^>]+>", "", inner)).strip()
        jupyter = html.escape(anchors.in_jupyterlab(words), quote=True)
        github = f'<span id="{anchors.on_a_host(words)}"></span>'
        return f'<h{level} id="{jupyter}">{github}{inner}</h{level}>'

    return re.sub(r"<h([1-6])>(.*?)</h\1>", heading, text, flags=re.DOTALL)


def linked(text: str) -> str:
    """Links from notebook to notebook and to the docs lead to their pages."""
    text = re.sub(r'href="(?:\.\./notebooks/|notebooks/)?(\d\d_\w+)\.ipynb', r'href="\1.html', text)
    text = re.sub(r'href="\.\./docs/(\w+)\.md', r'href="docs/\1.html', text)
    return re.sub(r'href="([A-Z_]+)\.md', r'href="\1.html', text)
